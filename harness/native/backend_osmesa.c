/* backend_osmesa.c: a context of Mesa's software renderer, by OSMesa. */
#include "backend.h"

#include <GL/osmesa.h>

static struct {
    OSMesaContext (*create)(const int *attributes, OSMesaContext shared);
    GLboolean (*make_current)(OSMesaContext context, void *buffer, GLenum type, GLsizei width,
                              GLsizei height);
    OSMesaContext (*current)(void);
    void (*destroy)(OSMesaContext context);
    OSMESAproc (*get)(const char *name);
} osmesa;
static const hn_symbol symbols[] = {
    {"OSMesaCreateContextAttribs", &osmesa.create}, {"OSMesaMakeCurrent", &osmesa.make_current},
    {"OSMesaGetCurrentContext", &osmesa.current},   {"OSMesaDestroyContext", &osmesa.destroy},
    {"OSMesaGetProcAddress", &osmesa.get},          {NULL, NULL}};
static void *library;
static OSMesaContext context;
/* OSMesa wants a window to draw to; all our drawing goes to framebuffer objects. */
static uint32_t window[1];

static int open_osmesa(void) {
    if (hn_library_open(&library, "libOSMesa.so.8", "libosmesa6", symbols))
        return -1;
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context = osmesa.create(attributes, NULL);
    if (!context)
        return hn_fail("hn_context_open: OSMesa makes no OpenGL 3.3 core context");
    if (!osmesa.make_current(context, window, GL_UNSIGNED_BYTE, 1, 1))
        return hn_fail("hn_context_open: OSMesa cannot make its context current");
    return 0;
}

static void close_osmesa(void) {
    if (!context)
        return;
    osmesa.make_current(NULL, NULL, GL_UNSIGNED_BYTE, 0, 0);
    osmesa.destroy(context);
    context = NULL;
}

static int is_current(void) {
    return osmesa.current() == context;
}

static hn_gl_function get(const char *name) {
    return osmesa.get(name);
}

const hn_backend hn_backend_osmesa = {"osmesa", open_osmesa, close_osmesa, is_current, get};
