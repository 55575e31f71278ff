/* test_native.c: runs the tests of the C library; and those of the context and of failures themselves. */
#include "check.h"

#include <dlfcn.h>
#include <stddef.h>
#include <stdlib.h>
#include <threads.h>

int n_passed, n_failed;
static const char *backend = "osmesa";

hn_mesh *cover(float z) {
    const hn_vertex vertices[] = {{.position = {-1, -1, z}, .texcoord = {0, 0}},
                                  {.position = {3, -1, z}, .texcoord = {2, 0}},
                                  {.position = {-1, 3, z}, .texcoord = {0, 2}}};
    return hn_mesh_create(vertices, 3, NULL, 0);
}

int clear(hn_target *target, const float rgba[4]) {
    return hn_target_clear_color(target, 0, rgba) || hn_target_clear_depth(target, 1) ? -1 : 0;
}

int draw_fields(hn_target *target, uint32_t program, const hn_mesh *mesh, const hn_field *fields,
                int n_fields, const hn_state *state) {
    static const hn_attribute of[] = {
        [HN_POSITION] = {0, GL_FLOAT, 3, sizeof(hn_vertex), offsetof(hn_vertex, position), 0},
        [HN_NORMAL] = {0, GL_FLOAT, 3, sizeof(hn_vertex), offsetof(hn_vertex, normal), 0},
        [HN_TEXCOORD] = {0, GL_FLOAT, 2, sizeof(hn_vertex), offsetof(hn_vertex, texcoord), 0},
        [HN_TANGENT] = {0, GL_FLOAT, 3, sizeof(hn_vertex), offsetof(hn_vertex, tangent), 0},
        [HN_BITANGENT] = {0, GL_FLOAT, 3, sizeof(hn_vertex), offsetof(hn_vertex, bitangent), 0},
        [HN_COLOR] = {0, GL_FLOAT, 4, sizeof(hn_vertex), offsetof(hn_vertex, color), 0}};
    hn_attribute attributes[8];
    for (int i = 0; i < n_fields; ++i)
        attributes[i] = of[fields[i]];
    const hn_call call = {.program = program,
                          .mesh = mesh,
                          .topology = GL_TRIANGLES,
                          .attributes = attributes,
                          .n_attributes = n_fields,
                          .state = state};
    return hn_draw(target, &call);
}

int draw_pixel(uint32_t program, float rgba[4]) {
    const hn_field fields[] = {HN_POSITION};
    hn_target *target = hn_target_create(1, 1, GL_RGBA32F);
    hn_mesh *mesh = cover(0);
    const float black[4] = {0};
    int result = target && mesh && clear(target, black) == 0
                     ? draw_fields(target, program, mesh, fields, 1, NULL)
                     : -1;
    if (result == 0)
        result = hn_target_read_floats(target, rgba);
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    return result;
}

/* Without a context everything that needs one says so, and deleting nothing is allowed. */
static void test_no_context(void) {
    const char *reason = "no context: call hn_context_open() first";
    const hn_vertex triangle[3] = {{.position = {0}}};
    const uint8_t pixel[4] = {0};
    const float value = 0, black[4] = {0};
    hn_variable variable;
    CHECK_FAILS(hn_context_choose("x") == -1, "no backend x; there are: osmesa, egl, glfw");
    CHECK(hn_context_choose("glfw") == 0); /* nothing is open: the last choice holds */
    CHECK(hn_context_choose(backend) == 0);
    CHECK_FAILS(hn_context_info() == NULL, reason);
    int32_t numbers[2];
    CHECK_FAILS(hn_context_integers(GL_MAX_TEXTURE_SIZE, 1, numbers) == -1, reason);
    CHECK_FAILS(hn_context_precision(GL_FRAGMENT_SHADER, GL_HIGH_FLOAT, numbers, numbers) == -1, reason);
    CHECK_FAILS(hn_program_create("", "") == 0, reason);
    CHECK_FAILS(hn_program_uniforms(1, &variable, 1) == -1, reason);
    CHECK_FAILS(hn_program_attributes(1, &variable, 1) == -1, reason);
    CHECK_FAILS(hn_program_uniform(1, 0, GL_FLOAT, 1, &value) == -1, reason);
    CHECK_FAILS(hn_evaluate(1, NULL, 0, NULL, 0, 1) == -1, reason);
    CHECK_FAILS(hn_evaluate_limit() == 0, reason);
    CHECK_FAILS(hn_mesh_create(triangle, 3, NULL, 0) == NULL, reason);
    CHECK_FAILS(hn_mesh_load("a.obj") == NULL, reason);
    const hn_sampling sampling = {GL_NEAREST, GL_NEAREST, GL_REPEAT, GL_REPEAT, GL_REPEAT};
    const char *const no_texts[HN_STAGES] = {NULL};
    float floats[4];
    CHECK_FAILS(hn_program_create_stages(no_texts) == 0, reason);
    CHECK_FAILS(hn_texture_create(1, 1, 0, pixel, &sampling) == 0, reason);
    CHECK_FAILS(hn_texture_create_cube(1, 1, pixel, &sampling) == 0, reason);
    CHECK_FAILS(hn_texture_create_empty(1, 1, 0, GL_RGBA8, &sampling) == 0, reason);
    CHECK_FAILS(hn_texture_bind(0, GL_TEXTURE_2D, 0) == -1, reason);
    CHECK_FAILS(hn_texture_read(GL_TEXTURE_2D, 0, floats) == -1, reason);
    CHECK_FAILS(hn_image_bind(0, 0, GL_RGBA8, 0) == -1, reason);
    CHECK_FAILS(hn_buffer_create(4, pixel) == 0, reason);
    CHECK_FAILS(hn_buffer_bind(0, 0) == -1, reason);
    CHECK_FAILS(hn_buffer_read(0, 4, floats) == -1, reason);
    CHECK_FAILS(hn_dispatch(1, 1, 1, 1) == -1, reason);
    CHECK_FAILS(hn_target_join(NULL, 0, 1, 1) == NULL, reason);
    CHECK_FAILS(hn_target_create(1, 1, GL_RGB32F) == NULL, reason);
    CHECK_FAILS(hn_draw(NULL, NULL) == -1, reason);
    CHECK_FAILS(hn_target_clear_color(NULL, 0, black) == -1, reason);
    CHECK_FAILS(hn_target_clear_depth(NULL, 1) == -1, reason);
    CHECK_FAILS(hn_target_read_bytes(NULL, NULL) == -1, reason);
    CHECK_FAILS(hn_target_read_floats(NULL, NULL) == -1, reason);
    hn_program_delete(0);
    hn_texture_delete(0);
    hn_buffer_delete(0);
    hn_mesh_delete(NULL);
    hn_target_delete(NULL);
    hn_free(NULL);
    CHECK(hn_context_take_error() == 0);
    hn_context_close();
}

/* An error that none of our operations has made, and none has reported, is told once. */
static void test_take_error(void) {
    CHECK(hn_context_take_error() == 0);
    if (strcmp(backend, "osmesa") != 0)
        return; /* whose functions are easy to get */
    void *library = dlopen("libOSMesa.so.8", RTLD_LAZY);
    void *found = library ? dlsym(library, "glEnable") : NULL;
    void (*enable)(GLenum capability);
    memcpy(&enable, &found, sizeof enable);
    CHECK(found);
    enable(GL_TRIANGLES);
    CHECK_FAILS(hn_context_take_error() == -1, "GL: GL_INVALID_ENUM");
    CHECK(hn_context_take_error() == 0);
}

static void test_numbers(void) {
    int32_t numbers[4] = {0}, range[2] = {0}, bits = 0;
    CHECK(hn_context_integers(GL_MAX_VIEWPORT_DIMS, 2, numbers) == 0);
    CHECK(numbers[0] >= 1024 && numbers[1] >= 1024);
    CHECK_FAILS(hn_context_integers(GL_TRIANGLES, 1, numbers) == -1, "0x0004: GL_INVALID_ENUM");
    CHECK_FAILS(hn_context_integers(GL_MAX_TEXTURE_SIZE, 5, numbers) == -1, "5 numbers");
    if (hn_context_precision(GL_FRAGMENT_SHADER, GL_HIGH_FLOAT, range, &bits) == 0) {
        CHECK(range[1] == 127 && bits == 23);
    } else {
        CHECK(strstr(hn_error(), "does not say"));
    }
}

static void test_open_and_close(void) {
    CHECK(hn_context_open() == 0);
    CHECK(hn_context_open() == 0);
    const char *info = hn_context_info();
    CHECK(info && strcmp(strrchr(info, '\n') + 1, backend) == 0);
    CHECK(hn_context_choose(backend) == 0);
    CHECK_FAILS(hn_context_choose(strcmp(backend, "egl") ? "egl" : "osmesa") == -1,
                "two libraries of OpenGL in one process crash");
    printf("%s\n", info ? info : "");

    /* What a closed context leaves can be deleted, and is refused, not mistaken for the next context's. */
    hn_mesh *old_mesh = cover(0);
    hn_target *old_target = hn_target_create(1, 1, GL_RGB32F);
    hn_context_close();
    hn_context_close();
    CHECK_FAILS(hn_target_create(1, 1, GL_RGB32F) == NULL, "no context");
    CHECK(hn_context_open() == 0);
    hn_mesh *mesh = cover(0);
    hn_target *target = hn_target_create(1, 1, GL_RGB32F);
    uint32_t program = hn_program_create(
        POSITION_VERTEX, "#version 330\nout vec4 color;\nvoid main() { color = vec4(0.25); }\n");
    const hn_field fields[] = {HN_POSITION};
    const float black[4] = {0};
    float rgba[4];
    CHECK_FAILS(hn_target_clear_color(old_target, 0, black) == -1, "the target's context was closed");
    CHECK_FAILS(draw_fields(target, program, old_mesh, fields, 1, NULL) == -1,
                "the mesh's context was closed");
    hn_mesh_delete(old_mesh);
    hn_target_delete(old_target);
    CHECK(clear(target, black) == 0);
    CHECK(draw_fields(target, program, mesh, fields, 1, NULL) == 0);
    CHECK(hn_target_read_floats(target, rgba) == 0 && rgba[0] == 0.25f);
    hn_mesh_delete(mesh);
    hn_target_delete(target);
    hn_program_delete(program);
}

static int use_elsewhere(void *unused) {
    (void)unused;
    CHECK(hn_context_take_error() == 0);
    CHECK_FAILS(!hn_target_create(1, 1, GL_RGB32F), "the context belongs to the thread that opened it");
    CHECK_FAILS(hn_context_open() == -1, "the context belongs to the thread that opened it");
    return 0;
}

/* In another thread GL calls would go nowhere without a word. */
static void test_other_thread(void) {
    thrd_t thread;
    CHECK(thrd_create(&thread, use_elsewhere, NULL) == thrd_success &&
          thrd_join(thread, NULL) == thrd_success);
}

void test_context(void) {
    test_no_context();
    test_open_and_close();
    test_take_error();
    test_numbers();
    test_other_thread();
}

/* Leaks a mesh and a text, for proof that the checkers report what is ours, suppressions or not. */
static int leak(void) {
    if (hn_context_open() || !cover(0) || !hn_glsl_tree(HN_FRAGMENT, "#version 330\nfloat f;\n"))
        return EXIT_FAILURE;
    hn_context_close();
    return EXIT_SUCCESS;
}

int main(int argc, char **argv) {
    if (argc > 1 && strcmp(argv[1], "--leak") == 0)
        return leak();
    if (argc > 1)
        backend = argv[1]; /* all of the tests hold for each */
    test_glsl();           /* first: it must do without a context */
    test_context();
    test_program();
    test_mesh();
    test_evaluate(); /* before the draws: they must not see the state it sets */
    test_texture();
    test_target();
    test_buffer();
    test_draw();
    test_window(strcmp(backend, "glfw") == 0);
    hn_context_close();
    printf("%d passed, %d failed\n", n_passed, n_failed);
    return n_failed > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
