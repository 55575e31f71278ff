/* check.h: what the tests of the C library share. */
#ifndef HARNESS_CHECK_H
#define HARNESS_CHECK_H

#include "harness.h"

#include <GL/glcorearb.h>
#include <stdio.h>
#include <string.h>

extern int n_passed, n_failed;

#define CHECK(condition)                                                                                   \
    do {                                                                                                   \
        if (condition) {                                                                                   \
            ++n_passed;                                                                                    \
        } else {                                                                                           \
            ++n_failed;                                                                                    \
            printf("%s:%d: failed: %s\n    hn_error(): %s\n", __FILE__, __LINE__, #condition, hn_error()); \
        }                                                                                                  \
    } while (0)

/* The condition tells of a failure, and hn_error() says this about it. */
#define CHECK_FAILS(condition, text) CHECK((condition) && strstr(hn_error(), text))

/* A vertex stage that passes attribute 0, a vec3, on as the position. */
#define POSITION_VERTEX                        \
    "#version 330\n"                           \
    "layout(location = 0) in vec3 position;\n" \
    "void main() { gl_Position = vec4(position, 1.0); }\n"

/* A triangle over the whole of a target at this depth, counter-clockwise; texture coordinates 0 ... 1 across
 * the target. */
hn_mesh *cover(float z);
/* Sets the one colour and the depth of a target. */
int clear(hn_target *target, const float rgba[4]);
/* Draws a mesh as triangles; attribute location k reads fields[k]. */
int draw_fields(hn_target *target, uint32_t program, const hn_mesh *mesh, const hn_field *fields,
                int n_fields, const hn_state *state);
/* Draws with a program that takes the position alone over a target of 1 x 1, and reads the pixel. */
int draw_pixel(uint32_t program, float rgba[4]);

void test_context(void);
void test_glsl(void);
void test_program(void);
void test_mesh(void);
void test_texture(void);
void test_draw(void);
void test_target(void);
void test_buffer(void);
void test_evaluate(void);
void test_window(int has_window);

#endif
