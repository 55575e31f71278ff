/* backend.h: the three ways to an OpenGL context, behind one interface.
 *
 * Each loads its library when it opens, not when the program starts: two providers of GL in one process share state and
 * crash, and a machine need not have all three.
 */
#ifndef HARNESS_BACKEND_H
#define HARNESS_BACKEND_H

#include "internal.h"

typedef struct {
    const char *name;
    /* Makes a core context of GL 3.3 or later and makes it current. Returns -1 with the reason in hn_error(). */
    int (*open)(void);
    /* Undoes open(), or what of it was done. */
    void (*close)(void);
    /* Whether the calling thread has the context. */
    int (*is_current)(void);
    hn_gl_function (*get)(const char *name);
} hn_backend;

extern const hn_backend hn_backend_osmesa; /* Mesa's software renderer alone: no display, no GPU */
extern const hn_backend hn_backend_egl;    /* a GPU without a display; without one, a software renderer */
extern const hn_backend hn_backend_glfw;   /* a window of the desktop and its driver */

/* The GLFWwindow that the context of the glfw backend belongs to; NULL while that is not open. */
void *hn_glfw_window(void);

/* The functions of a shared library: `names` and where each goes, ended by NULL. Sets `*library`, or leaves it NULL and
 * returns -1 with a message that tells to install `package`. */
typedef struct {
    const char *name;
    void *function; /* the address of a function pointer */
} hn_symbol;
int hn_library_open(void **library, const char *file, const char *package, const hn_symbol *symbols);

#endif
