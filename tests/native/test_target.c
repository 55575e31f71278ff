/* test_target.c: targets, single and joined: cleared, and read back. */
#include "check.h"

#include <math.h>

/* Clamped and rounded by GL into bytes, as they are into floats; alpha 1 when there is none. */
static void test_clear_and_read(void) {
    const float rgba[4] = {-0.5f, 0.5f, 2, 0.25f};
    for (int alpha = 0; alpha < 2; ++alpha) {
        hn_target *target = hn_target_create(3, 2, alpha ? GL_RGBA32F : GL_RGB32F);
        CHECK(clear(target, rgba) == 0);
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
        CHECK_FAILS(hn_target_clear_color(target, 0, NULL) == -1, "no colour");
        CHECK_FAILS(hn_target_clear_color(target, 1, rgba) == -1, "no colour 1 of 1");
        CHECK_FAILS(hn_target_clear_color(target, -1, rgba) == -1, "no colour -1");
        hn_target_delete(target);
    }
}

/* A format of 8 bits keeps 0...1 alone; one of one channel has no others. */
static void test_formats(void) {
    const float rgba[4] = {2, 0.5f, -1, 0.25f};
    float read[4];
    hn_target *bytes = hn_target_create(1, 1, GL_RGBA);
    CHECK(clear(bytes, rgba) == 0 && hn_target_read_floats(bytes, read) == 0);
    CHECK(read[0] == 1 && lroundf(read[1] * 255) == 128 && read[2] == 0 && lroundf(read[3] * 255) == 64);
    hn_target_delete(bytes);
    hn_target *red = hn_target_create(1, 1, GL_R16F);
    CHECK(clear(red, rgba) == 0 && hn_target_read_floats(red, read) == 0);
    CHECK(read[0] == 2 && read[1] == 0 && read[2] == 0 && read[3] == 1);
    hn_target_delete(red);
    CHECK_FAILS(!hn_target_create(1, 1, GL_RGB9_E5), "the driver draws to no texture of format 0x8C3D");
    CHECK_FAILS(!hn_target_create(1, 1, 7), "GL_INVALID");
}

/* A new target is 0, its depth too: nothing is nearer until it is cleared. */
static void test_new(void) {
    uint32_t program = hn_program_create(
        POSITION_VERTEX, "#version 330\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n");
    const hn_field fields[] = {HN_POSITION};
    hn_mesh *mesh = cover(0);
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    float rgba[4] = {7, 7, 7, 7};
    CHECK(hn_target_read_floats(target, rgba) == 0 && rgba[0] == 0 && rgba[3] == 0);
    CHECK(draw_fields(target, program, mesh, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && rgba[0] == 0);
    CHECK(hn_target_clear_depth(target, 0) == 0); /* which leaves the depth */
    CHECK(draw_fields(target, program, mesh, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && rgba[0] == 0);
    CHECK(hn_target_clear_depth(target, 1) == 0);
    CHECK(draw_fields(target, program, mesh, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && rgba[0] == 1);
    hn_target_delete(target);
    hn_mesh_delete(mesh);
    hn_program_delete(program);
}

/* Output i goes to target i, at the depth of the last; each is cleared by itself, and read as a texture. */
static void test_join(void) {
    uint32_t program = hn_program_create(
        POSITION_VERTEX, "#version 330\nlayout(location = 0) out vec4 a;\nlayout(location = 1) out vec4 b;\n"
                         "void main() { a = vec4(0.25); b = vec4(0.5); }\n");
    const hn_field fields[] = {HN_POSITION};
    const float one[4] = {1, 1, 1, 1}, two[4] = {2, 2, 2, 2};
    hn_mesh *mesh = cover(0);
    hn_target *first = hn_target_create(1, 1, GL_RGBA32F), *second = hn_target_create(1, 1, GL_RGBA16F);
    hn_target *both[] = {first, second}, *nested[1];
    hn_target *joined = hn_target_join(both, 2, 1, 1);
    float a[4], b[4];
    CHECK(joined && hn_target_texture(joined) == 0 && hn_target_texture(first) != 0);
    CHECK(hn_target_clear_color(joined, 0, one) == 0 && hn_target_clear_color(joined, 1, two) == 0);
    CHECK(hn_target_read_floats(first, a) == 0 && a[0] == 1);
    CHECK(hn_target_read_floats(second, b) == 0 && b[0] == 2);
    CHECK(hn_target_clear_depth(first, 1) == 0);
    CHECK(draw_fields(joined, program, mesh, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(first, a) == 0 && a[0] == 1); /* the depth of the second is still 0 */
    CHECK(hn_target_clear_depth(second, 1) == 0);
    CHECK(draw_fields(joined, program, mesh, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(first, a) == 0 && a[0] == 0.25f);
    CHECK(hn_target_read_floats(second, b) == 0 && b[0] == 0.5f);
    CHECK(hn_target_read_floats(joined, a) == 0 && a[0] == 0.25f); /* the first of them */

    nested[0] = joined;
    CHECK_FAILS(!hn_target_join(nested, 1, 1, 1), "target 0 is none that can be joined");
    CHECK_FAILS(!hn_target_join(NULL, 1, 1, 1), "0 targets");
    CHECK_FAILS(!hn_target_join(both, 0, 1, 1), "0 targets");
    CHECK_FAILS(!hn_target_join(both, 1000, 1, 1), "1000 targets");
    both[1] = NULL;
    CHECK_FAILS(!hn_target_join(both, 2, 1, 1), "target 1 is none");
    CHECK(hn_target_texture(NULL) == 0);
    hn_target_delete(joined);
    hn_target_delete(first);
    hn_target_delete(second);
    hn_mesh_delete(mesh);
    hn_program_delete(program);
}

static void test_sizes(void) {
    CHECK_FAILS(!hn_target_create(0, 5, GL_RGB32F),
                "hn_target_create: 0 x 5 pixels: both must be at least 1");
    CHECK_FAILS(!hn_target_create(5, -5, GL_RGB32F), "at least 1");
    CHECK_FAILS(!hn_target_create(INT32_MAX, 1, GL_RGB32F), "the driver's limit is");
    CHECK_FAILS(!hn_target_create(16384, 16384, GL_RGB32F), "4096 MiB: at most 1024 MiB work");
    hn_target *wide = hn_target_create(16384, 1, GL_RGB32F);
    CHECK(wide != NULL);
    hn_target_delete(wide);
}

void test_target(void) {
    test_clear_and_read();
    test_formats();
    test_new();
    test_join();
    test_sizes();
}
