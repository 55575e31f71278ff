/* test_program.c: programs by the driver, what they take, and uniforms of every type. */
#include "check.h"

#define FRAGMENT_HEAD "#version 330\nout vec4 color;\n"

static void test_create(void) {
    const char *good = FRAGMENT_HEAD "void main() { color = vec4(1.0); }\n";
    uint32_t program = hn_program_create(POSITION_VERTEX, good);
    CHECK(program != 0);
    hn_program_delete(program);
    CHECK_FAILS(hn_program_create("#version 330\nvoid main() { x = 1.0; }\n", good) == 0, "vertex: 0:2(");
    CHECK_FAILS(hn_program_create(POSITION_VERTEX, "#version 330\nvoid main() { x = 1.0; }\n") == 0,
                "fragment: 0:2(");
    CHECK_FAILS(hn_program_create(POSITION_VERTEX, "") == 0, "fragment: ");
    const char *mismatch = FRAGMENT_HEAD "in vec2 v;\nvoid main() { color = vec4(v, v); }\n";
    CHECK_FAILS(hn_program_create(
                    "#version 330\nout vec3 v;\nvoid main() { v = vec3(1.0); gl_Position = vec4(v, 1.0); }\n",
                    mismatch) == 0,
                "link: error: ");
    CHECK_FAILS(hn_program_create(NULL, good) == 0, "no vertex text");
    CHECK_FAILS(hn_program_create(good, NULL) == 0, "no fragment text");
    /* A failure leaves nothing behind that the next call would stumble over. */
    hn_program_delete(123456);
    CHECK_FAILS(1, "GL_INVALID_VALUE");
    program = hn_program_create(POSITION_VERTEX, good);
    CHECK(program != 0);
    hn_program_delete(program);
}

static const hn_variable *find(const hn_variable *variables, int n, const char *name) {
    for (int i = 0; i < n; ++i)
        if (strcmp(variables[i].name, name) == 0)
            return &variables[i];
    return NULL;
}

static void test_variables(void) {
    uint32_t program = hn_program_create(
        "#version 330\nlayout(location = 3) in vec2 uv;\nlayout(location = 1) in vec3 position;\nout vec2 "
        "v;\n"
        "uniform mat4 matrix;\n"
        "void main() { v = uv; gl_Position = matrix * vec4(position, float(gl_VertexID)); }\n",
        FRAGMENT_HEAD "in vec2 v;\nuniform sampler2D map;\nuniform vec3 list[4];\nuniform float unused;\n"
                      "struct Light { vec3 color; };\nuniform Light light;\n"
                      "void main() { color = texture(map, v) + vec4(list[2] + light.color, 1.0); }\n");
    hn_variable variables[16];
    int n = hn_program_uniforms(program, variables, 16);
    CHECK(n == 4);
    const hn_variable *matrix = find(variables, n, "matrix"), *map = find(variables, n, "map");
    const hn_variable *list = find(variables, n, "list[0]"), *light = find(variables, n, "light.color");
    CHECK(matrix && matrix->type == GL_FLOAT_MAT4 && matrix->size == 1 && matrix->location >= 0);
    CHECK(map && map->type == GL_SAMPLER_2D);
    CHECK(list && list->type == GL_FLOAT_VEC3 && list->size >= 3);
    CHECK(light && light->type == GL_FLOAT_VEC3);
    CHECK(!find(variables, n, "unused"));

    /* The count is of all, whatever there is room for. */
    memset(variables, 0, sizeof variables);
    CHECK(hn_program_uniforms(program, variables, 1) == 4 && variables[0].name[0] && !variables[1].name[0]);
    CHECK(hn_program_uniforms(program, NULL, 0) == 4 && hn_program_uniforms(program, NULL, 9) == 4);

    n = hn_program_attributes(program, variables, 16);
    CHECK(n == 3);
    const hn_variable *uv = find(variables, n, "uv"), *position = find(variables, n, "position");
    const hn_variable *id = find(variables, n, "gl_VertexID");
    CHECK(uv && uv->location == 3 && uv->type == GL_FLOAT_VEC2);
    CHECK(position && position->location == 1 && position->type == GL_FLOAT_VEC3);
    CHECK(id && id->location == -1);
    CHECK_FAILS(hn_program_uniforms(0, variables, 16) == -1,
                "hn_program_uniforms: program 0: GL_INVALID_VALUE");
    CHECK_FAILS(hn_program_attributes(9999, variables, 16) == -1, "hn_program_attributes: program 9999");
    hn_program_delete(program);
}

/* A name that does not fit is a failure, not another name. */
static void test_long_name(void) {
    char fragment[1024], name[301];
    memset(name, 'n', 300);
    name[300] = 0;
    snprintf(fragment, sizeof fragment, FRAGMENT_HEAD "uniform vec4 %s;\nvoid main() { color = %s; }\n", name,
             name);
    uint32_t program = hn_program_create(POSITION_VERTEX, fragment);
    hn_variable variable;
    CHECK_FAILS(hn_program_uniforms(program, &variable, 1) == -1, "a name of 300 characters");
    hn_program_delete(program);
}

/* Of each type, a uniform set to 1, 2, 3, ... component by component arrives so: the shader gives its last
 * component, and of a matrix the first of the second column. */
static void test_uniform_types(void) {
    static const struct {
        uint32_t type;
        const char *name, *last;
        float expected;
        const char *column;
        float expected_column;
    } cases[] = {
        {GL_FLOAT, "float", "u", 1, "0", 0},
        {GL_FLOAT_VEC2, "vec2", "u.y", 2, "0", 0},
        {GL_FLOAT_VEC3, "vec3", "u.z", 3, "0", 0},
        {GL_FLOAT_VEC4, "vec4", "u.w", 4, "0", 0},
        {GL_INT, "int", "u", 1, "0", 0},
        {GL_INT_VEC2, "ivec2", "u.y", 2, "0", 0},
        {GL_INT_VEC3, "ivec3", "u.z", 3, "0", 0},
        {GL_INT_VEC4, "ivec4", "u.w", 4, "0", 0},
        {GL_UNSIGNED_INT, "uint", "u", 1, "0", 0},
        {GL_UNSIGNED_INT_VEC2, "uvec2", "u.y", 2, "0", 0},
        {GL_UNSIGNED_INT_VEC3, "uvec3", "u.z", 3, "0", 0},
        {GL_UNSIGNED_INT_VEC4, "uvec4", "u.w", 4, "0", 0},
        {GL_BOOL, "bool", "u", 1, "0", 0},
        {GL_BOOL_VEC2, "bvec2", "u.y", 1, "0", 0},
        {GL_BOOL_VEC3, "bvec3", "u.z", 1, "0", 0},
        {GL_BOOL_VEC4, "bvec4", "u.w", 1, "0", 0},
        {GL_FLOAT_MAT2, "mat2", "u[1].y", 4, "u[1].x", 3},
        {GL_FLOAT_MAT3, "mat3", "u[2].z", 9, "u[1].x", 4},
        {GL_FLOAT_MAT4, "mat4", "u[3].w", 16, "u[1].x", 5},
        {GL_FLOAT_MAT2x3, "mat2x3", "u[1].z", 6, "u[1].x", 4},
        {GL_FLOAT_MAT2x4, "mat2x4", "u[1].w", 8, "u[1].x", 5},
        {GL_FLOAT_MAT3x2, "mat3x2", "u[2].y", 6, "u[1].x", 3},
        {GL_FLOAT_MAT3x4, "mat3x4", "u[2].w", 12, "u[1].x", 5},
        {GL_FLOAT_MAT4x2, "mat4x2", "u[3].y", 8, "u[1].x", 3},
        {GL_FLOAT_MAT4x3, "mat4x3", "u[3].z", 12, "u[1].x", 4},
    };
    float floats[16];
    int32_t ints[16];
    for (int i = 0; i < 16; ++i) {
        floats[i] = (float)(i + 1);
        ints[i] = i + 1;
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char fragment[512];
        snprintf(fragment, sizeof fragment,
                 FRAGMENT_HEAD
                 "uniform %s u;\nvoid main() { color = vec4(float(%s), float(%s), 0.0, 1.0); }\n",
                 cases[i].name, cases[i].last, cases[i].column);
        uint32_t program = hn_program_create(POSITION_VERTEX, fragment);
        hn_variable u;
        CHECK(hn_program_uniforms(program, &u, 1) == 1 && u.type == cases[i].type);
        int is_float = strchr("fvm", cases[i].name[0]) != NULL;
        CHECK(hn_program_uniform(program, u.location, u.type, 1, is_float ? (void *)floats : (void *)ints) ==
              0);
        int32_t read[17];
        memset(read, 0x55, sizeof read);
        int n = (int)(cases[i].expected > 1 || cases[i].type == GL_FLOAT ? cases[i].expected : 1);
        CHECK(hn_program_uniform_read(program, u.location, u.type, n, read) == 0);
        int32_t first = 1; /* a bool is 1 when it is true; the rest is as it was set */
        CHECK(memcmp(read,
                     is_float ? (void *)floats
                     : n > 1  ? (void *)ints
                              : (void *)&first,
                     (size_t)n * 4) == 0 &&
              read[n] == 0x55555555);
        float rgba[4] = {0};
        CHECK(draw_pixel(program, rgba) == 0);
        CHECK(rgba[0] == cases[i].expected && rgba[1] == cases[i].expected_column);
        hn_program_delete(program);
    }
}

static void test_uniform_arrays_and_failures(void) {
    uint32_t program = hn_program_create(POSITION_VERTEX, FRAGMENT_HEAD
                                         "uniform vec2 u[2];\nvoid main() { color = vec4(u[0], u[1]); }\n");
    const float values[] = {1, 2, 3, 4};
    float rgba[4] = {0};
    hn_variable u;
    CHECK(hn_program_uniforms(program, &u, 1) == 1 && strcmp(u.name, "u[0]") == 0 && u.size == 2);
    CHECK(hn_program_uniform(program, u.location, u.type, 2, values) == 0);
    CHECK(draw_pixel(program, rgba) == 0 && memcmp(rgba, values, sizeof values) == 0);

    CHECK_FAILS(hn_program_uniform(program, -1, GL_FLOAT, 1, values) == -1, "no uniform at location -1");
    CHECK_FAILS(hn_program_uniform(program, u.location, GL_FLOAT, 1, values) == -1, "GL_INVALID_OPERATION");
    CHECK_FAILS(hn_program_uniform(program, u.location, GL_INT_VEC2, 1, values) == -1, "type 0x8B53");
    CHECK_FAILS(hn_program_uniform(program, u.location + 77, GL_FLOAT_VEC2, 1, values) == -1, "location ");
    CHECK_FAILS(hn_program_uniform(program, u.location, GL_DOUBLE, 1, values) == -1, "type 0x140A");
    CHECK_FAILS(hn_program_uniform(program, u.location, u.type, 0, values) == -1, "no data");
    CHECK_FAILS(hn_program_uniform(program, u.location, u.type, 1, NULL) == -1, "no data");
    CHECK_FAILS(hn_program_uniform(9999, 0, GL_FLOAT, 1, values) == -1, "program 9999");
    float read[16];
    CHECK(hn_program_uniform_read(program, u.location + 1, u.type, 2, read) == 0 && read[1] == 4);
    CHECK_FAILS(hn_program_uniform_read(program, -1, u.type, 2, read) == -1, "location -1");
    CHECK_FAILS(hn_program_uniform_read(program, u.location, u.type, 17, read) == -1, "17 components");
    CHECK_FAILS(hn_program_uniform_read(program, u.location + 77, u.type, 2, read) == -1, "GL_INVALID");
    /* None of these changed anything. */
    CHECK(draw_pixel(program, rgba) == 0 && memcmp(rgba, values, sizeof values) == 0);
    hn_program_delete(program);
}

/* A uniform that is not set has the value that the text gives it. */
static void test_uniform_initial(void) {
    uint32_t program =
        hn_program_create(POSITION_VERTEX, FRAGMENT_HEAD
                          "uniform uint u = 4000000000u;\nvoid main() { color = vec4(float(u >> 16)); }\n");
    hn_variable u;
    uint32_t value = 0;
    CHECK(hn_program_uniforms(program, &u, 1) == 1);
    CHECK(hn_program_uniform_read(program, u.location, u.type, 1, &value) == 0 && value == 4000000000u);
    hn_program_delete(program);
}

void test_program(void) {
    test_create();
    test_variables();
    test_long_name();
    test_uniform_types();
    test_uniform_arrays_and_failures();
    test_uniform_initial();
}
