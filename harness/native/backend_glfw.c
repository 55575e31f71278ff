/* backend_glfw.c: the context of a window, by GLFW: the desktop's own driver. Hidden until window.c shows it. */
#include "backend.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static struct {
    int (*init)(void);
    void (*terminate)(void);
    int (*error)(const char **description);
    void (*hint)(int hint, int value);
    GLFWwindow *(*create)(int width, int height, const char *title, GLFWmonitor *monitor, GLFWwindow *shared);
    void (*destroy)(GLFWwindow *window);
    void (*make_current)(GLFWwindow *window);
    GLFWwindow *(*current)(void);
    GLFWglproc (*get)(const char *name);
} glfw;
static const hn_symbol symbols[] = {{"glfwInit", &glfw.init},
                                    {"glfwTerminate", &glfw.terminate},
                                    {"glfwGetError", &glfw.error},
                                    {"glfwWindowHint", &glfw.hint},
                                    {"glfwCreateWindow", &glfw.create},
                                    {"glfwDestroyWindow", &glfw.destroy},
                                    {"glfwMakeContextCurrent", &glfw.make_current},
                                    {"glfwGetCurrentContext", &glfw.current},
                                    {"glfwGetProcAddress", &glfw.get},
                                    {NULL, NULL}};
static void *library;
static int initialised;
static GLFWwindow *window;

static const char *reason(void) {
    const char *description = NULL;
    glfw.error(&description);
    return description ? description : "it does not say why";
}

static int open_glfw(void) {
    if (hn_library_open(&library, "libglfw.so.3", "libglfw3", symbols))
        return -1;
    if (!glfw.init())
        return hn_fail("hn_context_open: GLFW finds no display: %s", reason());
    initialised = 1;
    glfw.hint(GLFW_VISIBLE, GLFW_FALSE);
    glfw.hint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfw.hint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfw.hint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfw.hint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window = glfw.create(16, 16, "harness", NULL, NULL);
    if (!window)
        return hn_fail("hn_context_open: GLFW makes no OpenGL 3.3 core context: %s", reason());
    glfw.make_current(window);
    return 0;
}

static void close_glfw(void) {
    if (window)
        glfw.destroy(window);
    window = NULL;
    if (initialised)
        glfw.terminate();
    initialised = 0;
}

void *hn_glfw_window(void) {
    return window;
}

static int is_current(void) {
    return glfw.current() == window;
}

static hn_gl_function get(const char *name) {
    return glfw.get(name);
}

const hn_backend hn_backend_glfw = {"glfw", open_glfw, close_glfw, is_current, get};
