/* device.c: a Vulkan device to compile for, without a window. */
#include "isa.h"

#include <string.h>

#define LENGTH(array) (sizeof(array) / sizeof((array)[0]))

static int open_instance(isa_device *opened) {
    VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "harness_isa",
        .apiVersion = VK_API_VERSION_1_3, /* dynamic rendering, which spares a render pass */
    };
    VkInstanceCreateInfo instance = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
    };
    if (vkCreateInstance(&instance, NULL, &opened->instance) != VK_SUCCESS)
        return isa_fail("no Vulkan driver could be loaded");
    return 0;
}

/* The first device; with RADV_FORCE_FAMILY that is the chip which it names. */
static VkPhysicalDevice first_device(isa_device *opened) {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    uint32_t count = 1;
    VkResult found = vkEnumeratePhysicalDevices(opened->instance, &count, &physical);
    if ((found != VK_SUCCESS && found != VK_INCOMPLETE) || count == 0)
        return VK_NULL_HANDLE;
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &driver,
    };
    vkGetPhysicalDeviceProperties2(physical, &properties);
    opened->properties = properties.properties;
    memcpy(opened->driver, driver.driverInfo, sizeof opened->driver);
    return physical;
}

int isa_open(isa_device *opened) {
    if (open_instance(opened))
        return -1;
    VkPhysicalDevice physical = first_device(opened);
    if (physical == VK_NULL_HANDLE)
        return isa_fail("the Vulkan driver has no device");

    float priority = 1;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    VkPhysicalDeviceDynamicRenderingFeatures rendering = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
        .dynamicRendering = VK_TRUE,
    };
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executables = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pNext = &rendering,
        .pipelineExecutableInfo = VK_TRUE,
    };
    const char *extensions[] = {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
    VkDeviceCreateInfo device = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &executables,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = LENGTH(extensions),
        .ppEnabledExtensionNames = extensions,
    };
    if (vkCreateDevice(physical, &device, NULL, &opened->device) != VK_SUCCESS)
        return isa_fail("%s does not tell what it compiles (VK_KHR_pipeline_executable_properties)",
                        opened->properties.deviceName);
    opened->executables = (PFN_vkGetPipelineExecutablePropertiesKHR)vkGetDeviceProcAddr(
        opened->device, "vkGetPipelineExecutablePropertiesKHR");
    opened->statistics = (PFN_vkGetPipelineExecutableStatisticsKHR)vkGetDeviceProcAddr(
        opened->device, "vkGetPipelineExecutableStatisticsKHR");
    opened->representations = (PFN_vkGetPipelineExecutableInternalRepresentationsKHR)vkGetDeviceProcAddr(
        opened->device, "vkGetPipelineExecutableInternalRepresentationsKHR");
    return 0;
}

void isa_close(isa_device *opened) {
    if (opened->device)
        vkDestroyDevice(opened->device, NULL);
    if (opened->instance)
        vkDestroyInstance(opened->instance, NULL);
}
