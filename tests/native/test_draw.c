/* test_draw.c: textures, targets and draws, by pixels that are known beforehand. */
#include "check.h"

#include <math.h>
#include <stdlib.h>

#define UV_VERTEX                              \
    "#version 330\n"                           \
    "layout(location = 0) in vec3 position;\n" \
    "layout(location = 1) in vec2 texcoord;\n" \
    "out vec2 uv;\n"                           \
    "void main() { uv = texcoord; gl_Position = vec4(position, 1.0); }\n"

/* A texture of 2 x 2 with red 0, 60 in the lower row and 120, 180 in the upper; green is 255 throughout. */
static const uint8_t four[16] = {0, 255, 0, 255, 60, 255, 0, 255, 120, 255, 0, 255, 180, 255, 0, 255};

/* Samples the texture on unit 3 at (u, v) and level of detail; red, as a byte. */
static int sample(uint32_t texture, float u, float v, float level) {
    char fragment[256];
    snprintf(fragment, sizeof fragment,
             "#version 330\nuniform sampler2D map;\nout vec4 color;\n"
             "void main() { color = textureLod(map, vec2(%f, %f), %f); }\n",
             u, v, level);
    uint32_t program = hn_program_create(POSITION_VERTEX, fragment);
    const int32_t unit = 3;
    hn_variable map;
    float rgba[4] = {-1};
    if (hn_program_uniforms(program, &map, 1) != 1 || hn_texture_bind(unit, texture) ||
        hn_program_uniform(program, map.location, map.type, 1, &unit) || draw_pixel(program, rgba) ||
        hn_texture_bind(unit, 0))
        rgba[0] = -1;
    hn_program_delete(program);
    return (int)lroundf(rgba[0] * 255);
}

void test_texture(void) {
    uint32_t nearest = hn_texture_create(2, 2, four, GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_CLAMP_TO_EDGE);
    CHECK(sample(nearest, 0.25f, 0.25f, 0) == 0 && sample(nearest, 0.75f, 0.25f, 0) == 60);
    CHECK(sample(nearest, 0.25f, 0.75f, 0) == 120 && sample(nearest, 0.6f, 0.6f, 0) == 180);
    CHECK(sample(nearest, 1.25f, 0.25f, 0) == 0);   /* repeats in s */
    CHECK(sample(nearest, 0.25f, 1.25f, 0) == 120); /* stays at the edge in t */
    hn_texture_delete(nearest);

    uint32_t linear = hn_texture_create(2, 2, four, GL_LINEAR, GL_LINEAR, GL_MIRRORED_REPEAT, GL_REPEAT);
    CHECK(sample(linear, 0.5f, 0.25f, 0) == 30 && sample(linear, 0.5f, 0.5f, 0) == 90);
    CHECK(sample(linear, 1.25f, 0.25f, 0) == 60); /* mirrored */
    CHECK(sample(linear, 0.25f, 0.25f, 1) == 0);  /* no mipmaps by this filter */
    hn_texture_delete(linear);

    uint32_t mipmapped =
        hn_texture_create(2, 2, four, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_REPEAT, GL_REPEAT);
    CHECK(sample(mipmapped, 0.25f, 0.25f, 1) == 90); /* the mean of the four */
    CHECK(sample(mipmapped, 0.25f, 0.25f, 0.5f) == 45);
    hn_texture_delete(mipmapped);

    /* Other formats: floats beyond 0 ... 1 stay, and a level of theirs is a mean too. */
    const float floats[16] = {-1, 0, 0, 1, 3, 0, 0, 1, -1, 0, 0, 1, 3, 0, 0, 1};
    uint32_t of_floats = hn_texture_create_as(GL_RGBA32F, 2, 2, floats, GL_LINEAR_MIPMAP_LINEAR, GL_NEAREST,
                                              GL_REPEAT, GL_REPEAT);
    CHECK(sample(of_floats, 0.25f, 0.25f, 0) == -255 && sample(of_floats, 0.75f, 0.25f, 0) == 765);
    CHECK(sample(of_floats, 0.25f, 0.25f, 1) == 255);
    hn_texture_delete(of_floats);
    uint32_t of_ints =
        hn_texture_create_as(GL_RGBA32I, 2, 2, floats, GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_REPEAT);
    CHECK(of_ints != 0);
    hn_texture_delete(of_ints);
    CHECK_FAILS(hn_texture_create_as(GL_R8, 2, 2, floats, GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_REPEAT) == 0,
                "no texture of format 0x8229");

    /* A width of any kind: rows are 4-byte aligned whatever it is. */
    const uint8_t three[12] = {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255};
    uint32_t odd = hn_texture_create(3, 1, three, GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_REPEAT);
    CHECK(sample(odd, 0.1f, 0.5f, 0) == 10 && sample(odd, 0.5f, 0.5f, 0) == 20 &&
          sample(odd, 0.9f, 0.5f, 0) == 30);

    /* Making a texture or a target leaves what is bound: `odd` on unit 0, where samplers read by default. */
    uint32_t program =
        hn_program_create(POSITION_VERTEX, "#version 330\nuniform sampler2D map;\nout vec4 color;\nvoid "
                                           "main() { color = texture(map, vec2(0.1)); }\n");
    float rgba[4] = {0};
    CHECK(hn_texture_bind(0, odd) == 0);
    uint32_t other = hn_texture_create(2, 2, four, GL_LINEAR, GL_LINEAR, GL_REPEAT, GL_REPEAT);
    CHECK(draw_pixel(program, rgba) == 0 && lroundf(rgba[0] * 255) == 10);
    hn_texture_delete(other);
    hn_texture_delete(odd);
    hn_program_delete(program);

    const uint32_t n = GL_NEAREST, r = GL_REPEAT;
    CHECK_FAILS(hn_texture_create(0, 1, four, n, n, r, r) == 0, "hn_texture_create: 0 x 1 pixels");
    CHECK_FAILS(hn_texture_create(1, -1, four, n, n, r, r) == 0, "both must be at least 1");
    CHECK_FAILS(hn_texture_create(1, INT32_MAX, four, n, n, r, r) == 0, "the driver's limit is");
    CHECK_FAILS(hn_texture_create(1, 1, NULL, n, n, r, r) == 0, "no pixels");
    CHECK_FAILS(hn_texture_create(2, 2, four, 7, n, r, r) == 0, "GL_INVALID_ENUM");
    CHECK_FAILS(hn_texture_create(2, 2, four, n, GL_LINEAR_MIPMAP_LINEAR, r, r) == 0, "GL_INVALID_ENUM");
    CHECK_FAILS(hn_texture_create(2, 2, four, n, n, r, 7) == 0, "GL_INVALID_ENUM");
    CHECK_FAILS(hn_texture_bind(-1, 0) == -1, "unit -1: the driver has 0 ... ");
    CHECK_FAILS(hn_texture_bind(100000, 0) == -1, "unit 100000");
    CHECK_FAILS(hn_texture_bind(0, 9999) == -1,
                "hn_texture_bind: unit 0, texture 9999: GL_INVALID_OPERATION");
}

/* Clamped and rounded by GL into bytes, as they are into floats; alpha 1 when there is none. */
static void test_clear_and_read(void) {
    const float rgba[4] = {-0.5f, 0.5f, 2, 0.25f};
    for (int alpha = 0; alpha < 2; ++alpha) {
        hn_target *target = hn_target_create(3, 2, alpha);
        CHECK(hn_target_clear(target, rgba) == 0);
        uint8_t bytes[3 * 2 * 4 + 1];
        float floats[3 * 2 * 4 + 1];
        memset(bytes, 77, sizeof bytes);
        floats[24] = 77;
        CHECK(hn_target_read_bytes(target, bytes) == 0 && hn_target_read_floats(target, floats) == 0);
        int right = 1;
        for (int i = 0; i < 6; ++i) {
            right = right && bytes[4 * i] == 0 && bytes[4 * i + 1] == 128 && bytes[4 * i + 2] == 255 &&
                    bytes[4 * i + 3] == (alpha ? 64 : 255);
            right = right && floats[4 * i] == -0.5f && floats[4 * i + 1] == 0.5f && floats[4 * i + 2] == 2 &&
                    floats[4 * i + 3] == (alpha ? 0.25f : 1);
        }
        CHECK(right);
        CHECK(bytes[24] == 77 && floats[24] == 77); /* nothing past the end */
        CHECK_FAILS(hn_target_read_bytes(target, NULL) == -1, "nowhere to put the pixels");
        CHECK_FAILS(hn_target_clear(target, NULL) == -1, "no colour");
        hn_target_delete(target);
    }
}

/* At any width each pixel comes back at its place, row 0 at the bottom. */
static void test_places(void) {
    uint32_t program =
        hn_program_create(POSITION_VERTEX, "#version 330\nout vec4 color;\nvoid main() { color = "
                                           "vec4((gl_FragCoord.xy - 0.5) / 255.0, 0.2, 0.5); }\n");
    const hn_field fields[] = {HN_POSITION};
    hn_mesh *mesh = cover(0);
    for (int width = 1; width <= 9; ++width) {
        const int height = 3;
        hn_target *target = hn_target_create(width, height, 0);
        uint8_t bytes[9 * 3 * 4];
        CHECK(hn_draw(target, program, mesh, fields, 1, NULL) == 0 &&
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
    hn_target *target = hn_target_create(1, 1, 1);
    hn_mesh *near = cover(-0.5f), *far = cover(0.5f), *back = hn_mesh_create(reversed, 3, NULL, 0);
    hn_variable value;
    float rgba[4];
    CHECK(hn_program_uniforms(program, &value, 1) == 1);

    hn_program_uniform(program, value.location, GL_FLOAT_VEC4, 1, red);
    CHECK(hn_target_clear(target, black) == 0 && hn_draw(target, program, back, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, black, sizeof rgba) == 0);
    CHECK(hn_draw(target, program, far, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, red, sizeof rgba) == 0);
    hn_program_uniform(program, value.location, GL_FLOAT_VEC4, 1, green);
    CHECK(hn_draw(target, program, far, fields, 1, NULL) == 0); /* equal depth is not less */
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, red, sizeof rgba) == 0);
    CHECK(hn_draw(target, program, near, fields, 1, NULL) == 0); /* over it, alpha and all */
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, green, sizeof rgba) == 0);
    hn_program_uniform(program, value.location, GL_FLOAT_VEC4, 1, red);
    CHECK(hn_draw(target, program, far, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, green, sizeof rgba) == 0);
    CHECK(hn_target_clear(target, black) == 0 && hn_draw(target, program, far, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && memcmp(rgba, red, sizeof rgba) == 0);

    /* Each part of a state that is given; without one a back face and what lies beyond the far plane are left out. */
    hn_mesh *beyond = cover(1.5f);
    const hn_state both_sides = {GL_NONE, GL_CCW, 0}, clockwise = {GL_BACK, GL_CW, 0},
                   no_front = {GL_FRONT, GL_CCW, 0}, clamped = {GL_BACK, GL_CCW, 1};
    const struct {
        const hn_mesh *mesh;
        const hn_state *state;
        int seen;
    } draws[] = {{back, NULL, 0},      {back, &both_sides, 1}, {back, &clockwise, 1}, {back, &no_front, 1},
                 {far, &clockwise, 0}, {far, &no_front, 0},    {beyond, NULL, 0},     {near, &clamped, 1}};
    for (size_t i = 0; i < sizeof draws / sizeof *draws; ++i) {
        CHECK(hn_target_clear(target, black) == 0);
        CHECK(hn_draw(target, program, draws[i].mesh, fields, 1, draws[i].state) == 0);
        CHECK(hn_target_read_floats(target, rgba) == 0);
        CHECK(memcmp(rgba, draws[i].seen ? red : black, sizeof rgba) == 0);
    }
    /* Clamped, what lies before the near plane is at depth 0: drawn, and nothing is nearer. */
    hn_mesh *before = cover(-1.5f);
    CHECK(hn_target_clear(target, black) == 0);
    CHECK(hn_draw(target, program, before, fields, 1, NULL) == 0 && hn_target_read_floats(target, rgba) == 0);
    CHECK(memcmp(rgba, black, sizeof rgba) == 0);
    CHECK(hn_draw(target, program, before, fields, 1, &clamped) == 0 &&
          hn_target_read_floats(target, rgba) == 0);
    CHECK(memcmp(rgba, red, sizeof rgba) == 0);
    hn_mesh_delete(beyond);
    hn_mesh_delete(before);

    hn_mesh_delete(near);
    hn_mesh_delete(far);
    hn_mesh_delete(back);
    hn_target_delete(target);
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
    hn_target *target = hn_target_create(1, 1, 1);
    hn_mesh *mesh = cover(0);
    float rgba[4];
    CHECK(hn_draw(target, with, mesh, six, 6, NULL) == 0 && hn_target_read_floats(target, rgba) == 0);
    CHECK(rgba[0] == 0.5f && rgba[1] == 0.5f);
    CHECK(hn_draw(target, without, mesh, NULL, 0, NULL) == 0 && hn_target_read_floats(target, rgba) == 0);
    CHECK(rgba[0] == 0 && rgba[1] == 0 && rgba[2] == 0 && rgba[3] == 1);

    const hn_field unknown[] = {(hn_field)6};
    CHECK_FAILS(hn_draw(target, with, mesh, unknown, 1, NULL) == -1, "field 0 is 6");
    CHECK_FAILS(hn_draw(target, with, mesh, six, -1, NULL) == -1, "fields given");
    CHECK_FAILS(hn_draw(target, with, mesh, six, 1000, NULL) == -1, "fields given");
    CHECK_FAILS(hn_draw(target, with, mesh, NULL, 1, NULL) == -1, "fields given");
    CHECK_FAILS(hn_draw(target, 0, mesh, six, 1, NULL) == -1, "hn_draw: no program");
    CHECK_FAILS(hn_draw(target, 9999, mesh, six, 1, NULL) == -1, "hn_draw: program 9999: GL_INVALID_VALUE");
    CHECK_FAILS(hn_draw(target, with, NULL, six, 1, NULL) == -1, "hn_draw: no mesh");
    CHECK_FAILS(hn_draw(NULL, with, mesh, six, 1, NULL) == -1, "hn_draw: no target");
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(with);
    hn_program_delete(without);
}

static void test_target_sizes(void) {
    CHECK_FAILS(!hn_target_create(0, 5, 0), "hn_target_create: 0 x 5 pixels: both must be at least 1");
    CHECK_FAILS(!hn_target_create(5, -5, 0), "at least 1");
    CHECK_FAILS(!hn_target_create(INT32_MAX, 1, 0), "the driver's limit is");
    CHECK_FAILS(!hn_target_create(16384, 16384, 0), "4096 MiB: at most 1024 MiB work");
    hn_target *wide = hn_target_create(16384, 1, 0);
    CHECK(wide != NULL);
    hn_target_delete(wide);
}

void test_draw(void) {
    test_clear_and_read();
    test_places();
    test_state();
    test_fields();
    test_target_sizes();
}
