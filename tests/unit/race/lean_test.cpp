// The lean shaders refuse what they do not draw. Skipped where lavapipe is missing.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "core/scene/builtin/builtin.h"
#include "raster/vulkan/lab/lean.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

void change_nothing(FrameDesc&) {}

struct Refused {
    const char* scene;
    void (*change)(FrameDesc&);
    const char* needle;
};

TEST(lean, refuses_what_it_does_not_draw)
{
    VulkanOptions options;
    options.device = "lavapipe", options.use_cache = false;
    options.pipeline = VulkanPipeline::forward, options.sampler = VulkanSampler::native;
    options.shaders = lean_shaders();
    const Result<std::shared_ptr<VulkanDevice>> device = open_vulkan_device(options);
    if (!device)
        GTEST_SKIP() << device.error().line();
    const Refused all[] = {{"spheres", [](FrameDesc& d) { d.tilt_rad = glm::vec2(0.2f, 0.0f); }, "FrameDesc::tilt"},
                           {"spheres", [](FrameDesc& d) { d.fresnel = 1; }, "FrameDesc::fresnel"},
                           {"spheres", [](FrameDesc& d) { d.seed = 7; }, "FrameDesc::seed"},
                           {"bumps", [](FrameDesc& d) { d.horizon = 0; }, "normal maps so strong"},
                           {"sphere", change_nothing, "punctual lights"}};
    for (const Refused& refused : all) {
        SCOPED_TRACE(refused.needle);
        Result<Scene> scene = make_builtin_scene(refused.scene);
        ASSERT_TRUE(scene);
        const Stage stage(std::move(*scene), 1.0f, 2);
        Result<std::unique_ptr<Renderer>> renderer = make_vulkan_renderer(stage.input(), *device);
        ASSERT_TRUE(renderer) << renderer.error().line();
        FrameDesc desc;
        desc.width = 32, desc.height = 24, desc.msaa = 1, desc.technique = "split_isotropic";
        desc.view = auto_frame(stage.tables, desc.width, desc.height);
        refused.change(desc);
        const Result<Frame> frame = (*renderer)->render(desc);
        ASSERT_FALSE(frame);
        EXPECT_EQ(frame.error().code, ExitCode::unavailable);
        EXPECT_NE(frame.error().line().find(refused.needle), std::string::npos) << frame.error().line();
    }
}

} // namespace
} // namespace burnish::test
