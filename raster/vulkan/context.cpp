#include "raster/vulkan/context.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <thread>

#include "core/base/cache.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/jobs/threads.h"

namespace burnish {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kChromiumDriver = "/usr/lib/chromium/vk_swiftshader_icd.json"; // Debian's package chromium-common

// Adds this driver to the loader's search, unless the user has set a driver list.
void add_chromium_driver()
{
    for (const char* own : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"})
        if (std::getenv(own))
            return;
    std::error_code ignored;
    if (std::filesystem::exists(kChromiumDriver, ignored))
        ::setenv("VK_ADD_DRIVER_FILES", kChromiumDriver, 0);
}

// Returns the number of threads that a driver starts with a device. lavapipe has one to accept work, one for each of its two queues, and
// one per core for triangles and for compute. If a thread is refused, lavapipe waits for ever.
int device_threads(const VulkanDeviceInfo& info)
{
    constexpr int kQueues = 4, kMostCores = 32;
    return kQueues + (info.cpu ? 2 * std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMostCores) : 0);
}

VKAPI_ATTR VkBool32 VKAPI_CALL note_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
    static_cast<std::vector<std::string>*>(user)->emplace_back(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(std::vector<std::string>* messages)
{
    auto info = vk_struct<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = note_message;
    info.pUserData = messages;
    return info;
}

bool layer_present(const char* name)
{
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(), [&](const VkLayerProperties& l) { return std::strcmp(l.layerName, name) == 0; });
}

VkInstance create_instance(bool validate, std::vector<std::string>* messages)
{
    add_chromium_driver();
    auto app = vk_struct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    app.pApplicationName = "burnish";
    app.apiVersion = VK_API_VERSION_1_3;
    auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &app;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(messages);
    if (validate) {
        info.enabledLayerCount = 1, info.ppEnabledLayerNames = &kValidationLayer;
        info.enabledExtensionCount = 1, info.ppEnabledExtensionNames = &extension;
        info.pNext = &messenger;
    }
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        return VK_NULL_HANDLE; // no driver at all
    vk_check(result, "vkCreateInstance");
    return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance)
{
    std::uint32_t count = 0;
    if (!instance || vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS)
        return {};
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance, &count, devices.data());
    return devices;
}

VulkanDeviceInfo info_of(VkPhysicalDevice device)
{
    auto driver = vk_struct<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto p = vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver);
    vkGetPhysicalDeviceProperties2(device, &p);
    const std::uint32_t v = p.properties.apiVersion;
    VulkanDeviceInfo info;
    info.name = p.properties.deviceName;
    info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    info.api = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(v), VK_API_VERSION_MINOR(v), VK_API_VERSION_PATCH(v));
    info.cpu = p.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    return info;
}

// Returns true if the device has the features that all stages need.
bool usable(VkPhysicalDevice device)
{
    VkPhysicalDeviceProperties p;
    vkGetPhysicalDeviceProperties(device, &p);
    if (p.apiVersion < VK_API_VERSION_1_3)
        return false;
    auto f12 = vk_struct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    auto f = vk_struct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f12);
    vkGetPhysicalDeviceFeatures2(device, &f);
    return f12.bufferDeviceAddress && f.features.sampleRateShading;
}

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool is_lavapipe(const VulkanDeviceInfo& info)
{
    return info.name.find("llvmpipe") != std::string::npos;
}

// Returns true if the device matches a name: a special one or a part of the device's name.
bool answers_to(const VulkanDeviceInfo& info, const std::string& wanted)
{
    if (wanted == "lavapipe")
        return is_lavapipe(info);
    if (wanted == "gpu")
        return !info.cpu;
    return lower(info.name).find(lower(wanted)) != std::string::npos;
}

std::string all_names(const std::vector<VkPhysicalDevice>& devices)
{
    std::string names;
    for (VkPhysicalDevice d : devices)
        names += (names.empty() ? "" : ", ") + info_of(d).name;
    return names.empty() ? "there is none" : "there are " + names;
}

} // namespace

void vk_check(VkResult result, const char* call)
{
    if (result == VK_SUCCESS)
        return;
    const bool memory = result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY;
    throw VulkanError{Error{memory ? ExitCode::bad_input : ExitCode::internal, "", "vulkan",
                            fmt::format("{} by {}", memory ? "out of memory" : fmt::format("error {}", static_cast<int>(result)), call)}};
}

std::vector<VulkanDeviceInfo> vulkan_devices()
{
    std::vector<VulkanDeviceInfo> infos;
    try {
        VkInstance instance = create_instance(false, nullptr);
        for (VkPhysicalDevice device : physical_devices(instance))
            if (usable(device))
                infos.push_back(info_of(device));
        if (instance)
            vkDestroyInstance(instance, nullptr);
    } catch (const VulkanError&) {
        return {};
    }
    return infos;
}

Context::Context(const VulkanOptions& options) : Context()
{
    make_instance(options.validate);
    choose_device(options);
    make_device();
    if (options.use_cache)
        load_cache();
    auto none = vk_struct<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    if (!cache_)
        BN_VK(vkCreatePipelineCache(device_, &none, nullptr, &cache_));
}

Context::~Context()
{
    if (device_) {
        if (cache_)
            save_cache();
        vkDestroyPipelineCache(device_, cache_, nullptr);
        vkDestroyFence(device_, fence_, nullptr);
        vkDestroyCommandPool(device_, pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (messenger_) {
        const auto destroy =
            reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    if (instance_)
        vkDestroyInstance(instance_, nullptr);
}

void Context::make_instance(bool validate)
{
    if (validate && !layer_present(kValidationLayer))
        throw VulkanError{Error{ExitCode::unavailable, "", "", "the Khronos validation layer is not installed", "VulkanOptions::validate"}};
    instance_ = create_instance(validate, &messages_);
    if (!instance_)
        throw VulkanError{Error{ExitCode::unavailable, "", "", "no Vulkan driver is installed", "VulkanOptions::device"}};
    if (!validate)
        return;
    const VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(&messages_);
    const auto create =
        reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    BN_VK(create(instance_, &info, nullptr, &messenger_));
}

void Context::choose_device(const VulkanOptions& options)
{
    const std::vector<VkPhysicalDevice> all = physical_devices(instance_);
    std::vector<VkPhysicalDevice> candidates;
    for (VkPhysicalDevice d : all)
        if (usable(d) && (options.device.empty() || answers_to(info_of(d), options.device)))
            candidates.push_back(d);
    const auto rank = [&](VkPhysicalDevice d) { // the lowest rank wins
        const VulkanDeviceInfo info = info_of(d);
        return options.prefer_cpu ? (is_lavapipe(info) ? 0 : info.cpu ? 1 : 2) : (!info.cpu ? 0 : is_lavapipe(info) ? 1 : 2);
    };
    std::stable_sort(candidates.begin(), candidates.end(), [&](VkPhysicalDevice a, VkPhysicalDevice b) { return rank(a) < rank(b); });
    if (candidates.empty())
        throw VulkanError{Error{ExitCode::unavailable, "", "",
                                options.device.empty() ? "no Vulkan 1.3 device: " + all_names(all)
                                                       : "no Vulkan 1.3 device '" + options.device + "': " + all_names(all),
                                "VulkanOptions::device"}};
    physical_ = candidates.front();
    info_ = info_of(physical_);
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

void Context::make_device()
{
    VkPhysicalDeviceProperties p;
    vkGetPhysicalDeviceProperties(physical_, &p);
    VkPhysicalDeviceFeatures f;
    vkGetPhysicalDeviceFeatures(physical_, &f);
    features_.float64 = f.shaderFloat64;
    features_.standard_samples = p.limits.standardSampleLocations;
    features_.primitive_id = f.geometryShader; // a part of this feature
    features_.max_viewport = static_cast<int>(std::min(p.limits.maxViewportDimensions[0], p.limits.maxViewportDimensions[1]));
    features_.max_image = p.limits.maxImageDimension2D, features_.max_framebuffer_width = p.limits.maxFramebufferWidth;
    features_.max_index = p.limits.maxDrawIndexedIndexValue;
    features_.max_buffer = p.limits.maxStorageBufferRange;
    features_.max_samplers = p.limits.maxPerStageDescriptorSamplers,
    features_.max_sampled_images = p.limits.maxPerStageDescriptorSampledImages;
    features_.max_buffers = p.limits.maxPerStageDescriptorStorageBuffers;
    features_.target_samples = p.limits.framebufferColorSampleCounts & p.limits.framebufferDepthSampleCounts &
                               p.limits.sampledImageColorSampleCounts & p.limits.sampledImageDepthSampleCounts;

    // Find a queue family for graphics and compute
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
    constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (family_ < count && (families[family_].queueFlags & kBoth) != kBoth)
        ++family_;
    if (family_ == count)
        throw VulkanError{
            Error{ExitCode::unavailable, "", "", info_.name + " has no queue for graphics and compute", "VulkanOptions::device"}};

    // Create the device
    const float priority = 1.0f;
    auto queue = vk_struct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = family_, queue.queueCount = 1, queue.pQueuePriorities = &priority;
    auto f13 = vk_struct<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    f13.dynamicRendering = VK_TRUE, f13.maintenance4 = VK_TRUE;
    auto f12 = vk_struct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &f13);
    f12.bufferDeviceAddress = VK_TRUE;
    auto wanted = vk_struct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f12);
    wanted.features.sampleRateShading = VK_TRUE;
    wanted.features.geometryShader = f.geometryShader;
    wanted.features.shaderFloat64 = f.shaderFloat64;
    auto info = vk_struct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &wanted);
    info.queueCreateInfoCount = 1, info.pQueueCreateInfos = &queue;
    if (const Status threads = expect_threads(device_threads(info_), info_.name); !threads)
        throw VulkanError{threads.error()};
    BN_VK(vkCreateDevice(physical_, &info, nullptr, &device_));
    vkGetDeviceQueue(device_, family_, 0, &queue_);

    // Create the command pool, the command buffer and the fence
    auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, pool.queueFamilyIndex = family_;
    BN_VK(vkCreateCommandPool(device_, &pool, nullptr, &pool_));
    auto allocate = vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    allocate.commandPool = pool_, allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY, allocate.commandBufferCount = 1;
    BN_VK(vkAllocateCommandBuffers(device_, &allocate, &commands_));
    auto fence = vk_struct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    BN_VK(vkCreateFence(device_, &fence, nullptr, &fence_));
}

// Returns true if the bytes start like this device's cache (VkPipelineCacheHeaderVersionOne). Not every driver checks.
static bool is_cache_of(const VkPhysicalDeviceProperties& p, const std::vector<std::uint8_t>& bytes)
{
    VkPipelineCacheHeaderVersionOne header;
    if (bytes.size() < sizeof header)
        return false;
    std::memcpy(&header, bytes.data(), sizeof header);
    return header.headerSize >= sizeof header && header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == p.vendorID && header.deviceID == p.deviceID &&
           std::equal(std::begin(header.pipelineCacheUUID), std::end(header.pipelineCacheUUID), p.pipelineCacheUUID);
}

// Loads the cache file for this device and driver.
void Context::load_cache()
{
    const std::string folder = cache_folder();
    if (folder.empty())
        return;
    VkPhysicalDeviceProperties p;
    vkGetPhysicalDeviceProperties(physical_, &p);
    const std::uint64_t key = hash_bytes(p.pipelineCacheUUID, sizeof p.pipelineCacheUUID, p.driverVersion);
    cache_path_ = folder + fmt::format("/pipelines-{:016x}.bin", key);
    auto info = vk_struct<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    std::error_code ignored;
    if (!std::filesystem::exists(cache_path_, ignored))
        return;
    const Result<std::vector<std::uint8_t>> bytes = read_file(cache_path_, 256u << 20, Links::refuse);
    if (!bytes || !is_cache_of(p, *bytes))
        return;
    info.initialDataSize = bytes->size(), info.pInitialData = bytes->data();
    if (vkCreatePipelineCache(device_, &info, nullptr, &cache_) != VK_SUCCESS)
        cache_ = VK_NULL_HANDLE;
    cache_loaded_ = cache_ != VK_NULL_HANDLE;
}

void Context::save_cache() const
{
    if (cache_path_.empty())
        return;
    std::size_t size = 0;
    if (vkGetPipelineCacheData(device_, cache_, &size, nullptr) != VK_SUCCESS || size == 0)
        return;
    std::vector<std::uint8_t> bytes(size);
    if (vkGetPipelineCacheData(device_, cache_, &size, bytes.data()) != VK_SUCCESS)
        return;
    std::error_code ignored;
    std::filesystem::create_directories(std::filesystem::path(cache_path_).parent_path(), ignored);
    const Status written = write_file_atomic(cache_path_, bytes.data(), size, Links::refuse);
    static_cast<void>(written); // a cache that cannot be stored costs only time
    prune_cache(cache_folder(), cache_limit(), cache_path_);
}

std::uint32_t Context::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const
{
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
        if ((allowed >> i & 1u) && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted)
            return i;
    throw VulkanError{Error{ExitCode::unavailable, "", "", info_.name + " lacks a kind of memory", "VulkanOptions::device"}};
}

bool Context::host_visible_device_memory() const
{
    constexpr VkMemoryPropertyFlags kAll =
        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    return info_.cpu && std::any_of(memory_.memoryTypes, memory_.memoryTypes + memory_.memoryTypeCount,
                                    [](const VkMemoryType& t) { return (t.propertyFlags & kAll) == kAll; });
}

VkCommandBuffer Context::begin()
{
    auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    BN_VK(vkResetCommandBuffer(commands_, 0)); // stopped work may have left it open
    BN_VK(vkBeginCommandBuffer(commands_, &info));
    return commands_;
}

void Context::submit(VkCommandBuffer work)
{
    BN_VK(vkEndCommandBuffer(work));
    auto info = vk_struct<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = 1, info.pCommandBuffers = &work;
    BN_VK(vkQueueSubmit(queue_, 1, &info, fence_));
    BN_VK(vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX));
    BN_VK(vkResetFences(device_, 1, &fence_));
}

std::string Context::validation_messages()
{
    std::string text;
    for (const std::string& message : messages_)
        text += (text.empty() ? "" : " | ") + message;
    messages_.clear();
    return text;
}

Buffer::Buffer(const Context& context, VkDeviceSize bytes, Place place, VkBufferUsageFlags more) : Buffer()
{
    device_ = context.device();
    bytes_ = std::max<VkDeviceSize>(bytes, 64); // an empty buffer cannot be bound
    auto info = vk_struct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = bytes_;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | more;
    BN_VK(vkCreateBuffer(device_, &info, nullptr, &buffer_));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer_, &needs);
    const bool mapped = place == Place::host || context.host_visible_device_memory();
    VkMemoryPropertyFlags wanted =
        mapped ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    auto flags = vk_struct<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    auto allocate = vk_struct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    if (more & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT)
        allocate.pNext = &flags;
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = context.memory_type(needs.memoryTypeBits, wanted);
    BN_VK(vkAllocateMemory(device_, &allocate, nullptr, &memory_));
    BN_VK(vkBindBufferMemory(device_, buffer_, memory_, 0));
    if (mapped)
        BN_VK(vkMapMemory(device_, memory_, 0, VK_WHOLE_SIZE, 0, &mapped_));
}

Buffer::~Buffer()
{
    if (!device_)
        return;
    vkDestroyBuffer(device_, buffer_, nullptr);
    vkFreeMemory(device_, memory_, nullptr);
}

VkDeviceAddress Buffer::address() const
{
    auto info = vk_struct<VkBufferDeviceAddressInfo>(VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO);
    info.buffer = buffer_;
    return vkGetBufferDeviceAddress(device_, &info);
}

void fill_buffer(Context& context, const Buffer& buffer, const void* data, std::size_t bytes)
{
    if (bytes == 0)
        return;
    if (buffer.data()) {
        std::memcpy(buffer.data(), data, bytes);
        return;
    }
    const Buffer staging(context, bytes, Buffer::Place::host);
    std::memcpy(staging.data(), data, bytes);
    VkCommandBuffer commands = context.begin();
    const VkBufferCopy copy = {0, 0, bytes};
    vkCmdCopyBuffer(commands, staging.handle(), buffer.handle(), 1, &copy);
    full_barrier(commands);
    context.submit(commands);
}

Buffer make_filled_buffer(Context& context, const void* data, std::size_t bytes, VkBufferUsageFlags more)
{
    Buffer buffer(context, bytes, Buffer::Place::device, more);
    fill_buffer(context, buffer, data, bytes);
    return buffer;
}

DeviceImage::DeviceImage(const Context& context, const ImageShape& shape) : DeviceImage()
{
    device_ = context.device();
    auto info = vk_struct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.flags = shape.layers == 6 ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
    info.imageType = shape.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = shape.format;
    info.extent = {static_cast<std::uint32_t>(shape.width), static_cast<std::uint32_t>(shape.height),
                   static_cast<std::uint32_t>(shape.depth)};
    info.mipLevels = static_cast<std::uint32_t>(shape.levels), info.arrayLayers = static_cast<std::uint32_t>(shape.layers);
    info.samples = shape.samples;
    info.usage = shape.usage;
    BN_VK(vkCreateImage(device_, &info, nullptr, &image_));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, image_, &needs);
    auto allocate = vk_struct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = context.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    BN_VK(vkAllocateMemory(device_, &allocate, nullptr, &memory_));
    BN_VK(vkBindImageMemory(device_, image_, memory_, 0));
    aspect_ = shape.format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    auto view = vk_struct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = image_;
    view.viewType = shape.depth > 1 ? VK_IMAGE_VIEW_TYPE_3D : shape.layers == 6 ? VK_IMAGE_VIEW_TYPE_CUBE : VK_IMAGE_VIEW_TYPE_2D;
    view.format = shape.format;
    view.subresourceRange = {aspect_, 0, info.mipLevels, 0, info.arrayLayers};
    BN_VK(vkCreateImageView(device_, &view, nullptr, &view_));
}

DeviceImage::~DeviceImage()
{
    if (!device_)
        return;
    vkDestroyImageView(device_, view_, nullptr);
    vkDestroyImage(device_, image_, nullptr);
    vkFreeMemory(device_, memory_, nullptr);
}

void full_barrier(VkCommandBuffer commands)
{
    auto barrier = vk_struct<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0,
                         1, &barrier, 0, nullptr, 0, nullptr);
}

void change_layout(VkCommandBuffer commands, const DeviceImage& image, VkImageLayout from, VkImageLayout to)
{
    auto barrier = vk_struct<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = from, barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &barrier);
}

} // namespace burnish
