/* backend.c: loads the library that a backend lives on. */
#include "backend.h"

#include <dlfcn.h>
#include <string.h>

int hn_library_open(void **library, const char *file, const char *package, const hn_symbol *symbols) {
    if (*library)
        return 0;
    void *opened = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (!opened)
        return hn_fail("hn_context_open: %s was not found; on Debian: apt-get install %s", file, package);
    for (const hn_symbol *symbol = symbols; symbol->name; ++symbol) {
        void *found = dlsym(opened, symbol->name);
        if (!found) {
            dlclose(opened);
            return hn_fail("hn_context_open: %s lacks %s", file, symbol->name);
        }
        memcpy(symbol->function, &found, sizeof found);
    }
    *library = opened; /* for good: drivers do not like to be unloaded */
    return 0;
}
