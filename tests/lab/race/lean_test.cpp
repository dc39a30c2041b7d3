// The lean shaders refuse what they do not draw, and light scenes as the tile renderer does. Skipped where lavapipe is missing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "apps/lab/race/race_report.h"
#include "core/scene/builtin/builtin.h"
#include "raster/vulkan/lab/lean.h"
#include "shading/lang/records.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

Result<std::shared_ptr<VulkanDevice>> lean_device()
{
    VulkanOptions options;
    options.device = "lavapipe", options.use_cache = false;
    options.pipeline = VulkanPipeline::forward, options.sampler = VulkanSampler::native;
    options.shaders = lean_shaders();
    return open_vulkan_device(options);
}

// Returns the mean absolute difference over the mean of `reference`.
double difference(const Image& reference, const Image& picture)
{
    const std::size_t values = static_cast<std::size_t>(reference.width * reference.height * reference.channels);
    double off = 0.0, all = 0.0;
    for (std::size_t i = 0; i < values; ++i) {
        off += static_cast<double>(std::abs(reference.f32()[i] - picture.f32()[i]));
        all += static_cast<double>(reference.f32()[i]);
    }
    return off / all;
}

struct Refused {
    const char* scene;
    void (*change)(FrameDesc&);
    const char* needle;
};

TEST(lean, refuses_what_it_does_not_draw)
{
    const Result<std::shared_ptr<VulkanDevice>> device = lean_device();
    if (!device)
        GTEST_SKIP() << device.error().line();
    const Refused all[] = {{"spheres", [](FrameDesc& d) { d.tilt_rad = glm::vec2(0.2f, 0.0f); }, "FrameDesc::tilt"},
                           {"spheres", [](FrameDesc& d) { d.fresnel = 1; }, "FrameDesc::fresnel"},
                           {"spheres", [](FrameDesc& d) { d.seed = 7; }, "FrameDesc::seed"},
                           {"bumps", [](FrameDesc& d) { d.horizon = 0; }, "normal maps so strong"},
                           {"cloth", [](FrameDesc& d) { d.horizon = 0; }, "does not draw sheen"},
                           {"lights", [](FrameDesc& d) { d.area_way = kAreaWay_mc; }, "FrameDesc::area_way"}};
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

// Area lights of each shape by filtered textures, and a lamp, on anisotropic and round lobes.
TEST(lean, lights_as_the_tile_renderer_does)
{
    const Result<std::shared_ptr<VulkanDevice>> device = lean_device();
    if (!device)
        GTEST_SKIP() << device.error().line();
    struct Drawn {
        const char* scene;
        const char* technique;
        double most; // difference, of the mean
    };
    for (const Drawn& drawn :
         {Drawn{"lights", "lobe_line", 0.001}, Drawn{"lights", "split_isotropic", 0.001}, Drawn{"spheres", "lobe_line", 0.02}}) {
        SCOPED_TRACE(drawn.scene);
        Result<Scene> scene = make_builtin_scene(drawn.scene);
        ASSERT_TRUE(scene);
        add_lamp(*scene, glm::vec3(0.4f, 1.3f, 0.8f), 3.0f);
        const Stage stage(std::move(*scene), 0.0f, 2);
        Result<std::unique_ptr<Renderer>> renderer = make_vulkan_renderer(stage.input(), *device);
        ASSERT_TRUE(renderer) << renderer.error().line();
        FrameDesc desc;
        desc.width = 160, desc.height = 100, desc.msaa = 1, desc.technique = drawn.technique;
        desc.view = auto_frame(stage.tables, desc.width, desc.height);
        const Result<Frame> frame = (*renderer)->render(desc);
        ASSERT_TRUE(frame) << frame.error().line();
        EXPECT_LT(difference(stage.render(desc, best_isa()).color, frame->color), drawn.most);
    }
}

// Strong normal maps by their levels alone, which the settings of mip filters ask for.
TEST(lean, draws_strong_normal_maps_without_facets)
{
    const Result<std::shared_ptr<VulkanDevice>> device = lean_device();
    if (!device)
        GTEST_SKIP() << device.error().line();
    Result<Scene> scene = make_builtin_scene("bumps");
    ASSERT_TRUE(scene);
    add_lamp(*scene, glm::vec3(0.4f, 1.3f, 0.8f), 3.0f);
    const Stage stage(std::move(*scene), 1.0f, 2);
    MipSettings settings;
    settings.facets = false;
    stage.mips = asked_mips(settings, stage.scene.materials.size());
    Result<std::unique_ptr<Renderer>> renderer = make_vulkan_renderer(stage.input(), *device);
    ASSERT_TRUE(renderer) << renderer.error().line();
    FrameDesc desc;
    desc.width = 64, desc.height = 48, desc.msaa = 1, desc.technique = "split_isotropic", desc.horizon = 0;
    desc.view = auto_frame(stage.tables, desc.width, desc.height);
    const Result<Frame> frame = (*renderer)->render(desc);
    ASSERT_TRUE(frame) << frame.error().line();
    RaceRow row;
    compare_pictures(stage.render(desc, best_isa()).color, frame->color, {}, stage.jobs, row);
    EXPECT_LT(row.flip_mean, kMaxWholeFlip);
}

// Returns a normal map whose normals lean to two sides in turn.
Image waves()
{
    Image map = make_image(8, 8, 3, PixelType::u8);
    for (std::size_t i = 0; i < map.bytes.size(); i += 3) {
        map.bytes[i] = i / 3 % 8 < 4 ? std::byte{150} : std::byte{106};
        map.bytes[i + 1] = std::byte{128}, map.bytes[i + 2] = std::byte{250};
    }
    return map;
}

// Puts a rough coat over each material, about normals of its own.
void coat_all(Scene& scene)
{
    Texture texture;
    texture.image = static_cast<std::int32_t>(scene.images.size());
    scene.images.push_back(waves());
    scene.textures.push_back(texture);
    for (Material& m : scene.materials) {
        m.clearcoat = 0.8f, m.clearcoat_roughness = 0.3f;
        m.clearcoat_normal_tex.texture = static_cast<std::int32_t>(scene.textures.size() - 1);
    }
}

// Clear coats under an environment and lamps, and under area lights alone.
TEST(lean, coats_as_the_tile_renderer_does)
{
    const Result<std::shared_ptr<VulkanDevice>> device = lean_device();
    if (!device)
        GTEST_SKIP() << device.error().line();
    struct Coated {
        const char* scene;
        const char* technique;
        float sky; // radiance
        bool all;  // its materials get coats
    };
    for (const Coated& coated : {Coated{"lacquer", "split_isotropic", 1.0f, false}, Coated{"lacquer", "major_axis", 0.0f, false},
                                 Coated{"spheres", "split_isotropic", 1.0f, true}, Coated{"lights", "split_isotropic", 0.0f, true}}) {
        SCOPED_TRACE(coated.scene);
        Result<Scene> scene = make_builtin_scene(coated.scene);
        ASSERT_TRUE(scene);
        add_lamp(*scene, glm::vec3(0.4f, 1.3f, 0.8f), 3.0f);
        if (coated.all)
            coat_all(*scene);
        const Stage stage(std::move(*scene), coated.sky, 2);
        Result<std::unique_ptr<Renderer>> renderer = make_vulkan_renderer(stage.input(), *device);
        ASSERT_TRUE(renderer) << renderer.error().line();
        FrameDesc desc;
        desc.width = 64, desc.height = 48, desc.msaa = 1, desc.technique = coated.technique, desc.horizon = 0;
        desc.view = auto_frame(stage.tables, desc.width, desc.height);
        const Result<Frame> frame = (*renderer)->render(desc);
        ASSERT_TRUE(frame) << frame.error().line();
        RaceRow row;
        compare_pictures(stage.render(desc, best_isa()).color, frame->color, {}, stage.jobs, row);
        EXPECT_LT(row.flip_mean, kMaxRaceFlip);
    }
}

} // namespace
} // namespace burnish::test
