/* test_texture.c: textures of all kinds, by texels that are known beforehand. */
#include "check.h"

#include <math.h>
#include <stdlib.h>

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
    if (hn_program_uniforms(program, &map, 1) != 1 || hn_texture_bind(unit, GL_TEXTURE_2D, texture) ||
        hn_program_uniform(program, map.location, map.type, 1, &unit) || draw_pixel(program, rgba) ||
        hn_texture_bind(unit, GL_TEXTURE_2D, 0))
        rgba[0] = -1;
    hn_program_delete(program);
    return (int)lroundf(rgba[0] * 255);
}

static uint32_t texture_2d(int width, int height, const uint8_t *rgba, uint32_t min_filter,
                           uint32_t mag_filter, uint32_t wrap_s, uint32_t wrap_t) {
    const hn_sampling sampling = {min_filter, mag_filter, wrap_s, wrap_t, GL_REPEAT};
    return hn_texture_create(width, height, 0, rgba, &sampling);
}

/* Samples by this expression from the texture on unit 2, whose sampler is of this kind; red, as a byte. */
static int sample_other(uint32_t target, uint32_t texture, const char *kind, const char *place) {
    char fragment[256];
    snprintf(fragment, sizeof fragment,
             "#version 330\nuniform %s map;\nout vec4 color;\nvoid main() { color = texture(map, %s); }\n",
             kind, place);
    uint32_t program = hn_program_create(POSITION_VERTEX, fragment);
    const int32_t unit = 2;
    hn_variable map;
    float rgba[4] = {-1};
    if (hn_program_uniforms(program, &map, 1) != 1 || hn_texture_bind(unit, target, texture) ||
        hn_program_uniform(program, map.location, map.type, 1, &unit) || draw_pixel(program, rgba) ||
        hn_texture_bind(unit, target, 0))
        rgba[0] = -1;
    hn_program_delete(program);
    return (int)lroundf(rgba[0] * 255);
}

static const hn_sampling nearest_edge = {GL_NEAREST, GL_NEAREST, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE,
                                         GL_CLAMP_TO_EDGE};

/* Each face of a cube map in its direction: +x -x +y -y +z -z have 10, 20, ... 60. */
static void test_cube(void) {
    uint8_t faces[6 * 4] = {0};
    for (int i = 0; i < 6; ++i)
        faces[4 * i] = (uint8_t)(10 * (i + 1));
    uint32_t cube = hn_texture_create_cube(1, 1, faces, &nearest_edge);
    const char *directions[] = {"vec3(1, 0, 0)",  "vec3(-1, 0, 0)", "vec3(0, 1, 0)",
                                "vec3(0, -1, 0)", "vec3(0, 0, 1)",  "vec3(0, 0, -1)"};
    for (int i = 0; i < 6; ++i)
        CHECK(sample_other(GL_TEXTURE_CUBE_MAP, cube, "samplerCube", directions[i]) == 10 * (i + 1));
    hn_texture_delete(cube);
    CHECK_FAILS(hn_texture_create_cube(1, 1, NULL, &nearest_edge) == 0, "no pixels");
    CHECK_FAILS(hn_texture_create_cube(1, 1, faces, NULL) == 0, "no sampling");
}

static void test_volume(void) {
    const uint8_t slices[8] = {10, 0, 0, 255, 20, 0, 0, 255};
    uint32_t volume = hn_texture_create(1, 1, 2, slices, &nearest_edge);
    CHECK(sample_other(GL_TEXTURE_3D, volume, "sampler3D", "vec3(0.5, 0.5, 0.25)") == 10);
    CHECK(sample_other(GL_TEXTURE_3D, volume, "sampler3D", "vec3(0.5, 0.5, 0.75)") == 20);
    float texels[8] = {0};
    CHECK(hn_texture_read(GL_TEXTURE_3D, volume, texels) == 0);
    CHECK(lroundf(texels[0] * 255) == 10 && lroundf(texels[4] * 255) == 20 && texels[7] == 1);
    hn_texture_delete(volume);
    CHECK_FAILS(hn_texture_create(1, 1, -1, slices, &nearest_edge) == 0, "the driver's limit");
    CHECK_FAILS(hn_texture_create(1, 1, INT32_MAX, slices, &nearest_edge) == 0, "the driver's limit");
    CHECK_FAILS(hn_texture_create(2048, 2048, 2048, slices, &nearest_edge) == 0, "MiB work");
}

static void test_empty(void) {
    float texels[2 * 3 * 4];
    for (int i = 0; i < 24; ++i)
        texels[i] = 7;
    uint32_t empty = hn_texture_create_empty(2, 3, 0, GL_RGBA32F, &nearest_edge);
    CHECK(hn_texture_read(GL_TEXTURE_2D, empty, texels) == 0);
    int zero = 1;
    for (int i = 0; i < 24; ++i)
        zero = zero && texels[i] == 0;
    CHECK(zero);
    CHECK_FAILS(hn_texture_read(GL_TEXTURE_2D, empty, NULL) == -1, "nowhere to put the pixels");
    hn_texture_delete(empty);
    CHECK_FAILS(hn_texture_create_empty(1, 1, 0, GL_RGBA32F, NULL) == 0, "no sampling");
    CHECK_FAILS(hn_texture_create_empty(1, 1, 0, 7, &nearest_edge) == 0, "GL_INVALID");
}

/* Floats beyond 0 ... 1 stay, and a level of theirs is a mean too; other formats than ours are refused. */
static void test_formats(void) {
    const float floats[16] = {-1, 0, 0, 1, 3, 0, 0, 1, -1, 0, 0, 1, 3, 0, 0, 1};
    const hn_sampling linear = {GL_LINEAR_MIPMAP_LINEAR, GL_NEAREST, GL_REPEAT, GL_REPEAT, GL_REPEAT};
    uint32_t of_floats = hn_texture_create_as(GL_RGBA32F, 2, 2, floats, &linear);
    CHECK(sample(of_floats, 0.25f, 0.25f, 0) == -255 && sample(of_floats, 0.75f, 0.25f, 0) == 765);
    CHECK(sample(of_floats, 0.25f, 0.25f, 1) == 255);
    hn_texture_delete(of_floats);
    const hn_sampling nearest = {GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_REPEAT, GL_REPEAT};
    uint32_t of_ints = hn_texture_create_as(GL_RGBA32I, 2, 2, floats, &nearest);
    CHECK(of_ints != 0);
    hn_texture_delete(of_ints);
    CHECK_FAILS(hn_texture_create_as(GL_R8, 2, 2, floats, &nearest) == 0, "no texture of format 0x8229");
    CHECK_FAILS(hn_texture_create_as(GL_RGBA8, 0, 2, floats, &nearest) == 0, "0 x 2 pixels");
    CHECK_FAILS(hn_texture_create_as(GL_RGBA8, 2, 2, NULL, &nearest) == 0, "no pixels");
    CHECK_FAILS(hn_texture_create_as(GL_RGBA8, 2, 2, floats, NULL) == 0, "no sampling");
}

void test_texture(void) {
    test_formats();
    test_cube();
    test_volume();
    test_empty();
    uint32_t nearest = texture_2d(2, 2, four, GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_CLAMP_TO_EDGE);
    CHECK(sample(nearest, 0.25f, 0.25f, 0) == 0 && sample(nearest, 0.75f, 0.25f, 0) == 60);
    CHECK(sample(nearest, 0.25f, 0.75f, 0) == 120 && sample(nearest, 0.6f, 0.6f, 0) == 180);
    CHECK(sample(nearest, 1.25f, 0.25f, 0) == 0);   /* repeats in s */
    CHECK(sample(nearest, 0.25f, 1.25f, 0) == 120); /* stays at the edge in t */
    hn_texture_delete(nearest);

    uint32_t linear = texture_2d(2, 2, four, GL_LINEAR, GL_LINEAR, GL_MIRRORED_REPEAT, GL_REPEAT);
    CHECK(sample(linear, 0.5f, 0.25f, 0) == 30 && sample(linear, 0.5f, 0.5f, 0) == 90);
    CHECK(sample(linear, 1.25f, 0.25f, 0) == 60); /* mirrored */
    CHECK(sample(linear, 0.25f, 0.25f, 1) == 0);  /* no mipmaps by this filter */
    hn_texture_delete(linear);

    uint32_t mipmapped = texture_2d(2, 2, four, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_REPEAT, GL_REPEAT);
    CHECK(sample(mipmapped, 0.25f, 0.25f, 1) == 90); /* the mean of the four */
    CHECK(sample(mipmapped, 0.25f, 0.25f, 0.5f) == 45);
    hn_texture_delete(mipmapped);

    /* A width of any kind: rows are 4-byte aligned whatever it is. */
    const uint8_t three[12] = {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255};
    uint32_t odd = texture_2d(3, 1, three, GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_REPEAT);
    CHECK(sample(odd, 0.1f, 0.5f, 0) == 10 && sample(odd, 0.5f, 0.5f, 0) == 20 &&
          sample(odd, 0.9f, 0.5f, 0) == 30);

    /* Making a texture or a target leaves what is bound: `odd` on unit 0, where samplers read by default. */
    uint32_t program =
        hn_program_create(POSITION_VERTEX, "#version 330\nuniform sampler2D map;\nout vec4 color;\nvoid "
                                           "main() { color = texture(map, vec2(0.1)); }\n");
    float rgba[4] = {0};
    CHECK(hn_texture_bind(0, GL_TEXTURE_2D, odd) == 0);
    uint32_t other = texture_2d(2, 2, four, GL_LINEAR, GL_LINEAR, GL_REPEAT, GL_REPEAT);
    CHECK(draw_pixel(program, rgba) == 0 && lroundf(rgba[0] * 255) == 10);
    hn_texture_delete(other);
    hn_texture_delete(odd);
    hn_program_delete(program);

    const uint32_t n = GL_NEAREST, r = GL_REPEAT;
    CHECK_FAILS(texture_2d(0, 1, four, n, n, r, r) == 0, "hn_texture_create: 0 x 1 pixels");
    CHECK_FAILS(texture_2d(1, -1, four, n, n, r, r) == 0, "both must be at least 1");
    CHECK_FAILS(texture_2d(1, INT32_MAX, four, n, n, r, r) == 0, "the driver's limit is");
    CHECK_FAILS(texture_2d(1, 1, NULL, n, n, r, r) == 0, "no pixels");
    CHECK_FAILS(texture_2d(2, 2, four, 7, n, r, r) == 0, "GL_INVALID_ENUM");
    CHECK_FAILS(texture_2d(2, 2, four, n, GL_LINEAR_MIPMAP_LINEAR, r, r) == 0, "GL_INVALID_ENUM");
    CHECK_FAILS(texture_2d(2, 2, four, n, n, r, 7) == 0, "GL_INVALID_ENUM");
    CHECK_FAILS(hn_texture_bind(-1, GL_TEXTURE_2D, 0) == -1, "unit -1: the driver has 0 ... ");
    CHECK_FAILS(hn_texture_bind(100000, GL_TEXTURE_2D, 0) == -1, "unit 100000");
    CHECK_FAILS(hn_texture_bind(0, GL_TEXTURE_2D, 9999) == -1,
                "hn_texture_bind: unit 0, texture 9999: GL_INVALID_OPERATION");
}
