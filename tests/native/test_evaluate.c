/* test_evaluate.c: evaluation over arrays. */
#include "check.h"

#include <stdlib.h>

#define INDEX                           \
    "#version 330\n"                    \
    "uniform int hn_width, hn_first;\n" \
    "int i = 0;\n"                      \
    "void find() { i = hn_first + int(gl_FragCoord.y) * hn_width + int(gl_FragCoord.x); }\n"

/* Each element of every output is the function of the same element of the inputs, for any count. */
static void test_elements(void) {
    uint32_t program =
        hn_program_create(hn_evaluate_vertex(), INDEX
                          "uniform samplerBuffer x;\nuniform isamplerBuffer k;\n"
                          "layout(location = 0) out vec4 a;\nlayout(location = 1) out vec4 b;\n"
                          "void main() { find(); vec3 v = texelFetch(x, i).xyz; int n = texelFetch(k, i).x;\n"
                          "a = vec4(v.z, v.y, v.x, 0.0); b = vec4(float(n)); }\n");
    CHECK(program != 0);
    static const size_t counts[] = {1, 2, 17, 1000, 2048 * 1024 + 5, 2 * 2048 * 1024 + 4099};
    /* the last two take two and three tiles, ending in a row begun */
    for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c) {
        size_t n = counts[c];
        float *x = malloc(n * 3 * sizeof *x), *a = malloc(n * 3 * sizeof *a), *b = malloc(n * sizeof *b);
        int32_t *k = malloc(n * sizeof *k);
        for (size_t i = 0; i < n; ++i) {
            for (size_t j = 0; j < 3; ++j)
                x[3 * i + j] = (float)(3 * i + j) * 0.5f;
            k[i] = -(int32_t)i;
        }
        const hn_input inputs[] = {{"x", x, GL_FLOAT, 3, n}, {"k", k, GL_INT, 1, n}};
        const hn_output outputs[] = {{a, 3}, {b, 1}};
        CHECK(hn_evaluate(program, inputs, 2, outputs, 2, n) == 0);
        size_t wrong = 0;
        for (size_t i = 0; i < n; ++i)
            wrong += a[3 * i] != x[3 * i + 2] || a[3 * i + 2] != x[3 * i] || b[i] != (float)k[i];
        CHECK(wrong == 0);
        free(x);
        free(k);
        free(a);
        free(b);
    }
    hn_program_delete(program);
}

/* The same by a compute stage, into memory that can be pinned and into memory that is not aligned for it. */
static void test_compute(void) {
    CHECK(hn_compute_available() == 1);
    char text[1024];
    snprintf(text, sizeof text,
             "#version 430\n%suniform int hn_count;\nuniform samplerBuffer x;\n"
             "layout(std430, binding = 0) writeonly buffer A { float a[]; };\n"
             "void main() { int i = int(gl_GlobalInvocationID.x); if (i >= hn_count) return;\n"
             "vec3 v = texelFetch(x, i).xyz; a[2 * i] = v.z; a[2 * i + 1] = v.x; }\n",
             hn_compute_head());
    uint32_t program = hn_program_create_compute(text);
    CHECK(program != 0);
    enum { N = 1000, GUARD = 8 };
    float *x = malloc(N * 3 * sizeof *x), *memory = malloc((N * 2 + 2 * GUARD) * sizeof *memory);
    for (int i = 0; i < 3 * N; ++i)
        x[i] = (float)i;
    for (int shift = 0; shift < 4; ++shift) {
        for (int i = 0; i < N * 2 + 2 * GUARD; ++i)
            memory[i] = -1;
        const hn_input input = {"x", x, GL_FLOAT, 3, N};
        const hn_output output = {memory + GUARD + shift, 2};
        CHECK(hn_compute(program, &input, 1, &output, 1, N, 1) == 0);
        size_t wrong = 0;
        for (int i = 0; i < N; ++i)
            wrong += output.data[2 * i] != x[3 * i + 2] || output.data[2 * i + 1] != x[3 * i];
        for (int i = 0; i < GUARD; ++i)
            wrong += output.data[-1 - i] >= 0 || (i < GUARD - shift && output.data[2 * N + i] >= 0);
        CHECK(wrong == 0);
    }
    const hn_input input = {"x", x, GL_FLOAT, 3, N};
    const hn_output output = {memory, 2}, no_components = {memory, 0};
    CHECK(hn_compute(program, &input, 1, &output, 1, 0, 1) == 0);
    CHECK(hn_compute_limit(4) > 1000000 && hn_compute_limit(4) % 4 == 0);
    CHECK(hn_compute_limit(1) >= hn_compute_limit(4));
    CHECK_FAILS(hn_compute(program, &input, 1, &output, 1, (size_t)1 << 40, 1) == -1, "at a time");
    CHECK_FAILS(hn_compute(program, &input, 1, &no_components, 1, N, 1) == -1, "0 components");
    CHECK_FAILS(hn_compute(9999, &input, 1, &output, 1, N, 1) == -1, "GL_INVALID_VALUE");
    CHECK_FAILS(hn_compute(program, &input, 1, &output, 1, N, 0) == -1, "0 elements an invocation");
    CHECK_FAILS(hn_program_create_compute("#version 430\nvoid main() { x; }\n") == 0, "compute: ");
    CHECK_FAILS(hn_program_create_compute(NULL) == 0, "no text");
    free(x);
    free(memory);
    hn_program_delete(program);
}

/* An invocation evaluates several elements; an element has more numbers than a texel. */
static void test_compute_wide(void) {
    char text[1024];
    snprintf(text, sizeof text,
             "#version 430\n%suniform int hn_count;\nuniform samplerBuffer x;\n"
             "layout(std430, binding = 0) writeonly buffer A { vec4 a[]; };\n"
             "void main() { int i = int(gl_GlobalInvocationID.x) * 2; if (i >= hn_count) return;\n"
             "for (int k = 0; k < 4; ++k) a[2 * i + k] = texelFetch(x, 2 * i + k) + float(k); }\n",
             hn_compute_head());
    uint32_t program = hn_program_create_compute(text);
    CHECK(program != 0);
    enum { N = 1002, SIZE = 8 };
    float *x = malloc(N * SIZE * sizeof *x), *y = malloc((N * SIZE + 1) * sizeof *y);
    for (int i = 0; i < N * SIZE; ++i)
        x[i] = (float)i;
    y[N * SIZE] = -1;
    const hn_input input = {"x", x, GL_FLOAT, 4, N * SIZE / 4};
    const hn_output output = {y, SIZE};
    CHECK(hn_compute(program, &input, 1, &output, 1, N, 2) == 0);
    size_t wrong = y[N * SIZE] >= 0;
    for (int i = 0; i < N * SIZE; ++i)
        wrong += y[i] != (float)(i + i / 4 % 4);
    CHECK(wrong == 0);
    free(x);
    free(y);
    hn_program_delete(program);
}

static void test_failures(void) {
    uint32_t program = hn_program_create(hn_evaluate_vertex(),
                                         INDEX "uniform samplerBuffer x;\nlayout(location = 0) out vec4 a;\n"
                                               "void main() { find(); a = texelFetch(x, i); }\n");
    float value = 5, result = 0;
    const hn_input input = {"x", &value, GL_FLOAT, 1, 1}, wide = {"x", &value, GL_FLOAT, 5, 1};
    const hn_output output = {&result, 1}, no_components = {&result, 0};
    CHECK(hn_evaluate_limit() >= 65536);
    CHECK(hn_evaluate(program, &input, 1, &output, 1, 0) == 0 && result == 0);
    CHECK(hn_evaluate(program, &input, 1, &output, 1, 1) == 0 && result == 5);
    CHECK_FAILS(hn_evaluate(program, &wide, 1, &output, 1, 1) == -1, "hn_evaluate: input x: 5 components");
    CHECK_FAILS(hn_evaluate(program, &input, 1, &no_components, 1, 1) == -1,
                "hn_evaluate: output 0: 0 components");
    CHECK_FAILS(hn_evaluate(program, &input, 1000, &output, 1, 1) == -1, "1000 inputs");
    CHECK_FAILS(hn_evaluate(program, &input, 1, &output, 0, 1) == -1, "0 outputs");
    CHECK_FAILS(hn_evaluate(9999, &input, 1, &output, 1, 1) == -1, "program 9999");
    hn_program_delete(program);
}

void test_evaluate(void) {
    test_elements();
    test_compute();
    test_compute_wide();
    test_failures();
}
