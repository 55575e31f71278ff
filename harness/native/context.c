/* context.c: the one OpenGL context of the process, by OSMesa: no display, no GPU, no window system. */
#include "internal.h"

#include <GL/osmesa.h>

#include <stdio.h>
#include <stdlib.h>

static OSMesaContext context;
static uint32_t context_id, last_id;
static GLuint vertex_array;
static char *info;
/* OSMesa wants a window to draw to; all our drawing goes to framebuffer objects. */
static uint32_t window[1];

static char *describe(void) {
    const char *format = "%s\n%s\n%s";
    const char *renderer = (const char *)gl.GetString(GL_RENDERER);
    const char *version = (const char *)gl.GetString(GL_VERSION);
    const char *glsl = (const char *)gl.GetString(GL_SHADING_LANGUAGE_VERSION);
    int length = snprintf(NULL, 0, format, renderer, version, glsl);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text)
        snprintf(text, (size_t)length + 1, format, renderer, version, glsl);
    return text;
}

int hn_context_open(void) {
    if (context)
        return hn_context_check("hn_context_open");

    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context = OSMesaCreateContextAttribs(attributes, NULL);
    if (!context)
        return hn_fail("hn_context_open: OSMesa makes no OpenGL 3.3 core context");
    if (!OSMesaMakeCurrent(context, window, GL_UNSIGNED_BYTE, 1, 1)) {
        hn_context_close();
        return hn_fail("hn_context_open: OSMesa cannot make its context current");
    }
    if (hn_gl_load(OSMesaGetProcAddress)) {
        hn_context_close();
        return -1;
    }
    info = describe();
    if (!info) {
        hn_context_close();
        return hn_fail("hn_context_open: out of memory");
    }
    gl.GenVertexArrays(1, &vertex_array);
    if (hn_check_gl("hn_context_open")) {
        hn_context_close();
        return -1;
    }
    context_id = ++last_id;
    return 0;
}

void hn_context_close(void) {
    if (!context)
        return;
    OSMesaMakeCurrent(NULL, NULL, GL_UNSIGNED_BYTE, 0, 0);
    OSMesaDestroyContext(context);
    context = NULL;
    context_id = 0;
    vertex_array = 0;
    hn_gl_unload();
    free(info);
    info = NULL;
}

const char *hn_context_info(void) {
    return hn_context_check("hn_context_info") ? NULL : info;
}

int hn_context_take_error(void) {
    return context && OSMesaGetCurrentContext() == context ? hn_check_gl("GL") : 0;
}

int hn_context_check(const char *operation) {
    if (!context)
        return hn_fail("%s: no context: call hn_context_open() first", operation);
    if (OSMesaGetCurrentContext() != context)
        return hn_fail("%s: the context belongs to the thread that opened it", operation);
    return 0;
}

uint32_t hn_context_id(void) {
    return context_id;
}

uint32_t hn_context_vertex_array(void) {
    return vertex_array;
}
