/* main.c: harness_isa [VERTEX.spv FRAGMENT.spv]...
 *
 * One line of JSON for each pair, in order (isa.h). Exit code 1, and a line on stderr, when there is no device or one
 * of the shaders is refused; without a pair it tells only whether there is a device.
 */
#include "isa.h"

#include <stdarg.h>
#include <stdlib.h>

int isa_fail(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    return -1;
}

static int read_words(const char *path, FILE *file, isa_spirv *read) {
    if (fseek(file, 0, SEEK_END))
        return isa_fail("%s: cannot be read", path);
    long size = ftell(file);
    if (size < 20 || size % 4) /* SPIR-V begins with a header of five words */
        return isa_fail("%s: no SPIR-V", path);
    rewind(file);
    read->size = (size_t)size;
    read->words = malloc(read->size);
    if (!read->words)
        return isa_fail("%s: out of memory", path);
    if (fread(read->words, 1, read->size, file) != read->size)
        return isa_fail("%s: cannot be read", path);
    return 0;
}

static int read_spirv(const char *path, isa_spirv *read) {
    *read = (isa_spirv){0};
    FILE *file = fopen(path, "rb");
    if (!file)
        return isa_fail("%s: cannot be opened", path);
    int result = read_words(path, file, read);
    fclose(file);
    return result;
}

static int report(const isa_device *device, const char *vertex_path, const char *fragment_path) {
    isa_spirv vertex, fragment = {0};
    int result = read_spirv(vertex_path, &vertex);
    if (!result)
        result = read_spirv(fragment_path, &fragment);
    if (!result)
        result = isa_report(device, &vertex, &fragment, stdout);
    free(vertex.words);
    free(fragment.words);
    return result;
}

int main(int argc, char **argv) {
    if (argc % 2 == 0) {
        fprintf(stderr, "usage: %s [VERTEX.spv FRAGMENT.spv]...\n", argv[0]);
        return 2;
    }
    isa_device device = {0};
    int result = isa_open(&device);
    for (int k = 1; !result && k < argc; k += 2)
        result = report(&device, argv[k], argv[k + 1]);
    isa_close(&device);
    return result ? 1 : 0;
}
