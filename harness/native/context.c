/* context.c: the one OpenGL context of the process, whichever backend makes it. */
#include "backend.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const hn_backend *const backends[] = {&hn_backend_osmesa, &hn_backend_egl, &hn_backend_glfw};
enum { N_BACKENDS = sizeof backends / sizeof *backends };

static const hn_backend *chosen = &hn_backend_osmesa;
static int opened_once, is_open;
static uint32_t context_id, last_id;
static GLuint vertex_array;
static char *info;

int hn_context_choose(const char *backend) {
    for (int k = 0; k < N_BACKENDS; ++k)
        if (strcmp(backends[k]->name, backend) == 0) {
            if (opened_once && backends[k] != chosen)
                return hn_fail(
                    "hn_context_choose: this process has drawn with %s, and two libraries of OpenGL in "
                    "one process crash: use %s in a process of its own",
                    chosen->name, backend);
            chosen = backends[k];
            return 0;
        }
    return hn_fail("hn_context_choose: no backend %s; there are: osmesa, egl, glfw", backend);
}

static char *describe(void) {
    const char *format = "%s\n%s\n%s\n%s";
    const char *renderer = (const char *)gl.GetString(GL_RENDERER);
    const char *version = (const char *)gl.GetString(GL_VERSION);
    const char *glsl = (const char *)gl.GetString(GL_SHADING_LANGUAGE_VERSION);
    int length = snprintf(NULL, 0, format, renderer, version, glsl, chosen->name);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text)
        snprintf(text, (size_t)length + 1, format, renderer, version, glsl, chosen->name);
    return text;
}

int hn_context_open(void) {
    if (is_open)
        return hn_context_check("hn_context_open");

    is_open = 1;
    if (chosen->open()) {
        hn_context_close();
        return -1;
    }
    opened_once = 1;
    if (hn_gl_load(chosen->get)) {
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
    if (!is_open)
        return;
    chosen->close();
    is_open = 0;
    context_id = 0;
    vertex_array = 0;
    hn_gl_unload();
    free(info);
    info = NULL;
}

const char *hn_context_info(void) {
    return hn_context_check("hn_context_info") ? NULL : info;
}

int hn_context_integers(uint32_t name, int count, int32_t *values) {
    if (hn_context_check("hn_context_integers"))
        return -1;
    GLint found[4] = {0};
    if (count < 1 || count > 4)
        return hn_fail("hn_context_integers: %d numbers, not 1 to 4", count);
    gl.GetIntegerv(name, found);
    if (hn_check_gl("hn_context_integers: 0x%04x", name))
        return -1;
    for (int k = 0; k < count; ++k)
        values[k] = found[k];
    return 0;
}

int hn_context_precision(uint32_t stage, uint32_t type, int32_t range[2], int32_t *bits) {
    if (hn_context_check("hn_context_precision"))
        return -1;
    if (!gl.GetShaderPrecisionFormat)
        return hn_fail("hn_context_precision: the driver does not say it");
    gl.GetShaderPrecisionFormat(stage, type, range, bits);
    return hn_check_gl("hn_context_precision: 0x%04x of 0x%04x", type, stage);
}

int hn_context_take_error(void) {
    return is_open && chosen->is_current() ? hn_check_gl("GL") : 0;
}

int hn_context_check(const char *operation) {
    if (!is_open)
        return hn_fail("%s: no context: call hn_context_open() first", operation);
    if (!chosen->is_current())
        return hn_fail("%s: the context belongs to the thread that opened it", operation);
    return 0;
}

uint32_t hn_context_id(void) {
    return context_id;
}

uint32_t hn_context_vertex_array(void) {
    return vertex_array;
}
