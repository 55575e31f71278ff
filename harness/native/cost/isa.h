/* isa.h: what the files of harness_isa share.
 *
 * harness_isa compiles fragment shaders with the Vulkan driver that the environment selects, and prints what the
 * driver says of the machine code. Nothing is drawn, and the driver may stand for a chip that is not there.
 */
#ifndef HARNESS_ISA_H
#define HARNESS_ISA_H

#include <stdint.h>
#include <stdio.h>
#include <vulkan/vulkan.h>

/* How many textures a fragment shader may read. */
enum { ISA_TEXTURES = 16 };

/* A file of SPIR-V. */
typedef struct {
    uint32_t *words;
    size_t size; /* in bytes */
} isa_spirv;

/* A device without a window, and the one function of it that the loader does not export. */
typedef struct {
    VkInstance instance;
    VkDevice device;
    VkPhysicalDeviceProperties properties;
    char driver[VK_MAX_DRIVER_INFO_SIZE]; /* "Mesa 22.3.6" */
    PFN_vkGetPipelineExecutablePropertiesKHR executables;
    PFN_vkGetPipelineExecutableStatisticsKHR statistics;
    PFN_vkGetPipelineExecutableInternalRepresentationsKHR representations;
} isa_device;

/* Says on stderr what went wrong, and returns -1. */
int isa_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Opens the first device that there is. The int functions return 0, or -1 after isa_fail(). */
int isa_open(isa_device *device);
void isa_close(isa_device *device);

/* Compiles a pipeline of the two stages and prints one line of JSON about its fragment stage:
 *     {"device": .., "driver": .., "statistics": {NAME: NUMBER, ..}, "assembly": TEXT}
 * The names are the driver's. The fragment stage may read a uniform buffer, set 0 binding 0, and textures, bindings 1
 * to ISA_TEXTURES of that set. */
int isa_report(const isa_device *device, const isa_spirv *vertex, const isa_spirv *fragment, FILE *out);

/* Prints a text as a string of JSON. */
void isa_print_string(FILE *out, const char *text, size_t length);

#endif
