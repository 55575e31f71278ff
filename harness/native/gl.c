/* gl.c: loads the table of OpenGL functions, and turns GL's error flag into messages. */
#include "internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

hn_gl gl;

/* ISO C knows no cast between function pointers that it does not warn about; the bytes are the same. */
#define HN_GL_GET(type, name)   \
    function = get("gl" #name); \
    memcpy(&gl.name, &function, sizeof function);
#define HN_GL_REQUIRE(type, name) \
    HN_GL_GET(type, name)         \
    if (!function)                \
        missing = "gl" #name;

int hn_gl_load(hn_gl_function (*get)(const char *name)) {
    hn_gl_function function;
    const char *missing = NULL;
    HN_GL_33(HN_GL_REQUIRE)
    if (missing) {
        hn_gl_unload();
        return hn_fail("hn_context_open: the driver lacks %s", missing);
    }
    GLint major = 0, minor = 0;
    gl.GetIntegerv(GL_MAJOR_VERSION, &major);
    gl.GetIntegerv(GL_MINOR_VERSION, &minor);
    if (major * 10 + minor < 33) {
        hn_gl_unload();
        return hn_fail("hn_context_open: OpenGL %d.%d, but 3.3 is needed", major, minor);
    }
    /* By version, not by what `get` finds: it answers for any name. */
    if (major * 10 + minor >= 43) {
        HN_GL_43(HN_GL_GET)
    }
    return 0;
}

void hn_gl_unload(void) {
    memset(&gl, 0, sizeof gl);
}

int hn_gl_has(const char *extension) {
    GLint count = 0;
    gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        const GLubyte *name = gl.GetStringi(GL_EXTENSIONS, (GLuint)i);
        if (name && strcmp((const char *)name, extension) == 0)
            return 1;
    }
    return 0;
}

static const char *error_name(GLenum error) {
    switch (error) {
    case GL_INVALID_ENUM:
        return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
        return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
        return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
        return "GL_OUT_OF_MEMORY";
    default:
        return "unknown GL error";
    }
}

/* GL keeps at most one flag of each kind, so more than a few come only from a context that is gone. */
enum { ERRORS_MAX = 8 };

int hn_check_gl(const char *operation, ...) {
    GLenum errors[ERRORS_MAX];
    int n_errors = 0;
    while (n_errors < ERRORS_MAX && (errors[n_errors] = gl.GetError()) != GL_NO_ERROR)
        ++n_errors;
    if (n_errors == 0)
        return 0;

    char where[512];
    va_list arguments;
    va_start(arguments, operation);
    vsnprintf(where, sizeof where, operation, arguments);
    va_end(arguments);
    hn_fail("%s: %s", where, error_name(errors[0]));
    for (int i = 1; i < n_errors; ++i)
        hn_fail("%s, %s", hn_error(), error_name(errors[i]));
    return -1;
}
