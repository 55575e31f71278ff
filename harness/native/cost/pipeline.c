/* pipeline.c: compiles a pipeline and prints what the driver says of its fragment stage. */
#include "isa.h"

#include <stdlib.h>
#include <string.h>

enum { EXECUTABLES_MAX = 8, STATISTICS_MAX = 64, REPRESENTATIONS_MAX = 16 };

static VkShaderModule make_module(const isa_device *device, const isa_spirv *code) {
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = code->size,
        .pCode = code->words,
    };
    VkShaderModule module = VK_NULL_HANDLE;
    if (vkCreateShaderModule(device->device, &info, NULL, &module) != VK_SUCCESS)
        isa_fail("%s: refuses the SPIR-V", device->properties.deviceName);
    return module;
}

/* Set 0: a uniform buffer in binding 0, and textures with their samplers in those after it. */
static VkDescriptorSetLayout make_set(const isa_device *device) {
    VkDescriptorSetLayoutBinding bindings[1 + ISA_TEXTURES];
    for (uint32_t k = 0; k < 1 + ISA_TEXTURES; ++k)
        bindings[k] = (VkDescriptorSetLayoutBinding){
            .binding = k,
            .descriptorType =
                k ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT,
        };
    VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1 + ISA_TEXTURES,
        .pBindings = bindings,
    };
    VkDescriptorSetLayout set = VK_NULL_HANDLE;
    if (vkCreateDescriptorSetLayout(device->device, &info, NULL, &set) != VK_SUCCESS)
        isa_fail("%s: makes no layout of descriptors", device->properties.deviceName);
    return set;
}

static VkPipelineLayout make_layout(const isa_device *device, VkDescriptorSetLayout set) {
    VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &set,
    };
    VkPipelineLayout layout = VK_NULL_HANDLE;
    if (vkCreatePipelineLayout(device->device, &info, NULL, &layout) != VK_SUCCESS)
        isa_fail("%s: makes no pipeline layout", device->properties.deviceName);
    return layout;
}

/* Triangles to eight targets of 32-bit floats, so that no output is converted or dropped. */
static VkPipeline make_pipeline(const isa_device *device, VkPipelineLayout layout, VkShaderModule vertex,
                                VkShaderModule fragment) {
    enum { TARGETS = 8 };
    VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main"},
    };
    VkFormat formats[TARGETS];
    VkPipelineColorBlendAttachmentState blends[TARGETS];
    for (int k = 0; k < TARGETS; ++k) {
        formats[k] = VK_FORMAT_R32G32B32A32_SFLOAT;
        blends[k] = (VkPipelineColorBlendAttachmentState){.colorWriteMask = 0xf};
    }
    VkPipelineRenderingCreateInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = TARGETS,
        .pColorAttachmentFormats = formats,
    };
    VkPipelineVertexInputStateCreateInfo no_attributes = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
    };
    VkPipelineInputAssemblyStateCreateInfo triangles = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    VkViewport viewport = {0, 0, 64, 64, 0, 1};
    VkRect2D scissor = {{0, 0}, {64, 64}};
    VkPipelineViewportStateCreateInfo viewports = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor,
    };
    VkPipelineRasterizationStateCreateInfo rasterization = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .lineWidth = 1,
    };
    VkPipelineMultisampleStateCreateInfo one_sample = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    VkPipelineColorBlendStateCreateInfo blending = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = TARGETS,
        .pAttachments = blends,
    };
    VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &rendering,
        .flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR |
                 VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR,
        .stageCount = 2,
        .pStages = stages,
        .pVertexInputState = &no_attributes,
        .pInputAssemblyState = &triangles,
        .pViewportState = &viewports,
        .pRasterizationState = &rasterization,
        .pMultisampleState = &one_sample,
        .pColorBlendState = &blending,
        .layout = layout,
    };
    VkPipeline pipeline = VK_NULL_HANDLE;
    if (vkCreateGraphicsPipelines(device->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline) != VK_SUCCESS)
        isa_fail("%s: refuses the pipeline", device->properties.deviceName);
    return pipeline;
}

/* The number of the fragment stage's executable, or -1. */
static int fragment_executable(const isa_device *device, VkPipeline pipeline) {
    VkPipelineInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
    VkPipelineExecutablePropertiesKHR found[EXECUTABLES_MAX];
    for (int k = 0; k < EXECUTABLES_MAX; ++k)
        found[k] = (VkPipelineExecutablePropertiesKHR){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
    uint32_t count = EXECUTABLES_MAX;
    if (device->executables(device->device, &info, &count, found) < 0)
        count = 0;
    for (uint32_t k = 0; k < count; ++k)
        if (found[k].stages & VK_SHADER_STAGE_FRAGMENT_BIT)
            return (int)k;
    return isa_fail("%s: tells nothing of the fragment stage", device->properties.deviceName);
}

static void print_number(FILE *out, const VkPipelineExecutableStatisticKHR *statistic) {
    switch (statistic->format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        fprintf(out, "%lld", (long long)statistic->value.i64);
        break;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
        fprintf(out, "%llu", (unsigned long long)statistic->value.u64);
        break;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
        fprintf(out, "%.17g", statistic->value.f64);
        break;
    default:
        fprintf(out, "%s", statistic->value.b32 ? "true" : "false");
    }
}

static int print_statistics(const isa_device *device, const VkPipelineExecutableInfoKHR *which, FILE *out) {
    VkPipelineExecutableStatisticKHR found[STATISTICS_MAX];
    for (int k = 0; k < STATISTICS_MAX; ++k)
        found[k] =
            (VkPipelineExecutableStatisticKHR){.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR};
    uint32_t count = STATISTICS_MAX;
    if (device->statistics(device->device, which, &count, found) < 0)
        return isa_fail("%s: gives no statistics", device->properties.deviceName);
    for (uint32_t k = 0; k < count; ++k) {
        fputs(k ? ", " : "", out);
        isa_print_string(out, found[k].name, strlen(found[k].name));
        fputs(": ", out);
        print_number(out, &found[k]);
    }
    return 0;
}

/* The last of the driver's texts: each is nearer to the machine than the one before. */
static int print_assembly(const isa_device *device, const VkPipelineExecutableInfoKHR *which, FILE *out) {
    VkPipelineExecutableInternalRepresentationKHR found[REPRESENTATIONS_MAX];
    for (int k = 0; k < REPRESENTATIONS_MAX; ++k)
        found[k] = (VkPipelineExecutableInternalRepresentationKHR){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR};
    uint32_t count = REPRESENTATIONS_MAX;
    if (device->representations(device->device, which, &count, found) < 0 || count == 0)
        return isa_fail("%s: gives no assembly", device->properties.deviceName);
    VkPipelineExecutableInternalRepresentationKHR *last = &found[count - 1];
    char *text = malloc(last->dataSize);
    for (uint32_t k = 0; k + 1 < count; ++k)
        found[k].dataSize = 0; /* not wanted */
    last->pData = text;
    int result = 0;
    if (!text || device->representations(device->device, which, &count, found) < 0)
        result = isa_fail("%s: gives no assembly", device->properties.deviceName);
    else
        isa_print_string(out, text, strnlen(text, last->dataSize));
    free(text);
    return result;
}

static int print_report(const isa_device *device, VkPipeline pipeline, FILE *out) {
    int fragment = fragment_executable(device, pipeline);
    if (fragment < 0)
        return -1;
    VkPipelineExecutableInfoKHR which = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
        .pipeline = pipeline,
        .executableIndex = (uint32_t)fragment,
    };
    fputs("{\"device\": ", out);
    isa_print_string(out, device->properties.deviceName, strlen(device->properties.deviceName));
    fputs(", \"driver\": ", out);
    isa_print_string(out, device->driver, strlen(device->driver));
    fputs(", \"statistics\": {", out);
    if (print_statistics(device, &which, out))
        return -1;
    fputs("}, \"assembly\": ", out);
    if (print_assembly(device, &which, out))
        return -1;
    fputs("}\n", out);
    return 0;
}

int isa_report(const isa_device *device, const isa_spirv *vertex, const isa_spirv *fragment, FILE *out) {
    VkShaderModule modules[2] = {make_module(device, vertex), make_module(device, fragment)};
    VkDescriptorSetLayout set = make_set(device);
    VkPipelineLayout layout = set ? make_layout(device, set) : VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    if (modules[0] && modules[1] && layout)
        pipeline = make_pipeline(device, layout, modules[0], modules[1]);
    int result = pipeline ? print_report(device, pipeline, out) : -1;
    vkDestroyPipeline(device->device, pipeline, NULL);
    vkDestroyPipelineLayout(device->device, layout, NULL);
    vkDestroyDescriptorSetLayout(device->device, set, NULL);
    vkDestroyShaderModule(device->device, modules[0], NULL);
    vkDestroyShaderModule(device->device, modules[1], NULL);
    return result;
}
