/* window.c: the window of the glfw backend as something to look at: shown, titled, drawn over; and its events. */
#include "backend.h"

#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static struct {
    void (*show)(GLFWwindow *window);
    void (*title)(GLFWwindow *window, const char *title);
    void (*set_size)(GLFWwindow *window, int width, int height);
    void (*size)(GLFWwindow *window, int *width, int *height);
    void (*swap)(GLFWwindow *window);
    void (*swap_interval)(int interval);
    void (*poll)(void);
    void (*wait)(double seconds);
    void (*pointer)(GLFWwindow *window, double *x, double *y);
    GLFWkeyfun (*on_key)(GLFWwindow *window, GLFWkeyfun callback);
    GLFWmousebuttonfun (*on_button)(GLFWwindow *window, GLFWmousebuttonfun callback);
    GLFWcursorposfun (*on_move)(GLFWwindow *window, GLFWcursorposfun callback);
    GLFWscrollfun (*on_wheel)(GLFWwindow *window, GLFWscrollfun callback);
    GLFWframebuffersizefun (*on_size)(GLFWwindow *window, GLFWframebuffersizefun callback);
    GLFWwindowclosefun (*on_close)(GLFWwindow *window, GLFWwindowclosefun callback);
} glfw;
static const hn_symbol symbols[] = {{"glfwShowWindow", &glfw.show},
                                    {"glfwSetWindowTitle", &glfw.title},
                                    {"glfwSetWindowSize", &glfw.set_size},
                                    {"glfwGetFramebufferSize", &glfw.size},
                                    {"glfwSwapBuffers", &glfw.swap},
                                    {"glfwSwapInterval", &glfw.swap_interval},
                                    {"glfwPollEvents", &glfw.poll},
                                    {"glfwWaitEventsTimeout", &glfw.wait},
                                    {"glfwGetCursorPos", &glfw.pointer},
                                    {"glfwSetKeyCallback", &glfw.on_key},
                                    {"glfwSetMouseButtonCallback", &glfw.on_button},
                                    {"glfwSetCursorPosCallback", &glfw.on_move},
                                    {"glfwSetScrollCallback", &glfw.on_wheel},
                                    {"glfwSetFramebufferSizeCallback", &glfw.on_size},
                                    {"glfwSetWindowCloseCallback", &glfw.on_close},
                                    {NULL, NULL}};
static void *library;

enum { QUEUE_MAX = 1024 };
static hn_event queue[QUEUE_MAX];
static int n_queued;
static int pointer_known;
static double pointer_x, pointer_y; /* after the last event of it */
static int seen_width, seen_height; /* of the window, when it was last drawn to */

/* A pointer's way and a window's growth are told by where they end. A full queue drops what comes: nobody types so fast. */
static void add(hn_event event) {
    int joins = event.kind == HN_EVENT_MOVE || event.kind == HN_EVENT_SIZE;
    if (joins && n_queued > 0 && queue[n_queued - 1].kind == event.kind)
        queue[n_queued - 1] = event;
    else if (n_queued < QUEUE_MAX)
        queue[n_queued++] = event;
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int modifiers) {
    (void)window, (void)scancode, (void)modifiers;
    add((hn_event){.kind = HN_EVENT_KEY, .code = key, .action = action});
}

static void on_button(GLFWwindow *window, int button, int action, int modifiers) {
    (void)modifiers;
    /* Asked now, GLFW says where the pointer is now; it may have moved on since the button went down. */
    if (!pointer_known)
        glfw.pointer(window, &pointer_x, &pointer_y);
    add((hn_event){
        .kind = HN_EVENT_BUTTON, .code = button, .action = action, .x = pointer_x, .y = pointer_y});
}

static void on_move(GLFWwindow *window, double x, double y) {
    (void)window;
    pointer_known = 1;
    pointer_x = x;
    pointer_y = y;
    add((hn_event){.kind = HN_EVENT_MOVE, .x = x, .y = y});
}

static void on_wheel(GLFWwindow *window, double x, double y) {
    (void)window;
    add((hn_event){.kind = HN_EVENT_WHEEL, .x = x, .y = y});
}

static void on_size(GLFWwindow *window, int width, int height) {
    (void)window;
    add((hn_event){.kind = HN_EVENT_SIZE, .x = width, .y = height});
}

static void on_close(GLFWwindow *window) {
    (void)window;
    add((hn_event){.kind = HN_EVENT_CLOSE});
}

/* The window of the open context, or NULL with the reason in hn_error(). */
static GLFWwindow *opened(const char *operation) {
    if (hn_context_check(operation))
        return NULL;
    GLFWwindow *window = hn_glfw_window();
    if (!window) {
        hn_fail("%s: only the backend glfw has a window", operation);
        return NULL;
    }
    return hn_library_open(&library, "libglfw.so.3", "libglfw3", symbols) ? NULL : window;
}

int hn_window_show(const char *title, int width, int height) {
    const char *operation = "hn_window_show";
    GLFWwindow *window = opened(operation);
    if (!window)
        return -1;
    if (!title)
        return hn_fail("%s: no title", operation);
    if (hn_image_check(operation, width, height, 4))
        return -1;
    n_queued = pointer_known = 0;
    seen_width = seen_height = 0;
    glfw.on_key(window, on_key);
    glfw.on_button(window, on_button);
    glfw.on_move(window, on_move);
    glfw.on_wheel(window, on_wheel);
    glfw.on_size(window, on_size);
    glfw.on_close(window, on_close);
    glfw.title(window, title);
    glfw.set_size(window, width, height);
    glfw.show(window);
    glfw.swap_interval(1);
    glfw.poll();
    return hn_check_gl("%s: %d x %d", operation, width, height);
}

int hn_window_title(const char *title) {
    GLFWwindow *window = opened("hn_window_title");
    if (!window)
        return -1;
    if (!title)
        return hn_fail("hn_window_title: no title");
    glfw.title(window, title);
    return 0;
}

int hn_window_events(hn_event *out, int capacity, double seconds) {
    const char *operation = "hn_window_events";
    if (!opened(operation))
        return -1;
    if (!out || capacity < 1)
        return hn_fail("%s: nowhere to put the events", operation);
    if (n_queued == 0 && seconds > 0)
        glfw.wait(seconds);
    else
        glfw.poll();
    int n = n_queued < capacity ? n_queued : capacity;
    memcpy(out, queue, (size_t)n * sizeof *queue);
    n_queued -= n;
    memmove(queue, queue + n, (size_t)n_queued * sizeof *queue);
    return n;
}

/* Mesa looks at a window's size when it swaps: what is drawn between a change of size and that goes partly nowhere. */
static void follow_size(GLFWwindow *window, int width, int height) {
    if (width == seen_width && height == seen_height)
        return;
    const float black[4] = {0, 0, 0, 1};
    gl.ClearBufferfv(GL_COLOR, 0, black);
    glfw.swap(window);
    seen_width = width;
    seen_height = height;
}

/* The first colour of a framebuffer over the whole of what is behind the window. */
static int blit(const char *operation, GLFWwindow *window, uint32_t framebuffer, int width, int height) {
    int shown_width = 0, shown_height = 0;
    glfw.size(window, &shown_width, &shown_height);
    hn_write_everything();
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    follow_size(window, shown_width, shown_height);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    GLenum filter = shown_width == width && shown_height == height ? GL_NEAREST : GL_LINEAR;
    gl.BlitFramebuffer(0, 0, width, height, 0, 0, shown_width, shown_height, GL_COLOR_BUFFER_BIT, filter);
    return hn_check_gl("%s: %d x %d", operation, width, height);
}

int hn_window_present(hn_target *target) {
    const char *operation = "hn_window_present";
    GLFWwindow *window = opened(operation);
    if (!window || hn_target_use(operation, target))
        return -1;
    int width, height;
    hn_target_size(target, &width, &height);
    GLint framebuffer = 0;
    gl.GetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &framebuffer);
    return blit(operation, window, (uint32_t)framebuffer, width, height);
}

int hn_window_present_bytes(int width, int height, const uint8_t *rgba) {
    const char *operation = "hn_window_present_bytes";
    GLFWwindow *window = opened(operation);
    if (!window || hn_image_check(operation, width, height, 4))
        return -1;
    if (!rgba)
        return hn_fail("%s: no pixels", operation);
    GLint bound = 0;
    GLuint texture, framebuffer;
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    gl.GenTextures(1, &texture);
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    gl.BindTexture(GL_TEXTURE_2D, (GLuint)bound);
    int result = blit(operation, window, framebuffer, width, height);
    gl.DeleteFramebuffers(1, &framebuffer);
    gl.DeleteTextures(1, &texture);
    return result;
}

int hn_window_read(int *width, int *height, uint8_t *rgba, size_t capacity) {
    const char *operation = "hn_window_read";
    GLFWwindow *window = opened(operation);
    if (!window)
        return -1;
    if (!width || !height)
        return hn_fail("%s: nowhere to put the size", operation);
    glfw.size(window, width, height);
    if (!rgba)
        return 0;
    size_t size = 4 * (size_t)*width * (size_t)*height;
    if (size > capacity)
        return hn_fail("%s: %d x %d pixels do not fit", operation, *width, *height);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.ReadBuffer(GL_BACK);
    gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, *width, *height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    for (size_t i = 3; i < size; i += 4)
        rgba[i] = 255;
    return hn_check_gl("%s: %d x %d", operation, *width, *height);
}

int hn_window_swap(void) {
    GLFWwindow *window = opened("hn_window_swap");
    if (!window)
        return -1;
    glfw.swap(window);
    return hn_check_gl("hn_window_swap");
}
