/* test_buffer.c: buffers, and compute programs that fill buffers and images. */
#include "check.h"

static const char doubles[] =
    "#version 430\nlayout(local_size_x = 1) in;\n"
    "layout(std430, binding = 1) buffer Numbers { float numbers[]; };\n"
    "layout(rgba32f, binding = 0) uniform image2D picture;\n"
    "void main() {\n"
    "    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y + gl_GlobalInvocationID.z;\n"
    "    numbers[i] *= 2.0;\n"
    "    imageStore(picture, ivec2(i, 0), vec4(numbers[i]));\n"
    "}\n";

static void test_dispatch(void) {
    const char *const texts[HN_STAGES] = {[HN_COMPUTE] = doubles};
    const hn_sampling sampling = {GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_REPEAT, GL_REPEAT};
    const float numbers[3] = {1, 2, 3};
    float read[3] = {0}, texels[12] = {0};
    uint32_t program = hn_program_create_stages(texts), buffer = hn_buffer_create(sizeof numbers, numbers);
    uint32_t picture = hn_texture_create_empty(3, 1, 0, GL_RGBA32F, &sampling);
    CHECK(program && buffer && picture);
    CHECK(hn_buffer_bind(1, buffer) == 0 && hn_image_bind(0, picture, GL_RGBA32F, 0) == 0);
    CHECK(hn_dispatch(program, 3, 1, 1) == 0);
    CHECK(hn_buffer_read(buffer, sizeof read, read) == 0 && read[0] == 2 && read[1] == 4 && read[2] == 6);
    CHECK(hn_texture_read(GL_TEXTURE_2D, picture, texels) == 0 && texels[0] == 2 && texels[4] == 4 &&
          texels[8] == 6);
    CHECK(hn_dispatch(program, 1, 2, 1) == 0 && hn_dispatch(program, 1, 1, 3) == 0);
    CHECK(hn_buffer_read(buffer, sizeof read, read) == 0 && read[0] == 8 && read[1] == 16 && read[2] == 12);
    CHECK(hn_dispatch(program, 0, 1, 1) == 0);
    CHECK(hn_buffer_bind(1, 0) == 0);
    CHECK_FAILS(hn_dispatch(9999, 1, 1, 1) == -1, "program 9999: GL_INVALID_VALUE");
    CHECK_FAILS(hn_dispatch(program, 100000, 1, 1) == -1, "GL_INVALID_VALUE");
    CHECK_FAILS(hn_image_bind(0, 9999, GL_RGBA32F, 0) == -1, "GL_INVALID_VALUE");
    hn_texture_delete(picture);
    hn_buffer_delete(buffer);
    hn_program_delete(program);
}

void test_buffer(void) {
    unsigned char bytes[4] = {7, 7, 7, 7};
    uint32_t zeros = hn_buffer_create(4, NULL);
    CHECK(hn_buffer_read(zeros, 4, bytes) == 0 && bytes[0] == 0 && bytes[3] == 0);
    CHECK_FAILS(hn_buffer_read(zeros, 5, bytes) == -1, "GL_INVALID_VALUE");
    CHECK_FAILS(hn_buffer_read(zeros, 4, NULL) == -1, "nowhere to put the bytes");
    CHECK_FAILS(hn_buffer_bind(-1, zeros) == -1, "binding -1");
    CHECK_FAILS(hn_buffer_bind(100000, zeros) == -1, "GL_INVALID_VALUE");
    CHECK_FAILS(hn_buffer_create(0, NULL) == 0, "0 bytes");
    CHECK_FAILS(hn_buffer_create(SIZE_MAX, NULL) == 0, "bytes: 1 to");
    hn_buffer_delete(zeros);
    if (hn_compute_available())
        test_dispatch();
}
