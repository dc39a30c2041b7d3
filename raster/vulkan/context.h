// A Vulkan device and its resources; destructors free them. API failures are thrown as VulkanError and caught at the module's entry
// (vulkan_renderer.cpp).
#pragma once
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>
#include <vulkan/vulkan.h>

#include "core/base/result.h"
#include "raster/vulkan/vulkan_renderer.h"

namespace burnish {

struct VulkanError {
    Error error;
};

// Throws on failure, with the text of the call.
void vk_check(VkResult result, const char* call);
#define BN_VK(call) ::burnish::vk_check((call), #call)

// Returns an API structure, zero except for its type.
template <class T> T vk_struct(VkStructureType type, void* next = nullptr)
{
    T t = {};
    t.sType = type;
    t.pNext = next;
    return t;
}

struct Features {
    bool float64 = false;                                   // depth by the tile renderer's formula
    bool standard_samples = false;                          // multisampled targets use the standard sample positions
    bool primitive_id = false;                              // fragments know their triangle
    VkSampleCountFlags target_samples = 0;                  // for images that pass 1 writes and pass 2 reads
    int max_viewport = 0;                                   // pixels
    std::uint32_t max_image = 0, max_framebuffer_width = 0; // pixels
    std::uint32_t max_index = 0;                            // of a vertex
    VkDeviceSize max_buffer = 0;                            // storage buffer, bytes
    std::uint32_t max_samplers = 0, max_sampled_images = 0; // per stage
    std::uint32_t max_buffers = 0;                          // storage buffers per stage
};

// Instance, device and one queue. Made once per renderer.
class Context {
  public:
    explicit Context(const VulkanOptions& options);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    VkDevice device() const { return device_; }
    const Features& features() const { return features_; }
    const VulkanDeviceInfo& info() const { return info_; }
    VkPipelineCache pipeline_cache() const { return cache_; }
    bool cache_loaded() const { return cache_loaded_; }                                   // filled by an earlier run
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const; // throws if there is none
    bool host_visible_device_memory() const; // one memory for both: CPU devices, GPUs with mapped memory

    VkCommandBuffer begin();           // one at a time
    void submit(VkCommandBuffer work); // waits until the work is done
    // Returns the validation layer's messages since the last call; empty if none.
    std::string validation_messages();

  private:
    Context() = default; // lets the destructor free the parts if a constructor throws
    void make_instance(bool validate);
    void choose_device(const VulkanOptions& options);
    void make_device();
    void load_cache();
    void save_cache() const;

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t family_ = 0;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    bool cache_loaded_ = false;
    std::string cache_path_;
    VkPhysicalDeviceMemoryProperties memory_ = {};
    Features features_;
    VulkanDeviceInfo info_;
    std::vector<std::string> messages_;
};

class Buffer {
  public:
    Buffer() = default;
    enum class Place { device, host }; // host: read back through data()
    Buffer(const Context& context, VkDeviceSize bytes, Place place, VkBufferUsageFlags more = 0);
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer other) noexcept
    {
        swap(other);
        return *this;
    }
    ~Buffer();

    VkBuffer handle() const { return buffer_; }
    VkDeviceSize bytes() const { return bytes_; }
    VkDeviceAddress address() const;
    void* data() const { return mapped_; } // null if not mapped
    template <class T> const T* as() const { return static_cast<const T*>(mapped_); }

  private:
    void swap(Buffer& o) noexcept
    {
        std::swap(device_, o.device_), std::swap(buffer_, o.buffer_), std::swap(memory_, o.memory_);
        std::swap(bytes_, o.bytes_), std::swap(mapped_, o.mapped_);
    }
    VkDevice device_ = VK_NULL_HANDLE;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize bytes_ = 0;
    void* mapped_ = nullptr;
};

// Makes a buffer with these bytes, through a staging buffer if it cannot be mapped.
Buffer make_filled_buffer(Context& context, const void* data, std::size_t bytes, VkBufferUsageFlags more = 0);
void fill_buffer(Context& context, const Buffer& buffer, const void* data, std::size_t bytes);

struct ImageShape {
    VkFormat format = VK_FORMAT_UNDEFINED;
    int width = 0, height = 0, levels = 1, layers = 1; // 6 layers: a cube
    int depth = 1;                                     // above 1: three dimensions
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkImageUsageFlags usage = 0;
};

class DeviceImage {
  public:
    DeviceImage() = default;
    DeviceImage(const Context& context, const ImageShape& shape);
    DeviceImage(DeviceImage&& other) noexcept { swap(other); }
    DeviceImage& operator=(DeviceImage other) noexcept
    {
        swap(other);
        return *this;
    }
    ~DeviceImage();
    VkImage handle() const { return image_; }
    VkImageView view() const { return view_; }
    VkImageAspectFlags aspect() const { return aspect_; }

  private:
    void swap(DeviceImage& o) noexcept
    {
        std::swap(device_, o.device_), std::swap(image_, o.image_), std::swap(memory_, o.memory_);
        std::swap(view_, o.view_), std::swap(aspect_, o.aspect_);
    }
    VkDevice device_ = VK_NULL_HANDLE;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkImageAspectFlags aspect_ = 0;
};

// Makes all earlier work finished and visible to all later work.
void full_barrier(VkCommandBuffer commands);
void change_layout(VkCommandBuffer commands, const DeviceImage& image, VkImageLayout from, VkImageLayout to);

} // namespace burnish
