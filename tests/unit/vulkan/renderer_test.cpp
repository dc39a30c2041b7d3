// The Vulkan renderer on lavapipe: bands, failures, the pipeline cache. Skipped where lavapipe is missing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vulkan/vulkan.h>

#include "core/scene/builtin/builtin.h"
#include "raster/vulkan/bands.h"
#include "raster/vulkan/forward_shaders.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "tests/unit/raster/fixture.h"

namespace {
int allocations_left = -1;                          // device memory allocations before failure; below 0: no limit
void (*lowered)(VkPhysicalDeviceLimits&) = nullptr; // lowers the reported device limits

template <class F> F loaders(F, const char* name)
{
    return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}
} // namespace

// Overrides the loader's function.
extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                                           const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory)
{
    if (allocations_left == 0)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    allocations_left -= allocations_left > 0;
    static const auto allocate = loaders(vkAllocateMemory, "vkAllocateMemory");
    return allocate(device, info, callbacks, memory);
}

extern "C" VKAPI_ATTR void VKAPI_CALL vkGetPhysicalDeviceProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties)
{
    static const auto ask = loaders(vkGetPhysicalDeviceProperties, "vkGetPhysicalDeviceProperties");
    ask(device, properties);
    if (lowered)
        lowered(properties->limits);
}

namespace burnish::test {
namespace {

VulkanOptions lavapipe(VulkanPipeline pipeline = VulkanPipeline::ids, VulkanSampler sampler = VulkanSampler::exact)
{
    VulkanOptions options;
    options.device = "lavapipe", options.use_cache = false;
    options.pipeline = pipeline, options.sampler = sampler;
    return options;
}

std::unique_ptr<Stage> spheres()
{
    Result<Scene> scene = make_builtin_scene("spheres");
    EXPECT_TRUE(scene);
    return std::make_unique<Stage>(std::move(*scene), 1.0f, 2);
}

struct Device { // with a renderer of a scene
    Device(const Stage& stage, const VulkanOptions& options)
    {
        Result<std::shared_ptr<VulkanDevice>> opened = open_vulkan_device(options);
        if (!opened) {
            error = opened.error();
            return;
        }
        Result<std::unique_ptr<Renderer>> made = make_vulkan_renderer(stage.input(), *opened);
        if (made)
            renderer = std::move(*made);
        else
            error = made.error();
    }
    std::unique_ptr<Renderer> renderer;
    Error error;
};

FrameDesc desc_of(const Stage& stage, int width, int height, int msaa)
{
    FrameDesc d;
    d.width = width, d.height = height, d.msaa = msaa;
    d.view = auto_frame(stage.tables, width, height);
    return d;
}

float largest_difference(const Image& a, const Image& b)
{
    float largest = 0.0f;
    for (std::size_t i = 0; i < a.bytes.size() / sizeof(float); ++i)
        largest = std::max(largest, std::abs(a.f32()[i] - b.f32()[i]));
    return largest;
}

#define BN_NEEDS(device)                                                                                                                   \
    if (!(device).renderer)                                                                                                                \
    GTEST_SKIP() << (device).error.line()

TEST(vulkan, bands_give_the_same_words_as_one_picture)
{
    const std::unique_ptr<Stage> stage = spheres();
    for (VulkanPipeline pipeline : {VulkanPipeline::ids, VulkanPipeline::forward}) {
        VulkanOptions options = lavapipe(pipeline);
        Device whole(*stage, options);
        options.band_bytes = 100 * 1024; // a few rows
        Device bands(*stage, options);
        BN_NEEDS(whole);
        for (int msaa : {1, 4}) {
            FrameDesc d = desc_of(*stage, 75, 53, msaa);
            for (bool stages : {false, true}) {
                if (pipeline == VulkanPipeline::forward && (stages || msaa == 1))
                    continue; // a driver takes seconds to compile each
                d.stages = stages;
                const Result<Frame> a = whole.renderer->render(d), b = bands.renderer->render(d);
                ASSERT_TRUE(a && b);
                ASSERT_EQ(a->triangle_ids.size(), b->triangle_ids.size());
                EXPECT_TRUE(std::equal(a->triangle_ids.data(), a->triangle_ids.data() + a->triangle_ids.size(), b->triangle_ids.data()));
                if (pipeline == VulkanPipeline::forward) { // the device interpolates from another row
                    EXPECT_LT(largest_difference(a->color, b->color), 0.01f) << "msaa " << msaa;
                    continue;
                }
                EXPECT_EQ(pixel_hash(a->color), pixel_hash(b->color)) << "msaa " << msaa;
                EXPECT_EQ(a->stats.visible_fragments, b->stats.visible_fragments);
                ASSERT_EQ(a->stages.pairs.size(), b->stages.pairs.size());
                if (stages) {
                    EXPECT_EQ(std::memcmp(a->stages.pairs.data(), b->stages.pairs.data(), 4 * a->stages.pairs.size()), 0);
                    EXPECT_EQ(std::memcmp(a->stages.depths.data(), b->stages.depths.data(), 4 * a->stages.depths.size()), 0);
                }
            }
            if (pipeline == VulkanPipeline::ids) {
                d.stages = false;
                EXPECT_EQ(pixel_hash(stage->render(d, best_isa()).color), pixel_hash(bands.renderer->render(d)->color));
            }
        }
    }
}

TEST(vulkan, windows_have_the_words_of_the_tile_renderer)
{
    const std::unique_ptr<Stage> stage = spheres();
    Device device(*stage, lavapipe()), forward(*stage, lavapipe(VulkanPipeline::forward));
    BN_NEEDS(device);
    for (const char* technique : {"bent_normal", "lobe_line"})
        for (const auto& [width, height] : {std::pair(176, 96), std::pair(40000, 24000)}) {
            FrameDesc d = desc_of(*stage, width, height, 4);
            d.technique = technique, d.samples = find_technique(technique)->default_samples;
            d.width = 88, d.height = 40;
            d.window = {width, height, width / 2 / kWindowStep * kWindowStep, height / 2 / kWindowStep * kWindowStep};
            const Frame tile = stage->render(d, best_isa());
            EXPECT_GT(tile.stats.visible_fragments, 1000u);
            const Result<Frame> frame = device.renderer->render(d);
            ASSERT_TRUE(frame) << frame.error().line();
            EXPECT_EQ(largest_difference(frame->color, tile.color), 0.0f) << width << technique;
            const Result<Frame> refused = forward.renderer->render(d);
            EXPECT_TRUE(!refused && refused.error().code == ExitCode::usage);
        }
}

// Stages are pruned by a frame's numbers: the next frame has others.
TEST(vulkan, frames_with_other_settings_have_the_words_of_the_tile_renderer)
{
    const std::unique_ptr<Stage> stage = spheres();
    Device device(*stage, lavapipe());
    BN_NEEDS(device);
    void (*const changes[])(FrameDesc&) = {[](FrameDesc&) {},
                                           [](FrameDesc& d) { d.energy_compensation = true; },
                                           [](FrameDesc& d) { d.tilt_rad = glm::vec2(0.3f, -0.1f); },
                                           [](FrameDesc& d) { d.technique = "mc", d.samples = 8; },
                                           [](FrameDesc& d) { d.background = false, d.fresnel = kFresnelConductor; },
                                           [](FrameDesc&) {}};
    for (std::size_t i = 0; i < std::size(changes); ++i) {
        FrameDesc d = desc_of(*stage, 64, 40, 1);
        d.technique = "bent_normal", d.samples = 1;
        changes[i](d);
        const Result<Frame> frame = device.renderer->render(d);
        ASSERT_TRUE(frame) << frame.error().line();
        EXPECT_EQ(largest_difference(frame->color, stage->render(d, best_isa()).color), 0.0f) << i;
    }
}

TEST(vulkan, a_limit_that_is_exceeded_is_named_with_need_and_have)
{
    try {
        const Context context(lavapipe());
        require_limit(context, "FrameDesc::width", "maxImageDimension2D", 8, 8);
        require_limit(context, "FrameDesc::width", "maxImageDimension2D", 9, 8);
        FAIL() << "nothing was said";
    } catch (const VulkanError& failed) {
        if (failed.error.field == "VulkanOptions::device")
            GTEST_SKIP() << failed.error.line();
        EXPECT_EQ(failed.error.code, ExitCode::unavailable);
        EXPECT_EQ(failed.error.line().rfind("FrameDesc::width: 9 is needed of maxImageDimension2D, llvmpipe", 0), 0u)
            << failed.error.line();
    }
}

// Opening compares a stage's bindings with the device's limits. Pipelines without native samplers need no samplers.
TEST(vulkan, a_device_of_few_samplers_or_buffers_is_refused_by_what_binds_more)
{
    struct Low {
        const char *field, *limit;
        void (*lower)(VkPhysicalDeviceLimits&);
        VulkanPipeline pipeline;
        VulkanSampler sampler;
        const ForwardShaders* shaders = nullptr;
    };
    const ForwardShaders of_caller = {{}, 4, nullptr}; // four samplers more
    const auto samplers = [](VkPhysicalDeviceLimits& l) { l.maxPerStageDescriptorSamplers = 16; };
    const auto images = [](VkPhysicalDeviceLimits& l) { l.maxPerStageDescriptorSampledImages = 16; };
    const Low lows[] = {
        {"VulkanOptions::sampler", "maxPerStageDescriptorSamplers", samplers, VulkanPipeline::forward, VulkanSampler::native},
        {"VulkanOptions::sampler", "maxPerStageDescriptorSampledImages", images, VulkanPipeline::forward, VulkanSampler::native},
        {"VulkanOptions::sampler", "maxPerStageDescriptorSamplers", [](VkPhysicalDeviceLimits& l) { l.maxPerStageDescriptorSamplers = 20; },
         VulkanPipeline::forward, VulkanSampler::native, &of_caller},
        {"VulkanOptions::device", "maxPerStageDescriptorStorageBuffers",
         [](VkPhysicalDeviceLimits& l) { l.maxPerStageDescriptorStorageBuffers = 4; }, VulkanPipeline::ids, VulkanSampler::exact},
        {nullptr, nullptr, samplers, VulkanPipeline::ids, VulkanSampler::exact},
        {nullptr, nullptr, images, VulkanPipeline::forward, VulkanSampler::exact}};
    if (const auto there = open_vulkan_device(lavapipe()); !there)
        GTEST_SKIP() << there.error().line();
    for (const Low& low : lows) {
        lowered = low.lower;
        VulkanOptions options = lavapipe(low.pipeline, low.sampler);
        options.shaders = low.shaders;
        const Result<std::shared_ptr<VulkanDevice>> opened = open_vulkan_device(options);
        lowered = nullptr;
        ASSERT_EQ(static_cast<bool>(opened), low.limit == nullptr) << (opened ? "nothing was said" : opened.error().line());
        if (opened)
            continue;
        EXPECT_EQ(opened.error().code, ExitCode::unavailable);
        EXPECT_EQ(opened.error().field, low.field);
        EXPECT_NE(opened.error().line().find(std::string(" is needed of ") + low.limit + ", llvmpipe"), std::string::npos)
            << opened.error().line();
    }
}

// Every allocation of a frame fails once, in turn. The frame reports the failure, and the next frame is right.
TEST(vulkan, draws_again_after_running_out_of_memory)
{
    const std::unique_ptr<Stage> stage = spheres();
    for (VulkanPipeline pipeline : {VulkanPipeline::ids, VulkanPipeline::forward}) {
        Device device(*stage, lavapipe(pipeline));
        BN_NEEDS(device);
        const FrameDesc small = desc_of(*stage, 40, 30, 1), large = desc_of(*stage, 64, 48, 4);
        int failures = 0;
        for (int given = 0;; ++given) {
            ASSERT_TRUE(device.renderer->render(small)); // resets the kept memory to this size
            allocations_left = given;
            const Result<Frame> frame = device.renderer->render(large);
            allocations_left = -1;
            if (frame)
                break;
            ++failures;
            EXPECT_EQ(frame.error().code, ExitCode::bad_input);
            EXPECT_NE(frame.error().reason.find("out of memory by vkAllocateMemory"), std::string::npos) << frame.error().line();
        }
        EXPECT_GT(failures, 1) << "a larger frame needs no more memory: nothing is tested";
        const Result<Frame> again = device.renderer->render(large);
        ASSERT_TRUE(again) << again.error().line();
        if (pipeline == VulkanPipeline::ids) {
            EXPECT_EQ(pixel_hash(again->color), pixel_hash(stage->render(large, best_isa()).color));
        }
    }
}

TEST(vulkan, a_scene_of_nothing_shows_the_backdrop)
{
    const Stage stage(Scene{}, 0.5f);
    VulkanOptions options = lavapipe(VulkanPipeline::forward, VulkanSampler::native);
    options.validate = true;
    Device device(stage, options);
    BN_NEEDS(device);
    FrameDesc d;
    d.width = 16, d.height = 8, d.msaa = 1;
    d.view = make_view(glm::vec3(0, 0, 1), glm::vec3(0), 0.7f, d.width, d.height);
    const Result<Frame> frame = device.renderer->render(d);
    ASSERT_TRUE(frame) << frame.error().line();
    EXPECT_NEAR(frame->color.f32()[0], 0.5f, 1e-3f);
}

// Runs in a new empty folder.
class cache : public testing::Test {
  protected:
    void SetUp() override
    {
        char name[] = "/tmp/burnish_cache_XXXXXX";
        folder = ::mkdtemp(name);
        ::setenv("XDG_CACHE_HOME", folder.c_str(), 1);
    }
    void TearDown() override
    {
        ::unsetenv("XDG_CACHE_HOME");
        std::filesystem::remove_all(folder);
    }
    // Draws a frame on a new device. Returns true if the cache held anything, and the frame's hash.
    std::pair<bool, std::uint64_t> draw()
    {
        VulkanOptions options = lavapipe();
        options.use_cache = true;
        const bool loaded = Context(options).cache_loaded();
        Device device(*stage, options);
        FrameDesc d = desc_of(*stage, 40, 30, 1);
        d.technique = "split_isotropic"; // the least to compile
        return {loaded, pixel_hash(device.renderer->render(d)->color)};
    }
    std::filesystem::path file() const
    {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
            if (entry.path().filename().string().rfind("pipelines-", 0) == 0)
                return entry.path();
        return {};
    }
    std::string folder;
    std::unique_ptr<Stage> stage = spheres();
};

TEST_F(cache, is_used_by_the_second_run_and_ignored_where_it_is_broken)
{
    BN_NEEDS(Device(*stage, lavapipe()));
    const auto first = draw();
    EXPECT_FALSE(first.first) << "there was none";
    ASSERT_FALSE(file().empty());
    const auto write = [&](const std::string& text) { std::ofstream(file(), std::ios::binary | std::ios::trunc) << text; };
    write(std::string(4096, 'x'));
    EXPECT_EQ(draw(), std::pair(false, first.second)) << "of no driver";
    EXPECT_EQ(draw(), std::pair(true, first.second)) << "written anew";
    write("short");
    VulkanOptions options = lavapipe();
    options.use_cache = true;
    EXPECT_FALSE(Context(options).cache_loaded());
}

} // namespace
} // namespace burnish::test
