/* test_draw.c: draws, by pixels that are known beforehand. */
#include "check.h"

#include <stdlib.h>

/* The state at the start of a pass, to be changed in a part. */
static const hn_state start = {.fill = GL_FILL,
                               .cull = GL_BACK,
                               .front = GL_CCW,
                               .depth_test = 1,
                               .depth_write = 1,
                               .depth_function = GL_LESS};

#define UV_VERTEX                              \
    "#version 330\n"                           \
    "layout(location = 0) in vec3 position;\n" \
    "layout(location = 1) in vec2 texcoord;\n" \
    "out vec2 uv;\n"                           \
    "void main() { uv = texcoord; gl_Position = vec4(position, 1.0); }\n"

/* At any width each pixel comes back at its place, row 0 at the bottom. */
static void test_places(void) {
    uint32_t program =
        hn_program_create(POSITION_VERTEX, "#version 330\nout vec4 color;\nvoid main() { color = "
                                           "vec4((gl_FragCoord.xy - 0.5) / 255.0, 0.2, 0.5); }\n");
    const hn_field fields[] = {HN_POSITION};
    hn_mesh *mesh = cover(0);
    for (int width = 1; width <= 9; ++width) {
        const int height = 3;
        hn_target *target = hn_target_create(width, height, GL_RGB32F);
        uint8_t bytes[9 * 3 * 4];
        const float black[4] = {0};
        CHECK(clear(target, black) == 0 && draw_fields(target, program, mesh, fields, 1, NULL) == 0 &&
              hn_target_read_bytes(target, bytes) == 0);
        int right = 1;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const uint8_t *at = bytes + 4 * (y * width + x);
                right = right && at[0] == x && at[1] == y && at[2] == 51 && at[3] == 255;
            }
        CHECK(right);
        hn_target_delete(target);
    }
    hn_mesh_delete(mesh);
    hn_program_delete(program);
}

/* SHADERed's state: LESS with depth written, back faces culled, no blending; and a clear resets the depth. */
static void test_state(void) {
    uint32_t program = hn_program_create(
        POSITION_VERTEX,
        "#version 330\nuniform vec4 value;\nout vec4 color;\nvoid main() { color = value; }\n");
    const float red[4] = {1, 0, 0, 0.5f}, green[4] = {0, 1, 0, 0.5f}, black[4] = {0};
    const hn_field fields[] = {HN_POSITION};
    const hn_vertex reversed[] = {
        {.position = {-1, -1, 0}}, {.position = {-1, 3, 0}}, {.position = {3, -1, 0}}};
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    hn_mesh *near = cover(-0.5f), *far = cover(0.5f), *back = hn_mesh_create(reversed, 3, NULL, 0);
    hn_variable value;
    float rgba[4];
    CHECK(hn_program_uniforms(program, &value, 1) == 1);

    hn_program_uniform(program, value.location, GL_FLOAT_VEC4, 1, red);
    CHECK(clear(target, black) == 0 && draw_fields(target, program, back, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, black, sizeof rgba) == 0);
    CHECK(draw_fields(target, program, far, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, red, sizeof rgba) == 0);
    hn_program_uniform(program, value.location, GL_FLOAT_VEC4, 1, green);
    CHECK(draw_fields(target, program, far, fields, 1, NULL) == 0); /* equal depth is not less */
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, red, sizeof rgba) == 0);
    CHECK(draw_fields(target, program, near, fields, 1, NULL) == 0); /* over it, alpha and all */
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, green, sizeof rgba) == 0);
    hn_program_uniform(program, value.location, GL_FLOAT_VEC4, 1, red);
    CHECK(draw_fields(target, program, far, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, green, sizeof rgba) == 0);
    CHECK(clear(target, black) == 0 && draw_fields(target, program, far, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, red, sizeof rgba) == 0);

    /* Each part of a state that is given; without one a back face and what lies beyond the far plane are left out. */
    hn_mesh *beyond = cover(1.5f);
    hn_state both_sides = start, clockwise = start, no_front = start, clamped = start;
    both_sides.cull = GL_NONE;
    clockwise.front = GL_CW;
    no_front.cull = GL_FRONT;
    clamped.depth_clamp = 1;
    const struct {
        const hn_mesh *mesh;
        const hn_state *state;
        int seen;
    } draws[] = {{back, NULL, 0},      {back, &both_sides, 1}, {back, &clockwise, 1}, {back, &no_front, 1},
                 {far, &clockwise, 0}, {far, &no_front, 0},    {beyond, NULL, 0},     {near, &clamped, 1}};
    for (size_t i = 0; i < sizeof draws / sizeof *draws; ++i) {
        CHECK(clear(target, black) == 0);
        CHECK(draw_fields(target, program, draws[i].mesh, fields, 1, draws[i].state) == 0);
        CHECK(hn_target_read_floats(target, rgba) == 0);
        CHECK(memcmp(rgba, draws[i].seen ? red : black, sizeof rgba) == 0);
    }
    /* Clamped, what lies before the near plane is at depth 0: drawn, and nothing is nearer. */
    hn_mesh *before = cover(-1.5f);
    CHECK(clear(target, black) == 0);
    CHECK(draw_fields(target, program, before, fields, 1, NULL) == 0 &&
          hn_target_read_floats(target, rgba) == 0);
    CHECK(memcmp(rgba, black, sizeof rgba) == 0);
    CHECK(draw_fields(target, program, before, fields, 1, &clamped) == 0 &&
          hn_target_read_floats(target, rgba) == 0);
    CHECK(memcmp(rgba, red, sizeof rgba) == 0);
    /* What writes no depth hides nothing. */
    hn_state unseen = start;
    unseen.depth_write = 0;
    CHECK(clear(target, black) == 0 && draw_fields(target, program, near, fields, 1, &unseen) == 0);
    hn_program_uniform(program, value.location, GL_FLOAT_VEC4, 1, green);
    CHECK(draw_fields(target, program, far, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, green, sizeof rgba) == 0);
    hn_mesh_delete(beyond);
    hn_mesh_delete(before);

    hn_mesh_delete(near);
    hn_mesh_delete(far);
    hn_mesh_delete(back);
    hn_target_delete(target);
    hn_program_delete(program);
}

static uint32_t colored(int32_t *location) {
    uint32_t program = hn_program_create(
        POSITION_VERTEX,
        "#version 330\nuniform vec4 value;\nout vec4 color;\nvoid main() { color = value; }\n");
    hn_variable value = {.location = -1};
    hn_program_uniforms(program, &value, 1);
    *location = value.location;
    return program;
}

/* An evaluation after a draw of lines that no stencil lets pass is as any other. */
static void test_state_does_not_stay(void) {
    int32_t location = -1;
    uint32_t program = colored(&location);
    uint32_t fives = hn_program_create(hn_evaluate_vertex(),
                                       "#version 330\nout vec4 five;\nvoid main() { five = vec4(5.0); }\n");
    const hn_field fields[] = {HN_POSITION};
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    hn_mesh *mesh = cover(0);
    hn_state never = start;
    never.fill = GL_LINE;
    never.stencil_test = 1;
    never.stencil_front = never.stencil_back = (hn_stencil){GL_NEVER, GL_KEEP, GL_KEEP, GL_KEEP};
    float numbers[100] = {0};
    const hn_output output = {numbers, 1};
    CHECK(draw_fields(target, program, mesh, fields, 1, &never) == 0);
    CHECK(hn_evaluate(fives, NULL, 0, &output, 1, 100) == 0);
    for (int i = 0; i < 100; ++i)
        CHECK(numbers[i] == 5);
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(fives);
    hn_program_delete(program);
}

/* The attributes of one draw are not those of the next: without fields a shader reads GL's 0 0 0 1. */
static void test_fields(void) {
    const hn_field six[] = {HN_POSITION, HN_TEXCOORD, HN_NORMAL, HN_TANGENT, HN_BITANGENT, HN_COLOR};
    uint32_t with = hn_program_create(UV_VERTEX, "#version 330\nin vec2 uv;\nout vec4 color;\n"
                                                 "void main() { color = vec4(uv, 0.0, 1.0); }\n");
    uint32_t without = hn_program_create(
        "#version 330\nlayout(location = 1) in vec4 value;\nout vec4 v;\n"
        "void main() { v = value;\n"
        "gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, -0.5, 1.0); }\n",
        "#version 330\nin vec4 v;\nout vec4 color;\nvoid main() { color = v; }\n");
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    hn_mesh *mesh = cover(0);
    float rgba[4];
    const float black[4] = {0};
    CHECK(clear(target, black) == 0);
    CHECK(draw_fields(target, with, mesh, six, 6, NULL) == 0 && hn_target_read_floats(target, rgba) == 0);
    CHECK(rgba[0] == 0.5f && rgba[1] == 0.5f);
    CHECK(draw_fields(target, without, mesh, NULL, 0, NULL) == 0 && hn_target_read_floats(target, rgba) == 0);
    CHECK(rgba[0] == 0 && rgba[1] == 0 && rgba[2] == 0 && rgba[3] == 1);

    const hn_attribute attribute = {0, GL_FLOAT, 3, sizeof(hn_vertex), 0, 0};
    hn_call call = {.program = with, .mesh = mesh, .topology = GL_TRIANGLES, .attributes = &attribute};
    call.n_attributes = -1;
    CHECK_FAILS(hn_draw(target, &call) == -1, "-1 attributes: the driver has");
    call.n_attributes = 1000;
    CHECK_FAILS(hn_draw(target, &call) == -1, "1000 attributes");
    call.n_attributes = 1;
    call.attributes = NULL;
    CHECK_FAILS(hn_draw(target, &call) == -1, "1 attributes");
    call.attributes = &attribute;
    call.mesh = NULL;
    CHECK_FAILS(hn_draw(target, &call) == -1, "attribute 0 reads a mesh, but there is none");
    call.n_attributes = 0;
    call.n_vertices = -1;
    CHECK_FAILS(hn_draw(target, &call) == -1, "no mesh, and -1 vertices");
    CHECK_FAILS(draw_fields(target, 0, mesh, six, 6, NULL) == -1, "hn_draw: no program");
    CHECK_FAILS(draw_fields(target, 9999, mesh, six, 6, NULL) == -1,
                "hn_draw: program 9999: GL_INVALID_VALUE");
    CHECK_FAILS(hn_draw(target, NULL) == -1, "hn_draw: no call");
    CHECK_FAILS(draw_fields(NULL, with, mesh, six, 6, NULL) == -1, "hn_draw: no target");
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(with);
    hn_program_delete(without);
}

/* A program of one colour, and the uniform that sets it. */
/* Draws a colour over another and reads what comes of it. */
static int blend(const float under[4], const float over[4], const hn_state *state, float rgba[4]) {
    int32_t location = -1;
    uint32_t program = colored(&location);
    const hn_field fields[] = {HN_POSITION};
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    hn_mesh *mesh = cover(0);
    int failed = hn_program_uniform(program, location, GL_FLOAT_VEC4, 1, over) || clear(target, under) ||
                 draw_fields(target, program, mesh, fields, 1, state) || hn_target_read_floats(target, rgba);
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(program);
    return failed;
}

static int is(const float a[4], float x, float y, float z, float w) {
    return a[0] == x && a[1] == y && a[2] == z && a[3] == w;
}

static void test_blend(void) {
    const float under[4] = {1, 0.5f, 0, 0.5f}, over[4] = {0.5f, 0.25f, 1, 0.25f};
    float rgba[4];
    hn_state state = start;
    state.blend = 1;
    state.blend_functions[0] = GL_FUNC_ADD;
    state.blend_functions[1] = GL_MAX;
    const uint32_t by_alpha[4] = {GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE};
    memcpy(state.blend_factors, by_alpha, sizeof by_alpha);
    /* 1/4 of the one and 3/4 of the other; the greater alpha. */
    CHECK(blend(under, over, &state, rgba) == 0 && is(rgba, 0.875f, 0.4375f, 0.25f, 0.5f));
    const uint32_t constant[4] = {GL_CONSTANT_COLOR, GL_ONE, GL_ONE, GL_ZERO};
    memcpy(state.blend_factors, constant, sizeof constant);
    const float half[4] = {0.5f, 2, 0, 1};
    memcpy(state.blend_color, half, sizeof half);
    state.blend_functions[0] = state.blend_functions[1] = GL_FUNC_REVERSE_SUBTRACT;
    CHECK(blend(under, over, &state, rgba) == 0 && is(rgba, 0.75f, 0.0f, 0, -0.25f));
    state.blend = 0; /* and nothing of it is left */
    CHECK(blend(under, over, &state, rgba) == 0 && is(rgba, 0.5f, 0.25f, 1, 0.25f));
    CHECK(blend(under, over, NULL, rgba) == 0 && is(rgba, 0.5f, 0.25f, 1, 0.25f));
    state.blend = 1;
    state.blend_functions[0] = 7;
    CHECK_FAILS(blend(under, over, &state, rgba), "GL_INVALID_ENUM");
}

/* The first draw writes 1 where the mask allows it; the second is seen where the stencil is 1. */
static void test_stencil(void) {
    int32_t location = -1;
    uint32_t program = colored(&location);
    const hn_field fields[] = {HN_POSITION};
    const float black[4] = {0}, red[4] = {1, 0, 0, 1}, green[4] = {0, 1, 0, 1};
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    hn_mesh *mesh = cover(0);
    hn_state writes = start, reads = start;
    writes.depth_test = reads.depth_test = 0;
    writes.stencil_test = reads.stencil_test = 1;
    writes.stencil_reference = reads.stencil_reference = 1;
    writes.stencil_read_mask = reads.stencil_read_mask = 0xFF;
    writes.stencil_front = writes.stencil_back = (hn_stencil){GL_ALWAYS, GL_KEEP, GL_KEEP, GL_REPLACE};
    reads.stencil_front = (hn_stencil){GL_EQUAL, GL_KEEP, GL_KEEP, GL_KEEP};
    reads.stencil_back = (hn_stencil){GL_NEVER, GL_KEEP, GL_KEEP, GL_KEEP};
    const uint32_t masks[] = {0, 1, 0xFF};
    float rgba[4];
    for (int i = 0; i < 3; ++i) {
        writes.stencil_write_mask = masks[i];
        CHECK(clear(target, black) == 0);
        hn_program_uniform(program, location, GL_FLOAT_VEC4, 1, red);
        CHECK(draw_fields(target, program, mesh, fields, 1, &writes) == 0);
        hn_program_uniform(program, location, GL_FLOAT_VEC4, 1, green);
        CHECK(draw_fields(target, program, mesh, fields, 1, &reads) == 0);
        CHECK(hn_target_read_floats(target, rgba) == 0 && is(rgba, i == 0, i > 0, 0, 1));
    }
    /* Of back faces the other side counts. */
    reads.cull = GL_NONE;
    reads.front = GL_CW;
    hn_program_uniform(program, location, GL_FLOAT_VEC4, 1, red);
    CHECK(draw_fields(target, program, mesh, fields, 1, &reads) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && is(rgba, 0, 1, 0, 1));
    /* What the stencil refuses and what the depth refuses have operations of their own. */
    reads = start;
    reads.depth_test = 0;
    reads.stencil_test = 1;
    reads.stencil_read_mask = 0xFF;
    reads.stencil_front = reads.stencil_back = (hn_stencil){GL_EQUAL, GL_KEEP, GL_KEEP, GL_KEEP};
    writes.depth_test = 1;
    writes.depth_function = GL_NEVER;
    for (int reference = 1; reference <= 2; ++reference) {
        writes.stencil_front =
            (hn_stencil){reference == 1 ? GL_NEVER : GL_ALWAYS, GL_REPLACE, GL_INVERT, GL_ZERO};
        reads.stencil_reference = reference == 1 ? 1 : 0xFF;
        CHECK(clear(target, black) == 0);
        CHECK(draw_fields(target, program, mesh, fields, 1, &writes) == 0);
        CHECK(hn_target_read_floats(target, rgba) == 0 && is(rgba, 0, 0, 0, 0));
        CHECK(draw_fields(target, program, mesh, fields, 1, &reads) == 0);
        CHECK(hn_target_read_floats(target, rgba) == 0 && is(rgba, 1, 0, 0, 1));
    }
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(program);
}

/* How many of 9 x 9 pixels a draw of the covering triangle sets. */
static int count(uint32_t topology, const hn_state *state, int instanced, int instances) {
    int32_t location = -1;
    uint32_t program = colored(&location);
    const float one[4] = {1, 1, 1, 1}, black[4] = {0};
    const hn_vertex corners[] = {{.position = {-0.99f, -0.99f, 0}},
                                 {.position = {0.99f, -0.99f, 0}},
                                 {.position = {-0.99f, 0.99f, 0}}};
    const hn_attribute position = {0, GL_FLOAT, 3, sizeof(hn_vertex), 0, 0};
    hn_mesh *mesh = hn_mesh_create(corners, 3, NULL, 0);
    hn_target *target = hn_target_create(9, 9, GL_RGBA32F);
    const hn_call call = {.program = program,
                          .mesh = mesh,
                          .topology = topology,
                          .attributes = &position,
                          .n_attributes = 1,
                          .instanced = instanced,
                          .instances = instances,
                          .state = state};
    float rgba[81 * 4];
    int n = -1;
    if (hn_program_uniform(program, location, GL_FLOAT_VEC4, 1, one) == 0 && clear(target, black) == 0 &&
        hn_draw(target, &call) == 0 && hn_target_read_floats(target, rgba) == 0) {
        n = 0;
        for (int i = 0; i < 81; ++i)
            n += rgba[4 * i] == 1;
    }
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(program);
    return n;
}

static void test_topology(void) {
    hn_state lines = start;
    lines.fill = GL_LINE;
    int filled = count(GL_TRIANGLES, NULL, 0, 0);
    CHECK(filled > 30 && filled < 50);
    CHECK(count(GL_POINTS, NULL, 0, 0) == 3);
    CHECK(count(GL_LINES, NULL, 0, 0) >= 8 && count(GL_LINES, NULL, 0, 0) <= 9); /* the first two corners */
    CHECK(count(GL_TRIANGLES, &lines, 0, 0) < filled && count(GL_TRIANGLES, &lines, 0, 0) >= 20);
    CHECK(count(GL_TRIANGLES, NULL, 0, 0) == filled); /* lines do not stay */
    CHECK(count(GL_TRIANGLES, NULL, 1, 2) == filled && count(GL_TRIANGLES, NULL, 1, 0) == 0);
    CHECK_FAILS(count(GL_TRIANGLES, NULL, 1, -1) == -1, "GL_INVALID_VALUE");
    CHECK_FAILS(count(77, NULL, 0, 0) == -1, "GL_INVALID_ENUM");
    CHECK_FAILS(count(GL_PATCHES, NULL, 0, 0) == -1, "GL_INVALID_OPERATION");
}

/* Vertices and instances of buffers: three instances of one point, each at its own place with its own number. */
static void test_buffers(void) {
    uint32_t program = hn_program_create(
        "#version 330\nlayout(location = 0) in vec2 corner;\nlayout(location = 1) in float place;\n"
        "layout(location = 2) in float number;\nflat out float n;\n"
        "void main() { n = number; gl_Position = vec4(corner.x + place, 0.0, 0.0, 1.0); }\n",
        "#version 330\nflat in float n;\nout vec4 color;\nvoid main() { color = vec4(n); }\n");
    const float corner[2] = {0, 0}, black[4] = {0};
    const struct {
        float place;
        int32_t number;
    } rows[3] = {{-0.6f, 5}, {0, 6}, {0.6f, 7}};
    uint32_t corners = hn_buffer_create(sizeof corner, corner),
             per_instance = hn_buffer_create(sizeof rows, rows);
    const hn_attribute attributes[] = {{corners, GL_FLOAT, 2, 8, 0, 0},
                                       {per_instance, GL_FLOAT, 1, 8, 0, 1},
                                       {per_instance, GL_INT, 1, 8, 4, 1}};
    const hn_call call = {.program = program,
                          .n_vertices = 1,
                          .topology = GL_POINTS,
                          .attributes = attributes,
                          .n_attributes = 3,
                          .instanced = 1,
                          .instances = 3};
    hn_target *target = hn_target_create(3, 1, GL_RGBA32F);
    float rgba[12];
    CHECK(clear(target, black) == 0 && hn_draw(target, &call) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && rgba[0] == 5 && rgba[4] == 6 && rgba[8] == 7);
    hn_target_delete(target);
    hn_buffer_delete(corners);
    hn_buffer_delete(per_instance);
    hn_program_delete(program);
}

/* A geometry stage and both tessellation stages between: the patch of three corners goes through unchanged. */
static void test_stages(void) {
    const char *texts[HN_STAGES] = {
        [HN_VERTEX] = "#version 400\nlayout(location = 0) in vec3 position;\n"
                      "void main() { gl_Position = vec4(position, 1.0); }\n",
        [HN_TESS_CONTROL] = "#version 400\nlayout(vertices = 3) out;\nvoid main() {\n"
                            "gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
                            "gl_TessLevelInner[0] = 1.0; gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = "
                            "gl_TessLevelOuter[2] = 1.0; }\n",
        [HN_TESS_EVALUATION] =
            "#version 400\nlayout(triangles) in;\nvoid main() { gl_Position = "
            "gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position "
            "+ gl_TessCoord.z * gl_in[2].gl_Position; }\n",
        [HN_GEOMETRY] = "#version 400\nlayout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n"
                        "out float n;\nvoid main() { for (int i = 0; i < 3; ++i) { n = 0.5; gl_Position = "
                        "gl_in[i].gl_Position; EmitVertex(); } }\n",
        [HN_FRAGMENT] = "#version 400\nin float n;\nout vec4 color;\nvoid main() { color = vec4(n); }\n"};
    uint32_t program = hn_program_create_stages(texts);
    const float black[4] = {0};
    const hn_attribute position = {0, GL_FLOAT, 3, sizeof(hn_vertex), 0, 0};
    hn_mesh *mesh = cover(0);
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    const hn_call call = {.program = program,
                          .mesh = mesh,
                          .topology = GL_PATCHES,
                          .attributes = &position,
                          .n_attributes = 1,
                          .patch_vertices = 3};
    float rgba[4];
    CHECK(program != 0 && clear(target, black) == 0 && hn_draw(target, &call) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && rgba[0] == 0.5f);
    texts[HN_GEOMETRY] = "#version 400\nvoid main() { x = 1; }\n";
    CHECK_FAILS(hn_program_create_stages(texts) == 0, "geometry: 0:2(");
    texts[HN_GEOMETRY] = NULL;
    texts[HN_TESS_CONTROL] = "#version 400\nvoid main() { x = 1; }\n";
    CHECK_FAILS(hn_program_create_stages(texts) == 0, "tess_control: 0:2(");
    CHECK_FAILS(hn_program_create_stages(NULL) == 0, "no texts");
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(program);
}

void test_draw(void) {
    test_state_does_not_stay();
    test_places();
    test_state();
    test_fields();
    test_blend();
    test_stencil();
    test_topology();
    test_buffers();
    if (hn_compute_available())
        test_stages();
}
