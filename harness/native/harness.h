/* harness.h: the whole interface of the native harness.
 *
 * One small library compiles GLSL, evaluates it over arrays, and draws meshes, offscreen: no display, no GPU.
 * It knows contexts, programs, textures, meshes, draws and reads; it knows nothing of projects, materials or
 * numpy.
 *
 *     hn_context_open();
 *     uint32_t program = hn_program_create(vertex_text, fragment_text);
 *     if (!program) puts(hn_error());
 *
 * Conventions
 *   - One context a process, used from one thread: two GL providers in one process share state and crash.
 *   - int functions return 0 when they did what they say and -1 when not; handles are NULL or 0 when not.
 *     hn_error() then says why, in words meant for a user, naming the operation; nothing is ever printed.
 *   - Every operation checks GL's error flag at its end.
 *   - A `char *` result is the caller's: give it to hn_free(). A `const char *` result is the library's.
 *   - Enumerations of GL (GL_FLOAT_VEC3, GL_LINEAR, ...) are passed as they are, as uint32_t.
 *   - Images have row 0 at the bottom, as in GL.
 */
#ifndef HARNESS_H
#define HARNESS_H

#include <stddef.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif
/* These are exported; all else in the library is hidden (-fvisibility=hidden). */
#if defined(__GNUC__)
#pragma GCC visibility push(default)
#endif

/* The message of the last failure in this process; "" when there was none. Valid until the next call. */
const char *hn_error(void);
void hn_free(void *memory);

/* ---- Context (context.c) ------------------------------------------------------------------------------- */

/* Which library makes the context: "osmesa" (Mesa in software, without a display; what is taken unless another is
 * chosen), "egl" (a GPU without a display, else software), "glfw" (the desktop's driver, by a hidden window).
 * Fails for another when this process has opened a context already. */
int hn_context_choose(const char *backend);
/* Makes the process's one context (core profile). Calling it again does nothing. */
int hn_context_open(void);
void hn_context_close(void);
/* "renderer\nversion\nGLSL version\nbackend" of the open context. */
const char *hn_context_info(void);

/* ---- GLSL through glslang (glslang.c); needs no context ------------------------------------------------ */

typedef enum { HN_VERTEX = 0, HN_FRAGMENT = 1 } hn_stage;

/* Checks one stage by glslang's OpenGL rules, all its errors at once. Returns -1 with glslang's own lines
 * ("ERROR: 0:LINE: ...") in hn_error(). `spirv` != 0 also generates SPIR-V, as SHADERed's check does (its
 * rules are stricter: functions called must have bodies, uniform blocks need bindings). */
int hn_glsl_check(hn_stage stage, const char *text, int spirv);
/* The text after the preprocessor: same line numbers, macros and conditionals resolved, comments gone. */
char *hn_glsl_preprocess(hn_stage stage, const char *text);
/* glslang's dump of the syntax tree, uncalled functions included: function signatures with in/out, parameter
 * and member names. `text` needs no main(). */
char *hn_glsl_tree(hn_stage stage, const char *text);

/* ---- Programs (program.c) ------------------------------------------------------------------------------ */

/* Compiles and links with the driver. On failure hn_error() is "vertex: LOG", "fragment: LOG" or "link: LOG"
 * with the driver's log, unedited. */
uint32_t hn_program_create(const char *vertex, const char *fragment);
/* Of one compute stage, where hn_compute_available(). On failure hn_error() is "compute: LOG" or "link: LOG". */
uint32_t hn_program_create_compute(const char *compute);
void hn_program_delete(uint32_t program);

/* An active uniform or vertex attribute, as the linker left it. */
typedef struct {
    char name[256];
    uint32_t type;    /* GL_FLOAT_VEC3, GL_SAMPLER_2D, ... */
    int32_t size;     /* elements of an array; 1 otherwise */
    int32_t location; /* -1 for built-ins such as gl_VertexID */
} hn_variable;

/* Fill `out` with at most `capacity` entries; return how many there are in all, or -1. */
int hn_program_uniforms(uint32_t program, hn_variable *out, int capacity);
int hn_program_attributes(uint32_t program, hn_variable *out, int capacity);

/* Sets one uniform. `type` is GL's (GL_FLOAT ... GL_FLOAT_MAT4, GL_INT*, GL_UNSIGNED_INT*, GL_BOOL*, samplers
 * as their unit); `data` holds `count` elements of 4-byte components, matrices column by column. */
int hn_program_uniform(uint32_t program, int32_t location, uint32_t type, int32_t count, const void *data);

/* ---- Evaluation over arrays (evaluate.c, compute.c, arrays.c) ------------------------------------------ */

/* One input array. The shader reads it through the uniform samplerBuffer (isamplerBuffer,
 * usamplerBuffer) called `name`. It is handed to the driver where it lies, not copied, when the driver can
 * read it there. */
typedef struct {
    const char *name;
    const void *data;    /* count * components values of 4 bytes */
    uint32_t base;       /* GL_FLOAT, GL_INT or GL_UNSIGNED_INT */
    uint32_t components; /* 1 ... 4 */
    size_t count;        /* texels; at most hn_evaluate_limit() */
} hn_input;

/* One output array, of which each element is the first `components` numbers of a vector. */
typedef struct {
    float *data; /* count * components floats, bit for bit as the shader made them */
    uint32_t components;
} hn_output;

/* Runs a program made with hn_evaluate_vertex() once for each i = 0 ... count-1, where its fragment stage
 * finds i = hn_first + int(gl_FragCoord.y) * hn_width + int(gl_FragCoord.x) from `uniform int hn_first,
 * hn_width`. Output k is the fragment output at location k. An i beyond count-1 can occur and is dropped: the
 * shader must not rely on i < count. */
int hn_evaluate(uint32_t program, const hn_input *inputs, int n_inputs, const hn_output *outputs,
                int n_outputs, size_t count);
/* The vertex stage for it: one triangle over the whole target, made from gl_VertexID. */
const char *hn_evaluate_vertex(void);
/* The most texels an input may have. */
size_t hn_evaluate_limit(void);

/* Whether the context has compute stages (GL 4.3), which evaluate faster and need no memory of their own. */
int hn_compute_available(void);
/* The same by a compute program whose text begins, after its #version, with hn_compute_head(). It finds
 *     i = int(gl_GlobalInvocationID.x), and leaves when i >= hn_count, `uniform int hn_count`.
 * Output k is the shader storage block of binding k, an array of floats: components of them for each element. */
int hn_compute(uint32_t program, const hn_input *inputs, int n_inputs, const hn_output *outputs,
               int n_outputs, size_t count);
const char *hn_compute_head(void);
/* The most elements of so many components that one hn_compute takes, a multiple of 4. */
size_t hn_compute_limit(uint32_t components);

/* ---- Meshes (mesh.c) ----------------------------------------------------------------------------------- */

/* A vertex with everything a shader may ask for, in SHADERed's order. What a file lacks is 0, colour is 1. */
typedef struct {
    float position[3], normal[3], texcoord[2], tangent[3], bitangent[3], color[4];
} hn_vertex;

/* The fields of hn_vertex, for layouts. */
typedef enum { HN_POSITION, HN_NORMAL, HN_TEXCOORD, HN_TANGENT, HN_BITANGENT, HN_COLOR } hn_field;

typedef struct hn_mesh hn_mesh;

/* All meshes of a model file in node order, in mesh-local coordinates (node transforms and materials
 * ignored), read by Assimp with Triangulate and FlipUVs and nothing else, as SHADERed does. */
hn_mesh *hn_mesh_load(const char *path);
/* A mesh from vertices; `indices` may be NULL for vertices in order. */
hn_mesh *hn_mesh_create(const hn_vertex *vertices, size_t n_vertices, const uint32_t *indices,
                        size_t n_indices);
void hn_mesh_delete(hn_mesh *mesh);
/* Bit (1 << field) is set when every part of the mesh came with that field. */
uint32_t hn_mesh_fields(const hn_mesh *mesh);
size_t hn_mesh_vertex_count(const hn_mesh *mesh);
size_t hn_mesh_index_count(const hn_mesh *mesh);
/* Copies the mesh back: as many vertices and indices as it has; the indices count through all its parts. */
int hn_mesh_read(const hn_mesh *mesh, hn_vertex *vertices, uint32_t *indices);

/* ---- Textures (texture.c) ------------------------------------------------------------------------------ */

/* An 8-bit RGBA texture without colour conversion, mipmaps made; `wrap` and filters are GL's. */
uint32_t hn_texture_create(int width, int height, const uint8_t *rgba, uint32_t min_filter,
                           uint32_t mag_filter, uint32_t wrap_s, uint32_t wrap_t);
void hn_texture_delete(uint32_t texture);
int hn_texture_bind(int unit, uint32_t texture);

/* ---- Targets and draws (draw.c) ------------------------------------------------------------------------ */

typedef struct hn_target hn_target;

/* A framebuffer as SHADERed's window has it: 32-bit float RGB (RGBA when `alpha`), 24-bit depth. It starts
 * as 0 and at the farthest depth. */
hn_target *hn_target_create(int width, int height, int alpha);
void hn_target_delete(hn_target *target);
int hn_target_clear(hn_target *target, const float rgba[4]);
/* What a draw does with the faces that it meets. */
typedef struct {
    uint32_t cull;   /* GL_NONE, GL_BACK or GL_FRONT: the faces that are left out */
    uint32_t front;  /* GL_CCW or GL_CW: how a front face's vertices go round */
    int depth_clamp; /* 1: what lies before the near or beyond the far plane is drawn too */
} hn_state;

/* Draws a mesh as triangles; attribute location k reads fields[k]. Depth test LESS, no blending. `state` NULL is the
 * state at the start of a pass of SHADERed's: back faces culled, counter-clockwise is front, no depth clamp. */
int hn_draw(hn_target *target, uint32_t program, const hn_mesh *mesh, const hn_field *fields, int n_fields,
            const hn_state *state);
/* Reads the colour: width * height * 4 values, bottom row first; alpha is 1 without an alpha channel.
 * The bytes are clamped to 0...1 and rounded by GL; the floats are as drawn. */
int hn_target_read_bytes(hn_target *target, uint8_t *rgba);
int hn_target_read_floats(hn_target *target, float *rgba);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif
#if defined(__cplusplus)
}
#endif
#endif
