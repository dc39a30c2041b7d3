// Strong normal maps from afar: a far plate's mean light by each mip filter, against the mean over its map's texels.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "core/scene/builtin/builtin.h"
#include "raster/frame/frame_record.h"
#include "raster/frame/lane_material.h"
#include "shading/bake/mip/filter.h"
#include "shading/lights/fragment_light.t.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr int kSide = 64;                                                // texels
constexpr float kEyes[][3] = {{0.0f, 1.73f, 1.0f}, {0.7f, 1.0f, 1.58f}}; // 60 and 30 degrees over the plate

using SlopeAt = std::function<glm::dvec2(double u, double v)>;

double part_of(double x)
{
    return x - std::floor(x);
}

// Returns the slope of bowls around scattered points, which meet in ridges.
glm::dvec2 hammered(double u, double v)
{
    constexpr int kCells = 4;
    const auto chance = [](int x, int y, unsigned salt) {
        unsigned h = static_cast<unsigned>(x) * 374761393u + static_cast<unsigned>(y) * 668265263u + salt * 2246822519u;
        h = (h ^ (h >> 13)) * 1274126177u;
        return static_cast<double>(h ^ (h >> 16)) / 4294967296.0;
    };
    glm::dvec2 slope(0.0);
    double nearest = 9.0;
    for (int cy = -1; cy <= kCells; ++cy)
        for (int cx = -1; cx <= kCells; ++cx) {
            const int x = (cx + kCells) % kCells, y = (cy + kCells) % kCells;
            const glm::dvec2 to(u * kCells - (cx + 0.15 + 0.7 * chance(x, y, 1)), v * kCells - (cy + 0.15 + 0.7 * chance(x, y, 2)));
            if (const double squared = to.x * to.x + to.y * to.y; squared < nearest)
                nearest = squared, slope = to * 1.6;
        }
    return slope;
}

// Returns the slope of diamond-shaped pyramids, which have four slopes.
glm::dvec2 knurled(double u, double v)
{
    const double a = part_of((u + v) * 4.0) < 0.5 ? 0.4 : -0.4, b = part_of((u - v) * 4.0) < 0.5 ? 0.4 : -0.4;
    return {a + b, b - a};
}

// Returns the slope of a plain weave with round threads.
glm::dvec2 woven(double u, double v)
{
    const bool along = (static_cast<int>(u * 4.0) + static_cast<int>(v * 4.0)) % 2 == 0;
    const double across = 2.0 * part_of((along ? v : u) * 4.0) - 1.0;
    return along ? glm::dvec2(0.0, across) : glm::dvec2(-across, 0.0);
}

// Returns the slope of grooves along u, some of them deep.
glm::dvec2 scratched(double, double v)
{
    const double deep = 0.15 * static_cast<double>(static_cast<int>(v * 8.0) % 4);
    return {0.0, -3.0 * deep * (2.0 * part_of(v * 8.0) - 1.0)};
}

Image normal_map(const SlopeAt& slope)
{
    Image map = make_image(kSide, kSide, 3, PixelType::f32);
    float* to = map.f32();
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const glm::dvec2 s = slope((x + 0.5) / kSide, (y + 0.5) / kSide);
            const glm::dvec3 n = glm::normalize(glm::dvec3(-s.x, -s.y, 1.0));
            for (int c = 0; c < 3; ++c)
                *to++ = static_cast<float>(0.5 + 0.5 * n[c]);
        }
    return map;
}

Scene far_plate(const SlopeAt& slope)
{
    Scene s = plate(1.0f);
    Material& m = s.materials[0];
    m.base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f), m.roughness = 0.3f;
    Texture t;
    t.image = 0;
    s.images.push_back(normal_map(slope));
    s.textures.push_back(t);
    m.normal_tex.texture = 0;
    return s;
}

// Returns the mean radiance of points all over the map, by `mc`. footprint: pixel size in lengths of the map.
double mean_light(const ShadingFrame& f, const float* to_eye, float footprint, int points)
{
    const MaterialRecord& m = f.materials[0];
    visible_point p = {};
    p.normal = {0, 1, 0}, p.tangent = {1, 0, 0}, p.tangent_sign = 1.0f, p.front = true, p.color = {1, 1, 1, 1};
    p.ray = {-to_eye[0], -to_eye[1], -to_eye[2]};
    p.uv0_dx = {footprint, 0.0f}, p.uv0_dy = {0.0f, footprint};
    double sum = 0.0, u = 0.5, v = 0.5;
    for (int i = 0; i < points; ++i) {
        u = part_of(u + 0.7548776662466927), v = part_of(v + 0.5698402909980532);
        p.uv0 = {static_cast<float>(u), static_cast<float>(v)};
        const material_inputs at = fetch_lanes(f, m, p);
        const shared_sample_record r =
            light_of_fragment(f, m, technique_tag<Technique::mc>{}, at, lobe_shape_of(f, m, at), p, int_lit(i % 8), int_lit(i / 8), false);
        sum += static_cast<double>(r.rest.x + r.rest.y + r.rest.z) / 3.0 / points;
    }
    return sum;
}

FrameDesc desc_of(bool horizon)
{
    FrameDesc d;
    d.width = d.height = 8;
    d.view = make_view({0, 2, 2}, {0, 0, 0}, 0.4f, 8, 8);
    d.technique = "mc", d.samples = 16, d.background = false, d.frame_map = kFrameQuaternion, d.horizon = horizon;
    return d;
}

// Returns the largest relative error of the light over filters and eyes.
double worst_of(const SlopeAt& slope, bool horizon, const Environment* environment)
{
    double reference[std::size(kEyes)] = {}, worst = 0.0;
    for (int filter = -1; filter < static_cast<int>(mip_filters().size()); ++filter) {
        const MipFilter mip = static_cast<MipFilter>(std::max(filter, 0));
        if (mip == kMipFilter_teacher)
            continue;
        Stage stage(far_plate(slope));
        MipSettings settings;
        settings.filter = mip, settings.kappa = 0.7f;
        stage.mips = asked_mips(settings, 1);
        if (environment)
            stage.environment = *environment;
        FrameMaker maker(stage.input());
        const ShadingFrame f = maker.make(desc_of(horizon));
        for (std::size_t eye = 0; eye < std::size(kEyes); ++eye) {
            if (filter < 0) {
                reference[eye] = mean_light(f, kEyes[eye], 1e-6f, 4096);
                continue;
            }
            const double off = mean_light(f, kEyes[eye], 4.0f, 32) / reference[eye] - 1.0;
            worst = std::max(worst, std::abs(off));
        }
    }
    return worst;
}

TEST(far_normals, keep_constant_light_by_every_filter)
{
    const SlopeAt kinds[] = {hammered, knurled, woven, scratched};
    for (const SlopeAt& kind : kinds)
        for (const bool horizon : {false, true}) {
            const double worst = worst_of(kind, horizon, nullptr);
            std::printf("kind %d, horizon %d: off by %.3f\n", static_cast<int>(&kind - kinds), horizon, worst);
            EXPECT_LT(worst, 0.04) << &kind - kinds << " " << horizon;
        }
}

TEST(far_normals, send_light_where_their_texels_do)
{
    EnvironmentOptions options;
    options.cube_size = 64, options.samples = 128, options.use_cache = false;
    const Environment studio = *bake_environment(*make_builtin_environment("studio"), "studio", options, Jobs(1));
    const SlopeAt kinds[] = {hammered, knurled, woven, scratched};
    for (const SlopeAt& kind : kinds) {
        const double worst = worst_of(kind, true, &studio);
        std::printf("kind %d: off by %.3f\n", static_cast<int>(&kind - kinds), worst);
        EXPECT_LT(worst, 0.12) << &kind - kinds;
    }
}

} // namespace
} // namespace burnish::test
