/* backend_egl.c: a context without a display, by EGL: on the first GPU that makes one, else by Mesa in software. */
#include "backend.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string.h>

static struct {
    void (*(*get)(const char *name))(void);
    EGLBoolean (*initialize)(EGLDisplay display, EGLint *major, EGLint *minor);
    EGLBoolean (*terminate)(EGLDisplay display);
    EGLBoolean (*bind_api)(EGLenum api);
    EGLBoolean (*choose)(EGLDisplay display, const EGLint *attributes, EGLConfig *configs, EGLint capacity,
                         EGLint *count);
    EGLContext (*create)(EGLDisplay display, EGLConfig config, EGLContext shared, const EGLint *attributes);
    EGLBoolean (*destroy)(EGLDisplay display, EGLContext context);
    EGLBoolean (*make_current)(EGLDisplay display, EGLSurface draw, EGLSurface read, EGLContext context);
    EGLContext (*current)(void);
    EGLBoolean (*release_thread)(void);
} egl;
static const hn_symbol symbols[] = {{"eglGetProcAddress", &egl.get},
                                    {"eglInitialize", &egl.initialize},
                                    {"eglTerminate", &egl.terminate},
                                    {"eglBindAPI", &egl.bind_api},
                                    {"eglChooseConfig", &egl.choose},
                                    {"eglCreateContext", &egl.create},
                                    {"eglDestroyContext", &egl.destroy},
                                    {"eglMakeCurrent", &egl.make_current},
                                    {"eglGetCurrentContext", &egl.current},
                                    {"eglReleaseThread", &egl.release_thread},
                                    {NULL, NULL}};
static void *library;
static EGLDisplay display;
static EGLContext context;

/* Our drawing goes to framebuffer objects: the context needs no surface (EGL_KHR_surfaceless_context). */
static int open_on(EGLDisplay candidate) {
    EGLint major = 0, minor = 0;
    if (candidate == EGL_NO_DISPLAY || !egl.initialize(candidate, &major, &minor))
        return -1;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                              3,
                              EGL_CONTEXT_MINOR_VERSION,
                              3,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                              EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    if (egl.choose(candidate, wanted, &config, 1, &count) && count > 0) {
        context = egl.create(candidate, config, EGL_NO_CONTEXT, version);
        if (context != EGL_NO_CONTEXT &&
            egl.make_current(candidate, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
            display = candidate;
            return 0;
        }
        if (context != EGL_NO_CONTEXT)
            egl.destroy(candidate, context);
        context = EGL_NO_CONTEXT;
    }
    egl.terminate(candidate);
    return -1;
}

enum { DEVICES_MAX = 16 };

static int open_egl(void) {
    if (hn_library_open(&library, "libEGL.so.1", "libegl1", symbols))
        return -1;
    if (!egl.bind_api(EGL_OPENGL_API))
        return hn_fail("hn_context_open: this EGL has no OpenGL");
    void (*found)(void) = egl.get("eglGetPlatformDisplayEXT");
    PFNEGLGETPLATFORMDISPLAYEXTPROC platform_display;
    memcpy(&platform_display, &found, sizeof found);
    found = egl.get("eglQueryDevicesEXT");
    PFNEGLQUERYDEVICESEXTPROC query_devices;
    memcpy(&query_devices, &found, sizeof found);
    found = egl.get("eglQueryDeviceStringEXT");
    PFNEGLQUERYDEVICESTRINGEXTPROC device_string;
    memcpy(&device_string, &found, sizeof found);
    if (!platform_display)
        return hn_fail("hn_context_open: this EGL opens no display without a window system");

    EGLDeviceEXT devices[DEVICES_MAX];
    EGLint n_devices = 0;
    if (!query_devices || !device_string || !query_devices(DEVICES_MAX, devices, &n_devices))
        n_devices = 0;
    for (int software = 0; software <= 1; ++software) /* real devices first */
        for (EGLint k = 0; k < n_devices; ++k) {
            const char *extensions = device_string(devices[k], EGL_EXTENSIONS);
            int is_software = extensions && strstr(extensions, "EGL_MESA_device_software");
            if (is_software == software &&
                open_on(platform_display(EGL_PLATFORM_DEVICE_EXT, devices[k], NULL)) == 0)
                return 0;
        }
    if (open_on(platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL)) == 0)
        return 0;
    return hn_fail(
        "hn_context_open: no device of EGL makes an OpenGL 3.3 core context; for one in software, on "
        "Debian: apt-get install libgl1-mesa-dri");
}

static void close_egl(void) {
    if (context == EGL_NO_CONTEXT)
        return;
    egl.make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl.destroy(display, context);
    egl.terminate(display);
    egl.release_thread();
    context = EGL_NO_CONTEXT;
    display = EGL_NO_DISPLAY;
}

static int is_current(void) {
    return egl.current() == context;
}

static hn_gl_function get(const char *name) {
    return egl.get(name);
}

const hn_backend hn_backend_egl = {"egl", open_egl, close_egl, is_current, get};
