// The determinism promise: one picture, whatever runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>

#include "core/scene/builtin.h"
#include "core/scene/gltf.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

struct Case {
    const char* scene;
    int width, height, msaa;
    std::uint64_t golden; // the same on every machine and compiler; changes only with the picture
};
// To bless a changed picture: run the test, look at the picture, copy the printed hash. If a bake changed, raise kBakeVersion too.
constexpr Case kCases[] = {
    {"teapot", 317, 203, 8, 0x116af090deff6671ull},
    {"spheres", 256, 160, 4, 0x8fbc9e42643b6f64ull},
    {"plate", 200, 151, 1, 0xf78f34e3a45fcb76ull},
};

std::unique_ptr<Stage> stage_of(const Case& c, int threads)
{
    Result<Scene> scene = make_builtin_scene(c.scene);
    EXPECT_TRUE(scene);
    auto stage = std::make_unique<Stage>(std::move(*scene), 1.0f, threads);
    Result<Image> image = make_builtin_environment("studio");
    EXPECT_TRUE(image);
    EnvironmentOptions options;
    options.cube_size = 64;
    options.samples = 64;
    options.use_cache = false;
    Result<Environment> environment = bake_environment(*image, "studio", options, stage->jobs);
    EXPECT_TRUE(environment);
    stage->environment = std::move(*environment);
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
        std::printf("%s: %016llx\n", c.scene, static_cast<unsigned long long>(first));
        EXPECT_EQ(first, c.golden) << c.scene << ": the picture changed";
    }
}

TEST(hash, of_every_technique_is_the_same_for_every_isa_and_thread_count)
{
    const Case c = {"spheres", 144, 96, 4, 0};
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

struct TechniqueCase {
    const char* technique;
    std::uint64_t golden[3]; // teapot, spheres, plate; blessed as those above
};
constexpr TechniqueCase kTechniqueCases[] = {
    {"split_isotropic", {0x13dbb753d14b4987ull, 0x03612a086e50ab6dull, 0xc2d4b38a7eef6a58ull}},
    {"bent_normal", {0xe565b965fc199a2dull, 0x339caf49e466cea0ull, 0x77e8844bb29fdb0full}},
    {"major_axis", {0x7f4785b8b67b5e36ull, 0x764b0927e8075e1eull, 0x96b1ae6ee82b4f94ull}},
    {"major_axis_adaptive", {0x26901f03a29fc306ull, 0x431f9af03e5c36afull, 0x7435df656a93ca06ull}},
    {"major_axis_weighted", {0xda8245e9ad518812ull, 0x4ac13750e1c1bbe0ull, 0x5f18f3b5999e0dd0ull}},
    {"filtered_is", {0x7ff00f338dd1362aull, 0x192280497d6a398dull, 0xee79ecc668c4c8b6ull}},
    {"filtered_is_ggx", {0x4760b5a481f651d8ull, 0x9925a3cdcdc46778ull, 0x84e88abdb51bb3d3ull}},
    {"mc", {0x5202e7c8c34027e9ull, 0x22173c92683d06cdull, 0xcce5d62cc28354f7ull}},
};
// On the same spheres, what a technique does not do unless asked.
struct OptionCase {
    const char* name;
    void (*set)(FrameDesc& d);
    std::uint64_t golden;
};
constexpr OptionCase kOptionCases[] = {
    {"energy compensation", [](FrameDesc& d) { d.energy_compensation = true; }, 0x0d4e29929af01c43ull},
    {"tilt", [](FrameDesc& d) { d.tilt_rad = {0.3f, -0.2f}; }, 0xa2eff4168d4c3c6eull},
    {"fitted albedo", [](FrameDesc& d) { d.dfg_fit = true; }, 0xb2ea9b07fecaaf25ull},
};

TEST(hash, of_every_technique_is_golden)
{
    EXPECT_EQ(std::size(kTechniqueCases), techniques().size());
    const char* scenes[3] = {"teapot", "spheres", "plate"};
    for (int i = 0; i < 3; ++i) {
        const Case c = {scenes[i], 96, 64, 4, 0};
        const std::unique_ptr<Stage> stage = stage_of(c, 2);
        const auto expect_golden = [&](const FrameDesc& d, const char* name, std::uint64_t golden) {
            for (Isa isa : available_isas()) {
                const std::uint64_t hash = pixel_hash(stage->render(d, isa).color);
                EXPECT_EQ(hash, golden) << fmt::format("{} {} {}: the picture changed, to 0x{:016x}", name, c.scene, isa_name(isa), hash);
            }
        };
        for (const TechniqueCase& t : kTechniqueCases) {
            FrameDesc d = desc_of(c, *stage);
            d.technique = t.technique, d.samples = find_technique(t.technique)->default_samples;
            expect_golden(d, t.technique, t.golden[i]);
        }
        for (const OptionCase& o : kOptionCases) {
            if (i != 1)
                continue;
            FrameDesc d = desc_of(c, *stage);
            d.technique = "major_axis_weighted", d.samples = 16, d.roughness = 0.6f;
            o.set(d);
            expect_golden(d, o.name, o.golden);
        }
    }
}

TEST(hash, of_a_second_frame_equals_the_first)
{
    const std::unique_ptr<Stage> stage = stage_of(kCases[0], 2);
    const RenderInput input{stage->scene, stage->tables, stage->environment, stage->dfg, stage->jobs};
    const std::unique_ptr<Renderer> renderer = make_tile_renderer(input, best_isa());
    const FrameDesc small = desc_of(kCases[0], *stage);
    FrameDesc other = small;
    other.msaa = 2, other.width = 90;
    FrameDesc black = small; // of the same size
    black.background = false, black.view.eye.y += 0.1f;
    const Result<Frame> a = renderer->render(small), b = renderer->render(other);
    ASSERT_TRUE(a && b);
    for (const FrameDesc& before : {other, black}) { // memory with another picture in it
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
    for (const char* name : {"AnisotropyBarnLamp.glb", "FlightHelmet/FlightHelmet.gltf", "TextureTransformTest/TextureTransformTest.gltf",
                             "Lights.glb", "ClearCoatTest.glb"}) {
        Result<Scene> scene = load_gltf(std::string(BN_SHARED_DATA) + "/models/" + name, Limits{});
        if (!scene)
            GTEST_SKIP() << "no test data beside the checkout";
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
