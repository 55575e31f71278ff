/* error.c: the message of the last failure, and memory that is handed to the caller. */
#include "internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* As long as it needs to be: drivers' logs are long, and their end matters as much as their beginning. */
static char *message;
static const char *current = "";

const char *hn_error(void) {
    return current;
}

void hn_free(void *memory) {
    free(memory);
}

int hn_fail(const char *format, ...) {
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);

    /* The old message is freed only after the new one is written: it may be an argument. */
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text)
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    free(message);
    message = text;
    current = text ? text : "out of memory while reporting a failure";
    return -1;
}
