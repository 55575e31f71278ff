/* internal.h: what the files of the library share and its users do not see.
 *
 * State: no operation relies on what another left bound or enabled. Each binds what it uses and sets every
 * state that it depends on; textures bound to units by hn_texture_bind are the one thing that outlives a
 * call, and whoever needs a texture unit for himself puts back what was bound there.
 */
#ifndef HARNESS_INTERNAL_H
#define HARNESS_INTERNAL_H

#include "harness.h"
#include "gl.h"

#if defined(__GNUC__)
#define HN_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define HN_PRINTF(format_index, first)
#endif

/* Sets the message that hn_error() gives, of any length, and returns -1. An argument may be hn_error()
 * itself. */
int hn_fail(const char *format, ...) HN_PRINTF(1, 2);

/* Fails unless a context is open and this thread is the one it belongs to. */
int hn_context_check(const char *operation);
/* Counts the contexts that were opened, 0 when none is open. An object remembers it: GL names from a closed
 * context mean nothing, or another's objects, in the next. */
uint32_t hn_context_id(void);
/* The vertex array object for draws without attributes. */
uint32_t hn_context_vertex_array(void);

/* The most bytes we let one image take: llvmpipe crashes at 2 GiB instead of reporting GL_OUT_OF_MEMORY. */
#define HN_IMAGE_BYTES_MAX ((size_t)1 << 30)
/* Fails unless an image of this size is within GL's limits and HN_IMAGE_BYTES_MAX. Needs a context. */
int hn_image_check(const char *operation, int width, int height, size_t bytes_per_pixel);

/* A run of a mesh with its own vertices, as a model file has it: gl_VertexID starts at 0 in each. */
typedef struct {
    size_t first_vertex, n_vertices, first_index, n_indices;
} hn_part;

enum { HN_INPUTS_MAX = 64, HN_OUTPUTS_MAX = 8, HN_COMPONENTS_MAX = 1 << 16 };

/* Fails unless the arrays of an evaluation are such as can be; an output has at most `components_max` components. */
int hn_arrays_check(const hn_input *inputs, int n_inputs, const hn_output *outputs, int n_outputs,
                    uint32_t components_max);
/* Makes `buffer` a buffer over the caller's memory and returns 1; where that cannot be, one of the same size, filled
 * when it is an `input`, and returns 0. */
int hn_buffer_over(uint32_t binding, uint32_t buffer, const void *data, size_t size, int input);

/* The inputs of a program in use, each in its texture unit. */
typedef struct {
    int n;
    uint32_t buffers[HN_INPUTS_MAX], textures[HN_INPUTS_MAX];
} hn_bound_inputs;
int hn_inputs_bind(hn_bound_inputs *bound, uint32_t program, const hn_input *inputs, int n_inputs);
void hn_inputs_release(const hn_bound_inputs *bound);

/* Makes the target the one that is drawn to and read from. */
int hn_target_use(const char *operation, const hn_target *target);
/* Whatever else could keep a pixel from being written. */
void hn_write_everything(void);
/* Width and height of what draws fill. */
void hn_target_size(const hn_target *target, int *width, int *height);

struct hn_mesh {
    uint32_t context_id;
    uint32_t vertex_buffer, index_buffer;
    uint32_t fields;
    size_t n_vertices, n_indices, n_stray_faces;
    size_t n_parts;
    hn_part *parts;
};

#endif
