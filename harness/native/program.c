/* program.c: compiles and links programs with the driver, lists what they take, and sets their uniforms. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

/* The log of a shader or a program, whichever the two functions are for; NULL without memory. */
static char *read_log(GLuint object, PFNGLGETSHADERIVPROC get, PFNGLGETSHADERINFOLOGPROC get_log) {
    GLint size = 0;
    get(object, GL_INFO_LOG_LENGTH, &size);
    char *log = calloc((size_t)size + 1, 1);
    if (log && size > 0)
        get_log(object, size, NULL, log);
    return log;
}

static int fail_with_log(const char *step, char *log) {
    hn_fail("%s: %s", step, log ? log : "(no memory for the log)");
    free(log);
    return -1;
}

static int attach(GLuint program, GLenum stage, const char *name, const char *text) {
    GLuint shader = gl.CreateShader(stage);
    gl.ShaderSource(shader, 1, &text, NULL);
    gl.CompileShader(shader);
    GLint compiled = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    int result = 0;
    if (compiled)
        gl.AttachShader(program, shader);
    else
        result = fail_with_log(name, read_log(shader, gl.GetShaderiv, gl.GetShaderInfoLog));
    /* GL keeps it for as long as it is attached. */
    gl.DeleteShader(shader);
    return result;
}

static int link_program(GLuint program) {
    gl.LinkProgram(program);
    GLint linked = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked)
        return fail_with_log("link", read_log(program, gl.GetProgramiv, gl.GetProgramInfoLog));
    return 0;
}

static const struct {
    GLenum type;
    const char *name;
} stages[HN_STAGES] = {
    [HN_VERTEX] = {GL_VERTEX_SHADER, "vertex"},
    [HN_FRAGMENT] = {GL_FRAGMENT_SHADER, "fragment"},
    [HN_GEOMETRY] = {GL_GEOMETRY_SHADER, "geometry"},
    [HN_TESS_CONTROL] = {GL_TESS_CONTROL_SHADER, "tess_control"},
    [HN_TESS_EVALUATION] = {GL_TESS_EVALUATION_SHADER, "tess_evaluation"},
    [HN_COMPUTE] = {GL_COMPUTE_SHADER, "compute"},
};

static uint32_t create(const char *operation, const char *const texts[HN_STAGES]) {
    GLuint program = gl.CreateProgram();
    int failed = 0;
    for (int stage = 0; !failed && stage < HN_STAGES; ++stage)
        if (texts[stage])
            failed = attach(program, stages[stage].type, stages[stage].name, texts[stage]);
    if (failed || link_program(program) || hn_check_gl("%s", operation)) {
        gl.DeleteProgram(program);
        return 0;
    }
    return program;
}

uint32_t hn_program_create(const char *vertex, const char *fragment) {
    const char *operation = "hn_program_create";
    if (hn_context_check(operation))
        return 0;
    if (!vertex || !fragment) {
        hn_fail("%s: no %s text", operation, vertex ? "fragment" : "vertex");
        return 0;
    }
    const char *texts[HN_STAGES] = {[HN_VERTEX] = vertex, [HN_FRAGMENT] = fragment};
    return create(operation, texts);
}

uint32_t hn_program_create_stages(const char *const texts[HN_STAGES]) {
    const char *operation = "hn_program_create_stages";
    if (hn_context_check(operation))
        return 0;
    if (!texts) {
        hn_fail("%s: no texts", operation);
        return 0;
    }
    /* Known here alone: GL 4.0 brought the one, 4.3 the other; we load what is newer than 3.3 together. */
    if ((texts[HN_TESS_CONTROL] || texts[HN_TESS_EVALUATION] || texts[HN_COMPUTE]) &&
        !hn_compute_available()) {
        hn_fail("%s: this context has no %s stages", operation,
                texts[HN_COMPUTE] ? "compute" : "tessellation");
        return 0;
    }
    return create(operation, texts);
}

uint32_t hn_program_create_compute(const char *compute) {
    const char *operation = "hn_program_create_compute";
    if (hn_context_check(operation))
        return 0;
    if (!compute || !hn_compute_available()) {
        hn_fail("%s: no %s", operation, compute ? "compute stage in this context" : "text");
        return 0;
    }
    const char *texts[HN_STAGES] = {[HN_COMPUTE] = compute};
    return create(operation, texts);
}

void hn_program_delete(uint32_t program) {
    if (program == 0 || hn_context_check("hn_program_delete"))
        return;
    gl.DeleteProgram(program);
    hn_check_gl("hn_program_delete: program %u", program);
}

typedef struct {
    const char *operation;
    GLenum count, longest; /* what to ask glGetProgramiv */
    PFNGLGETACTIVEUNIFORMPROC get;
    PFNGLGETUNIFORMLOCATIONPROC locate;
} listing;

static int list_variables(const listing *what, uint32_t program, hn_variable *out, int capacity) {
    GLint count = 0, longest = 0;
    gl.GetProgramiv(program, what->count, &count);
    gl.GetProgramiv(program, what->longest, &longest);
    if (hn_check_gl("%s: program %u", what->operation, program))
        return -1;
    /* `longest` counts the final NUL. A name cut short would be another variable's name. */
    if ((size_t)longest > sizeof out->name)
        return hn_fail("%s: program %u has a name of %d characters; at most %zu can be given",
                       what->operation, program, longest - 1, sizeof out->name - 1);
    for (GLint i = 0; i < count && i < capacity; ++i) {
        memset(&out[i], 0, sizeof out[i]);
        what->get(program, (GLuint)i, (GLsizei)sizeof out[i].name, NULL, &out[i].size, &out[i].type,
                  out[i].name);
        out[i].location = what->locate(program, out[i].name);
    }
    return hn_check_gl("%s: program %u", what->operation, program) ? -1 : count;
}

int hn_program_uniforms(uint32_t program, hn_variable *out, int capacity) {
    const char *operation = "hn_program_uniforms";
    if (hn_context_check(operation))
        return -1;
    const listing uniforms = {operation, GL_ACTIVE_UNIFORMS, GL_ACTIVE_UNIFORM_MAX_LENGTH,
                              gl.GetActiveUniform, gl.GetUniformLocation};
    return list_variables(&uniforms, program, out, out ? capacity : 0);
}

int hn_program_attributes(uint32_t program, hn_variable *out, int capacity) {
    const char *operation = "hn_program_attributes";
    if (hn_context_check(operation))
        return -1;
    const listing attributes = {operation, GL_ACTIVE_ATTRIBUTES, GL_ACTIVE_ATTRIBUTE_MAX_LENGTH,
                                gl.GetActiveAttrib, gl.GetAttribLocation};
    return list_variables(&attributes, program, out, out ? capacity : 0);
}

static int is_sampler(uint32_t type) {
    switch (type) {
    case GL_SAMPLER_1D:
    case GL_SAMPLER_2D:
    case GL_SAMPLER_3D:
    case GL_SAMPLER_CUBE:
    case GL_SAMPLER_1D_SHADOW:
    case GL_SAMPLER_2D_SHADOW:
    case GL_SAMPLER_2D_RECT:
    case GL_SAMPLER_2D_RECT_SHADOW:
    case GL_SAMPLER_1D_ARRAY:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_BUFFER:
    case GL_SAMPLER_1D_ARRAY_SHADOW:
    case GL_SAMPLER_2D_ARRAY_SHADOW:
    case GL_SAMPLER_CUBE_SHADOW:
    case GL_SAMPLER_2D_MULTISAMPLE:
    case GL_INT_SAMPLER_2D:
    case GL_INT_SAMPLER_3D:
    case GL_INT_SAMPLER_CUBE:
    case GL_INT_SAMPLER_2D_ARRAY:
    case GL_INT_SAMPLER_BUFFER:
    case GL_UNSIGNED_INT_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_3D:
    case GL_UNSIGNED_INT_SAMPLER_CUBE:
    case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_BUFFER:
        return 1;
    default:
        return 0;
    }
}

/* Sets the uniform of the program in use; 0 when there is no such type. */
static int set_uniform(uint32_t type, GLint location, GLsizei count, const void *data) {
#define HN_VECTOR(gl_type, suffix)                 \
    case gl_type:                                  \
        gl.Uniform##suffix(location, count, data); \
        return 1;
#define HN_MATRIX(gl_type, suffix)                                 \
    case gl_type:                                                  \
        gl.UniformMatrix##suffix(location, count, GL_FALSE, data); \
        return 1;
    switch (is_sampler(type) ? GL_INT : type) {
        HN_VECTOR(GL_FLOAT, 1fv)
        HN_VECTOR(GL_FLOAT_VEC2, 2fv)
        HN_VECTOR(GL_FLOAT_VEC3, 3fv)
        HN_VECTOR(GL_FLOAT_VEC4, 4fv)
        HN_VECTOR(GL_INT, 1iv)
        HN_VECTOR(GL_INT_VEC2, 2iv)
        HN_VECTOR(GL_INT_VEC3, 3iv)
        HN_VECTOR(GL_INT_VEC4, 4iv)
        HN_VECTOR(GL_UNSIGNED_INT, 1uiv)
        HN_VECTOR(GL_UNSIGNED_INT_VEC2, 2uiv)
        HN_VECTOR(GL_UNSIGNED_INT_VEC3, 3uiv)
        HN_VECTOR(GL_UNSIGNED_INT_VEC4, 4uiv)
        HN_VECTOR(GL_BOOL, 1iv)
        HN_VECTOR(GL_BOOL_VEC2, 2iv)
        HN_VECTOR(GL_BOOL_VEC3, 3iv)
        HN_VECTOR(GL_BOOL_VEC4, 4iv)
        HN_MATRIX(GL_FLOAT_MAT2, 2fv)
        HN_MATRIX(GL_FLOAT_MAT3, 3fv)
        HN_MATRIX(GL_FLOAT_MAT4, 4fv)
        HN_MATRIX(GL_FLOAT_MAT2x3, 2x3fv)
        HN_MATRIX(GL_FLOAT_MAT2x4, 2x4fv)
        HN_MATRIX(GL_FLOAT_MAT3x2, 3x2fv)
        HN_MATRIX(GL_FLOAT_MAT3x4, 3x4fv)
        HN_MATRIX(GL_FLOAT_MAT4x2, 4x2fv)
        HN_MATRIX(GL_FLOAT_MAT4x3, 4x3fv)
    default:
        return 0;
    }
#undef HN_VECTOR
#undef HN_MATRIX
}

int hn_program_uniform(uint32_t program, int32_t location, uint32_t type, int32_t count, const void *data) {
    const char *operation = "hn_program_uniform";
    if (hn_context_check(operation))
        return -1;
    if (count < 1 || !data)
        return hn_fail("%s: no data for location %d of program %u", operation, location, program);
    /* GL would ignore it without a word, and the caller would believe it set. */
    if (location < 0)
        return hn_fail("%s: program %u has no uniform at location %d", operation, program, location);
    gl.UseProgram(program);
    if (hn_check_gl("%s: program %u", operation, program))
        return -1;
    if (!set_uniform(type, location, count, data))
        return hn_fail("%s: type 0x%04X is none a uniform can be set by", operation, type);
    return hn_check_gl("%s: program %u, location %d, type 0x%04X, count %d", operation, program, location,
                       type, count);
}

int hn_program_uniform_read(uint32_t program, int32_t location, uint32_t type, int components, void *data) {
    const char *operation = "hn_program_uniform_read";
    if (hn_context_check(operation))
        return -1;
    enum { MOST = 16 }; /* GL writes a whole value, and asks nobody how much there is room for */
    if (location < 0 || components < 1 || components > MOST)
        return hn_fail("%s: location %d, %d components", operation, location, components);
    GLfloat floats[MOST] = {0};
    GLint integers[MOST] = {0};
    GLuint unsigneds[MOST] = {0};
    switch (type) {
    case GL_FLOAT:
    case GL_FLOAT_VEC2:
    case GL_FLOAT_VEC3:
    case GL_FLOAT_VEC4:
    case GL_FLOAT_MAT2:
    case GL_FLOAT_MAT3:
    case GL_FLOAT_MAT4:
    case GL_FLOAT_MAT2x3:
    case GL_FLOAT_MAT2x4:
    case GL_FLOAT_MAT3x2:
    case GL_FLOAT_MAT3x4:
    case GL_FLOAT_MAT4x2:
    case GL_FLOAT_MAT4x3:
        gl.GetUniformfv(program, location, floats);
        memcpy(data, floats, (size_t)components * sizeof *floats);
        break;
    case GL_UNSIGNED_INT:
    case GL_UNSIGNED_INT_VEC2:
    case GL_UNSIGNED_INT_VEC3:
    case GL_UNSIGNED_INT_VEC4:
        gl.GetUniformuiv(program, location, unsigneds);
        memcpy(data, unsigneds, (size_t)components * sizeof *unsigneds);
        break;
    default:
        gl.GetUniformiv(program, location, integers);
        memcpy(data, integers, (size_t)components * sizeof *integers);
    }
    return hn_check_gl("%s: program %u, location %d", operation, program, location);
}
