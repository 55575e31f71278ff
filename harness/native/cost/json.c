/* json.c: strings of JSON. */
#include "isa.h"

void isa_print_string(FILE *out, const char *text, size_t length) {
    fputc('"', out);
    for (size_t k = 0; k < length; ++k) {
        unsigned char c = (unsigned char)text[k];
        if (c == '"' || c == '\\')
            fprintf(out, "\\%c", c);
        else if (c < 0x20)
            fprintf(out, "\\u%04x", c);
        else
            fputc(c, out);
    }
    fputc('"', out);
}
