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
/* GL's limit or other number `name` (GL_MAX_TEXTURE_SIZE, ...), of which there are `count`, at most 4. */
int hn_context_integers(uint32_t name, int count, int32_t *values);
/* The range of GLSL ES's precision `type` (GL_HIGH_FLOAT, ...) in a stage (GL_FRAGMENT_SHADER, ...), as binary
 * logarithms of the smallest and largest magnitude, and how many bits it has. Fails below GL 4.3. */
int hn_context_precision(uint32_t stage, uint32_t type, int32_t range[2], int32_t *bits);
/* Returns -1 and names them in hn_error() where GL has errors that no operation has reported yet, as the deletion of
 * what is not there leaves them; they are forgotten. 0 when there is none, or no context in this thread. */
int hn_context_take_error(void);

/* ---- GLSL through glslang (glslang.c); needs no context ------------------------------------------------ */

typedef enum {
    HN_VERTEX,
    HN_FRAGMENT,
    HN_GEOMETRY,
    HN_TESS_CONTROL,
    HN_TESS_EVALUATION,
    HN_COMPUTE,
    HN_STAGES /* how many there are */
} hn_stage;

/* Checks one stage by glslang's OpenGL rules, all its errors at once. Returns -1 with glslang's own lines
 * ("ERROR: 0:LINE: ...") in hn_error(). `spirv` != 0 also generates SPIR-V, as SHADERed's check does (its
 * rules are stricter: functions called must have bodies, uniform blocks need bindings). */
int hn_glsl_check(hn_stage stage, const char *text, int spirv);
/* The text after the preprocessor: same line numbers, macros and conditionals resolved, comments gone. */
char *hn_glsl_preprocess(hn_stage stage, const char *text);
/* glslang's dump of the syntax tree, uncalled functions included: function signatures with in/out, parameter
 * and member names. `text` needs no main(). */
char *hn_glsl_tree(hn_stage stage, const char *text);
/* A stage with a main() as SPIR-V: what main() reaches, not optimised, with names and lines. Locations and
 * bindings that are not stated are given out. `*words` is the caller's: give it to hn_free(). */
int hn_glsl_spirv(hn_stage stage, const char *text, uint32_t **words, size_t *n_words);
/* The version of glslang, as "12.0.0". */
const char *hn_glsl_version(void);
/* The same for Vulkan 1.0, without lines; plain uniforms go into a block. */
int hn_glsl_spirv_vulkan(hn_stage stage, const char *text, uint32_t **words, size_t *n_words);

/* ---- Programs (program.c) ------------------------------------------------------------------------------ */

/* Compiles and links with the driver. On failure hn_error() is "vertex: LOG", "fragment: LOG" or "link: LOG"
 * with the driver's log, unedited. */
uint32_t hn_program_create(const char *vertex, const char *fragment);
/* The same of the stages that have a text, indexed by hn_stage; the others are NULL. The names in messages are those
 * of the enumeration: "geometry: LOG", "tess_control: LOG", ... */
uint32_t hn_program_create_stages(const char *const texts[HN_STAGES]);
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
/* Reads one element of a uniform: `components` values of 4 bytes (at most 16), matrices column by column; as floats
 * where `type` is one of GL_FLOAT ..., else as integers. */
int hn_program_uniform_read(uint32_t program, int32_t location, uint32_t type, int components, void *data);

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
    float *data;         /* count * components floats, bit for bit as the shader made them */
    uint32_t components; /* 1 ... 4; of a compute stage any number */
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
/* The same by a compute program whose text has hn_compute_head() before its main(). An invocation evaluates `each`
 * elements, the first of them
 *     i = int(gl_GlobalInvocationID.x) * each, and leaves when i >= hn_count, `uniform int hn_count`.
 * Output k is the shader storage block of binding k, an array of floats: components of them for each element. */
int hn_compute(uint32_t program, const hn_input *inputs, int n_inputs, const hn_output *outputs,
               int n_outputs, size_t count, uint32_t each);
const char *hn_compute_head(void);
/* The most elements of so many components that one hn_compute takes, a multiple of 4. */
size_t hn_compute_limit(uint32_t components);

/* ---- Meshes (mesh.c) ----------------------------------------------------------------------------------- */

/* A vertex with everything a shader may ask for, in SHADERed's order. What a file lacks is 0, colour is 1. */
typedef struct {
    float position[3], normal[3], texcoord[2], tangent[3], bitangent[3], color[4];
} hn_vertex;

/* The fields of hn_vertex. */
typedef enum { HN_POSITION, HN_NORMAL, HN_TEXCOORD, HN_TANGENT, HN_BITANGENT, HN_COLOR } hn_field;

typedef struct hn_mesh hn_mesh;

/* All meshes of a model file in node order, in mesh-local coordinates (node transforms and materials
 * ignored), read by Assimp with Triangulate and FlipUVs and nothing else, as SHADERed does. Points and lines
 * of the file go where triangles are expected, as in SHADERed; hn_mesh_stray_faces() counts them. */
hn_mesh *hn_mesh_load(const char *path);
/* A mesh from vertices; `indices` may be NULL for vertices in order. */
hn_mesh *hn_mesh_create(const hn_vertex *vertices, size_t n_vertices, const uint32_t *indices,
                        size_t n_indices);
void hn_mesh_delete(hn_mesh *mesh);
/* Bit (1 << field) is set when every part of the mesh came with that field. */
uint32_t hn_mesh_fields(const hn_mesh *mesh);
size_t hn_mesh_vertex_count(const hn_mesh *mesh);
size_t hn_mesh_index_count(const hn_mesh *mesh);
size_t hn_mesh_stray_faces(const hn_mesh *mesh);
/* Copies the mesh back: as many vertices and indices as it has; the indices count through all its parts. */
int hn_mesh_read(const hn_mesh *mesh, hn_vertex *vertices, uint32_t *indices);

/* ---- Buffers (buffer.c) -------------------------------------------------------------------------------- */

/* Memory of the driver's for vertices and for storage blocks; `data` may be NULL for zeros. */
uint32_t hn_buffer_create(size_t size, const void *data);
void hn_buffer_delete(uint32_t buffer);
/* Makes it the shader storage buffer of that binding; 0 unbinds. Needs GL 4.3. */
int hn_buffer_bind(int binding, uint32_t buffer);
int hn_buffer_read(uint32_t buffer, size_t size, void *data);
/* Runs a compute program over that many groups and waits until what it wrote can be read by anything. */
int hn_dispatch(uint32_t program, uint32_t x, uint32_t y, uint32_t z);

/* ---- Textures (texture.c) ------------------------------------------------------------------------------ */

typedef struct {
    uint32_t min_filter, mag_filter, wrap_s, wrap_t, wrap_r; /* GL's; wrap_r is for those with a depth */
} hn_sampling;

/* An 8-bit RGBA texture without colour conversion, mipmaps made. `depth` 0 is a 2D texture, else a 3D one. */
uint32_t hn_texture_create(int width, int height, int depth, const uint8_t *rgba,
                           const hn_sampling *sampling);
/* A 2D texture of RGBA texels in one of GL's formats, mipmaps made but for integers: GL_RGBA8 (from 4 bytes a texel),
 * GL_RGBA32F, GL_RGBA32I and GL_RGBA32UI (from 16). */
uint32_t hn_texture_create_as(uint32_t format, int width, int height, const void *texels,
                              const hn_sampling *sampling);
/* A cube map of 8-bit RGBA without mipmaps: faces +x -x +y -y +z -z, each width x height, one after the other. */
uint32_t hn_texture_create_cube(int width, int height, const uint8_t *rgba, const hn_sampling *sampling);
/* A texture of GL's internal `format`, all 0, without mipmaps. `depth` as above. */
uint32_t hn_texture_create_empty(int width, int height, int depth, uint32_t format,
                                 const hn_sampling *sampling);
void hn_texture_delete(uint32_t texture);
/* `target` is GL_TEXTURE_2D, GL_TEXTURE_3D or GL_TEXTURE_CUBE_MAP. */
int hn_texture_bind(int unit, uint32_t target, uint32_t texture);
/* Binds a texture to an image unit, for reading and writing by any stage; all layers of one with a depth. Needs
 * GL 4.2. */
int hn_image_bind(int unit, uint32_t texture, uint32_t format, int layered);
/* Reads all of it: width * height * max(depth, 1) * 4 floats. */
int hn_texture_read(uint32_t target, uint32_t texture, float *rgba);

/* ---- Targets (target.c) -------------------------------------------------------------------------------- */

typedef struct hn_target hn_target;

/* Something to draw to: a colour texture of GL's internal `format`, with 24 bits of depth and 8 of stencil. All
 * starts as 0, the depth too: in front of everything, until it is cleared. Where the driver cannot draw to
 * GL_RGB32F, it is GL_RGBA32F and reads as if it had no alpha. */
hn_target *hn_target_create(int width, int height, uint32_t format);
/* Several targets as one: fragment output i goes to targets[i]; depth and stencil are those of the last. Draws
 * fill `width` x `height`. The targets must live longer than it. */
hn_target *hn_target_join(hn_target *const *targets, int n_targets, int width, int height);
void hn_target_delete(hn_target *target);
/* The colour as a texture, GL_TEXTURE_2D, linearly filtered and repeated; 0 of joined targets. It is the target's. */
uint32_t hn_target_texture(const hn_target *target);
int hn_target_clear_color(hn_target *target, int index, const float rgba[4]);
/* Depth to the farthest unless `write_depth` is 0, and stencil to 0. */
int hn_target_clear_depth(hn_target *target, int write_depth);
/* Reads the colour of a target, or of the first of joined ones: width * height * 4 values, bottom row first; alpha is
 * 1 without an alpha channel. The bytes are clamped to 0...1 and rounded by GL; the floats are as drawn. */
int hn_target_read_bytes(hn_target *target, uint8_t *rgba);
int hn_target_read_floats(hn_target *target, float *rgba);

/* ---- Draws (draw.c) ------------------------------------------------------------------------------------ */

/* What an attribute location reads. */
typedef struct {
    uint32_t buffer; /* 0: the vertices of the mesh, from the first of each of its parts */
    uint32_t type;   /* GL_FLOAT, GL_INT or GL_BYTE; integers become floats */
    int32_t components, stride;
    uint64_t offset;
    uint32_t divisor; /* 1: one value an instance */
} hn_attribute;

/* One side of the stencil test. */
typedef struct {
    uint32_t function, fail, depth_fail, pass; /* GL_EQUAL, ...; GL_KEEP, ... */
} hn_stencil;

/* What a draw does with the faces and the fragments that it meets; everything by GL's names. */
typedef struct {
    uint32_t fill;       /* GL_FILL or GL_LINE */
    uint32_t cull;       /* GL_NONE, GL_BACK or GL_FRONT: the faces that are left out */
    uint32_t front;      /* GL_CCW or GL_CW: how a front face's vertices go round */
    int32_t depth_clamp; /* 1: what lies before the near or beyond the far plane is drawn too */
    int32_t depth_test, depth_write;
    uint32_t depth_function;
    int32_t blend;
    uint32_t blend_functions[2]; /* of colour and of alpha */
    uint32_t blend_factors[4];   /* source and destination of colour, source and destination of alpha */
    float blend_color[4];
    int32_t stencil_test;
    int32_t stencil_reference;
    uint32_t stencil_read_mask, stencil_write_mask;
    hn_stencil stencil_front, stencil_back;
} hn_state;

typedef struct {
    uint32_t program;
    const hn_mesh *mesh; /* NULL: n_vertices vertices, all of buffers */
    int32_t n_vertices;
    uint32_t topology; /* GL_TRIANGLES, ... */
    const hn_attribute *attributes;
    int32_t n_attributes;
    int32_t instanced, instances; /* an instanced draw may have no instances */
    int32_t patch_vertices;       /* of GL_PATCHES */
    const hn_state
        *state; /* NULL: the state at the start of a pass of SHADERed's: back faces culled, depth LESS */
} hn_call;

/* Draws. GL's own refusals (a geometry stage that wants other primitives, say) fail with GL's error. */
int hn_draw(hn_target *target, const hn_call *call);

/* ---- Window (window.c) --------------------------------------------------------------------------------- */

/* Of the context of the glfw backend alone: with another, or without a context, all of these fail. */

typedef enum {
    HN_EVENT_KEY, /* `code` is GLFW's key, of the keyboard's US layout; `action` 0 up, 1 down, 2 repeated */
    HN_EVENT_BUTTON, /* `code` is GLFW's mouse button; `action` 0 up, 1 down; where the pointer is */
    HN_EVENT_MOVE,   /* the pointer is at x, y: pixels from the window's left and top */
    HN_EVENT_WHEEL,  /* turned by y notches, positive away from the user */
    HN_EVENT_SIZE,   /* the window is x by y pixels now */
    HN_EVENT_CLOSE   /* the user wants it closed */
} hn_event_kind;

typedef struct {
    int32_t kind, code, action;
    double x, y;
} hn_event;

/* Makes the context's window visible, with that many pixels inside. */
int hn_window_show(const char *title, int width, int height);
/* The text of its title bar, UTF-8. */
int hn_window_title(const char *title);
/* The events since the last call, in order; waits up to `seconds` for one. Fills `out` with at most `capacity` and
 * returns how many; what does not fit comes with the next call. -1 on failure. */
int hn_window_events(hn_event *out, int capacity, double seconds);
/* Draws the colour of a target over the whole window, clamped to 0...1; seen after hn_window_swap(). */
int hn_window_present(hn_target *target);
/* The same of width * height * 4 bytes, bottom row first. */
int hn_window_present_bytes(int width, int height, const uint8_t *rgba);
/* Reads what was presented and not yet swapped; the window's size, and unless it is NULL `rgba` with
 * width * height * 4 bytes, bottom row first. Alpha is 255. `rgba` has room for `capacity` bytes. */
int hn_window_read(int *width, int *height, uint8_t *rgba, size_t capacity);
int hn_window_swap(void);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif
#if defined(__cplusplus)
}
#endif
#endif
