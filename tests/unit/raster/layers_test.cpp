// An image's layers against the drawn scene, and the parts of pixels against the pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/scene/builtin/builtin.h"
#include "raster/frame/layers.h"
#include "raster/frame/upload.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr int kLayersSide = 64;

Scene brushed_plate()
{
    Scene scene = plate(1.0f);
    Material& m = scene.materials[0];
    m.roughness = 0.5f, m.anisotropy_strength = 0.8f, m.anisotropy_rotation = 0.5f;
    return scene;
}

FrameDesc plate_desc(int msaa)
{
    FrameDesc d;
    d.width = d.height = kLayersSide, d.msaa = msaa, d.layers = d.triangle_ids = true;
    d.view = make_view({0, 2, 2}, {0, 0, 0}, 0.9f, kLayersSide, kLayersSide);
    return d;
}

const PixelLayers& middle_of(const Frame& f)
{
    return f.layers[kLayersSide / 2 * kLayersSide + kLayersSide / 2];
}

TEST(layers, are_those_of_a_plate)
{
    const Stage stage(brushed_plate());
    for (int msaa : {1, 8}) {
        const FrameDesc d = plate_desc(msaa);
        const Frame f = stage.render(d, best_isa());
        int seen = 0;
        for (int y = 0; y < kLayersSide; ++y)
            for (int x = 0; x < kLayersSide; ++x) {
                const PixelLayers& p = f.layers[static_cast<std::size_t>(y * kLayersSide + x)];
                const auto central = static_cast<std::size_t>(central_sample(standard_samples(msaa)));
                const std::uint32_t id = f.triangle_ids[static_cast<std::size_t>((y * kLayersSide + x) * msaa) + central];
                if (id == kNoTriangle) {
                    EXPECT_EQ(p.depth, 0.0f);
                    EXPECT_EQ(p.normal[2], 0.0f);
                    continue;
                }
                ++seen;
                EXPECT_NEAR(p.normal[2], 1.0f, 1e-6f);
                EXPECT_NEAR(p.tangent[0], std::cos(0.5f), 1e-5f);
                EXPECT_NEAR(p.tangent[1], std::sin(0.5f), 1e-5f);
                EXPECT_FLOAT_EQ(p.albedo[1], 0.5f);
                EXPECT_NEAR(p.roughness, 0.7f, 1e-5f); // widths mix(.25, 1, .64) and .25
                const auto whole = [&](int s) { return f.triangle_ids[static_cast<std::size_t>((y * kLayersSide + x) * msaa + s)] == id; };
                bool centred = true; // shaded at the centre
                for (int s = 0; s < msaa; ++s)
                    centred = centred && whole(s);
                const float across = (static_cast<float>(x) + 0.5f) / (kLayersSide / 2) - 1.0f,
                            up = 1.0f - (static_cast<float>(y) + 0.5f) / (kLayersSide / 2);
                const glm::vec3 ray = d.view.forward + d.view.right * (across * d.view.tan_half_x) + d.view.up * (up * d.view.tan_half_y);
                if (centred) {
                    EXPECT_NEAR(p.depth, -2.0f / ray.z, 1e-4f) << x << " " << y; // the ray's length along the view is 1
                }
            }
        EXPECT_GT(seen, 400);
    }
}

TEST(layers, change_no_pixel_and_are_the_same_bits_everywhere)
{
    Scene scene = *make_builtin_scene("bumps");
    const Stage one(scene, 1.0f, 1), three(scene, 1.0f, 3);
    FrameDesc d;
    d.width = 150, d.height = 100, d.msaa = 4;
    d.view = auto_frame(one.tables, d.width, d.height);
    const Frame plain = one.render(d, best_isa());
    EXPECT_TRUE(plain.layers.empty() && plain.parts.empty());
    d.layers = d.parts = true;
    const Frame first = one.render(d, best_isa());
    EXPECT_EQ(pixel_hash(first.color), pixel_hash(plain.color));
    for (Isa isa : available_isas())
        for (int tile : {32, 64}) {
            d.tile_size = tile;
            const Frame other = three.render(d, isa);
            EXPECT_EQ(std::memcmp(other.layers.data(), first.layers.data(), first.layers.size() * sizeof(PixelLayers)), 0);
            ASSERT_EQ(other.parts.size(), first.parts.size());
            for (std::size_t i = 0; i < first.parts.size(); ++i) {
                EXPECT_EQ(other.parts[i].pixel, first.parts[i].pixel);
                EXPECT_EQ(other.parts[i].first, first.parts[i].first);
                EXPECT_EQ(other.parts[i].color, first.parts[i].color);
            }
        }
}

TEST(layers, stay_in_the_world_where_the_environment_is_turned)
{
    const Stage stage(brushed_plate());
    Frame frames[2];
    for (int i = 0; i < 2; ++i) {
        stage.environment.rotation_deg = i == 0 ? 0.0f : 70.0f;
        Result<Session> session = Session::make(stage.parts());
        ASSERT_TRUE(session);
        frames[i] = std::move(*session->render(plate_desc(4)));
    }
    stage.environment.rotation_deg = 0.0f;
    const PixelLayers &a = middle_of(frames[0]), &b = middle_of(frames[1]);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(a.normal[i], b.normal[i], 1e-5f);
        EXPECT_NEAR(a.tangent[i], b.tangent[i], 1e-5f);
    }
    EXPECT_NEAR(a.depth, b.depth, 1e-5f);
}

TEST(layers, wrong_requests_are_errors)
{
    const Stage stage(brushed_plate());
    FrameDesc d = plate_desc(4);
    EXPECT_EQ(ask_for_layers({"depth", "height"}, d).error().code, ExitCode::usage);
    const Frame f = stage.render(d, best_isa());
    const auto refused = [&](const Image& color, const std::vector<std::string>& names) {
        const Result<NamedChannels> c = with_layers(color, f, stage.tables, names);
        return !c && c.error().code == ExitCode::usage;
    };
    EXPECT_FALSE(refused(f.color, {"depth"}));
    EXPECT_TRUE(refused(f.color, {"height"}));
    EXPECT_TRUE(refused(make_image(4, 4, 3, PixelType::f32), {"depth"})) << "a picture of another size";
    EXPECT_TRUE(refused(make_image(f.color.width, f.color.height, 3, PixelType::u8), {"depth"}));
    EXPECT_TRUE(refused(make_image(f.color.width, f.color.height, 1, PixelType::f32), {"depth"}));
    Frame bare = f;
    bare.layers.clear();
    EXPECT_FALSE(with_layers(bare.color, bare, stage.tables, {"depth"})) << "a frame without layers";
}

TEST(layers, are_channels_with_numbers_that_count_from_one)
{
    const Stage stage(brushed_plate());
    const FrameDesc d = plate_desc(4);
    const Frame f = stage.render(d, best_isa());
    const NamedChannels c = *with_layers(f.color, f, stage.tables, {"material-id", "depth", "object-id"});
    EXPECT_EQ(c.names, (std::vector<std::string>{"R", "G", "B", "materialId", "Z", "id"}));
    const float *corner = c.image.f32(), *middle = c.image.f32() + 6 * (kLayersSide / 2 * kLayersSide + kLayersSide / 2);
    EXPECT_EQ(corner[3], 0.0f);
    EXPECT_TRUE(std::isinf(corner[4]));
    EXPECT_EQ(corner[5], 0.0f);
    EXPECT_EQ(middle[3], 1.0f);
    EXPECT_EQ(middle[4], middle_of(f).depth);
    EXPECT_EQ(middle[5], 1.0f);
    EXPECT_EQ(std::memcmp(middle, f.color.f32() + 3 * (kLayersSide / 2 * kLayersSide + kLayersSide / 2), 3 * sizeof(float)), 0);
}

TEST(parts, of_a_pixel_make_the_pixel)
{
    const Stage stage(*make_builtin_scene("spheres"));
    FrameDesc d;
    d.width = 90, d.height = 60, d.msaa = 8, d.parts = true, d.background = false;
    d.view = auto_frame(stage.tables, d.width, d.height);
    const Frame f = stage.render(d, best_isa());
    EXPECT_GT(f.parts.size(), 500u);
    for (std::size_t i = 0; i < f.parts.size();) {
        const std::uint32_t pixel = f.parts[i].pixel;
        int samples = 0, first = -1;
        std::array<float, 3> sum = {};
        for (; i < f.parts.size() && f.parts[i].pixel == pixel; ++i) {
            EXPECT_GT(f.parts[i].first, first);
            first = f.parts[i].first, samples += f.parts[i].samples;
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += f.parts[i].color[c] * static_cast<float>(f.parts[i].samples) / 8.0f;
            EXPECT_TRUE(!f.parts[i].background || f.parts[i].color[0] == 0.0f);
        }
        EXPECT_EQ(samples, 8);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c], f.color.f32()[3 * pixel + c], 1e-5f);
    }
}

} // namespace
} // namespace burnish::test
