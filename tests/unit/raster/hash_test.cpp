// Determinism: every instruction set and thread count draws the same image. The program's golden pictures are in tests/golden.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/builtin/builtin.h"
#include "core/scene/gltf/gltf.h"
#include "tests/unit/data.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

struct Case {
    const char* scene;
    int width, height, msaa;
};
constexpr Case kCases[] = {{"teapot", 317, 203, 8}, {"spheres", 256, 160, 4}, {"plate", 200, 151, 1}};

Environment bake_small_studio()
{
    Result<Image> image = make_builtin_environment("studio");
    EXPECT_TRUE(image);
    EnvironmentOptions options;
    options.cube_size = 64;
    options.samples = 64;
    options.use_cache = false;
    Result<Environment> baked = bake_environment(*image, "studio", options, Jobs(2));
    EXPECT_TRUE(baked);
    return std::move(*baked);
}

// Returns the small studio environment, baked once.
const Environment& studio()
{
    static const Environment environment = bake_small_studio();
    return environment;
}

std::unique_ptr<Stage> stage_of(const Case& c, int threads)
{
    Result<Scene> scene = make_builtin_scene(c.scene);
    EXPECT_TRUE(scene);
    auto stage = std::make_unique<Stage>(std::move(*scene), 1.0f, threads);
    stage->environment = studio();
    return stage;
}

FrameDesc desc_of(const Case& c, const Stage& stage)
{
    FrameDesc d;
    d.width = c.width, d.height = c.height, d.msaa = c.msaa;
    d.view = auto_frame(stage.tables, c.width, c.height);
    return d;
}

TEST(hash, is_the_same_for_every_isa_thread_count_and_tile_size)
{
    for (const Case& c : kCases) {
        std::uint64_t first = 0;
        for (int threads : {1, 2, 3, 8}) {
            const std::unique_ptr<Stage> stage = stage_of(c, threads);
            for (Isa isa : available_isas())
                for (int tile : {32, 64}) {
                    FrameDesc d = desc_of(c, *stage);
                    d.tile_size = tile;
                    const Frame f = stage->render(d, isa);
                    const std::uint64_t hash = pixel_hash(f.color);
                    EXPECT_EQ(count_not_finite(f.color), 0u);
                    EXPECT_GT(f.stats.visible_fragments, 1000u);
                    first = first ? first : hash;
                    EXPECT_EQ(hash, first) << c.scene << " threads " << threads << " " << isa_name(isa) << " tile " << tile;
                }
        }
    }
}

TEST(hash, of_every_technique_is_the_same_for_every_isa_and_thread_count)
{
    const Case c = {"spheres", 144, 96, 4};
    const std::unique_ptr<Stage> one = stage_of(c, 1), three = stage_of(c, 3);
    std::vector<std::uint64_t> seen;
    for (const TechniqueInfo& technique : techniques()) {
        FrameDesc d = desc_of(c, *one);
        d.technique = technique.name;
        d.samples = technique.default_samples;
        const Frame scalar = one->render(d, Isa::scalar);
        EXPECT_EQ(count_not_finite(scalar.color), 0u) << technique.name;
        const std::uint64_t hash = pixel_hash(scalar.color);
        for (Isa isa : available_isas())
            EXPECT_EQ(pixel_hash(three->render(d, isa).color), hash) << technique.name << " " << isa_name(isa);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), hash), 0) << technique.name << " gives another technique's picture";
        seen.push_back(hash);
        d.samples = 1;
        EXPECT_EQ(count_not_finite(one->render(d, best_isa()).color), 0u) << technique.name << " with one sample";
    }
}

// Options that change the usual image of the spheres.
struct OptionCase {
    const char* name;
    void (*set)(FrameDesc& d);
};
constexpr OptionCase kOptionCases[] = {
    {"energy compensation", [](FrameDesc& d) { d.energy_compensation = true; }},
    {"tilt",
     [](FrameDesc& d) {
         d.tilt_rad = {0.3f, -0.2f};
     }},
    {"separable masking",
     [](FrameDesc& d) {
         d.masking = 1;
         d.tilt_rad = {0.0f, -0.2f};
     }},
    {"fitted albedo", [](FrameDesc& d) { d.dfg_fit = true; }},
};

TEST(hash, of_every_option_is_the_same_for_every_isa)
{
    const Case c = {"spheres", 96, 64, 4};
    const std::unique_ptr<Stage> stage = stage_of(c, 2);
    for (const OptionCase& option : kOptionCases) {
        FrameDesc d = desc_of(c, *stage);
        d.technique = "major_axis_weighted", d.roughness = 0.6f;
        option.set(d);
        const std::uint64_t hash = pixel_hash(stage->render(d, Isa::scalar).color);
        for (Isa isa : available_isas())
            EXPECT_EQ(pixel_hash(stage->render(d, isa).color), hash) << option.name << " " << isa_name(isa);
    }
}

TEST(hash, of_a_second_frame_equals_the_first)
{
    const std::unique_ptr<Stage> stage = stage_of(kCases[0], 2);
    const RenderInput input = stage->input();
    const std::unique_ptr<Renderer> renderer = make_tile_renderer(input, best_isa());
    const FrameDesc small = desc_of(kCases[0], *stage);
    FrameDesc other = small;
    other.msaa = 2, other.width = 90;
    FrameDesc black = small; // of the same size
    black.background = false, black.view.eye.y += 0.1f;
    const Result<Frame> a = renderer->render(small), b = renderer->render(other);
    ASSERT_TRUE(a && b);
    for (const FrameDesc& before : {other, black}) { // memory that holds another picture
        Result<Frame> recycled = renderer->render(before);
        ASSERT_TRUE(recycled);
        ASSERT_NE(pixel_hash(a->color), pixel_hash(recycled->color));
        const Result<Frame> c = renderer->render(small, std::move(*recycled));
        ASSERT_TRUE(c);
        EXPECT_EQ(pixel_hash(a->color), pixel_hash(c->color));
    }
    EXPECT_NE(pixel_hash(a->color), pixel_hash(b->color));
}

TEST(hash, of_models_is_the_same_for_every_isa)
{
    for (const char* name : {"AnisotropyBarnLampSmall.glb", "FlightHelmetParts/FlightHelmetParts.gltf",
                             "TextureTransformTest/TextureTransformTest.gltf", "Lights.glb", "ClearCoatTest.glb"}) {
        Result<Scene> scene = load_gltf(data_file(std::string("models/") + name), Limits{});
        ASSERT_TRUE(scene) << scene.error().line();
        const Stage stage(std::move(*scene), 0.7f, 2);
        FrameDesc d;
        d.width = 240, d.height = 135, d.msaa = 4;
        d.view = auto_frame(stage.tables, d.width, d.height);
        const Frame scalar = stage.render(d, Isa::scalar);
        EXPECT_EQ(count_not_finite(scalar.color), 0u) << name;
        for (Isa isa : available_isas())
            EXPECT_EQ(pixel_hash(stage.render(d, isa).color), pixel_hash(scalar.color)) << name << " " << isa_name(isa);
    }
}

} // namespace
} // namespace burnish::test
