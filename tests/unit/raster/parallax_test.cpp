// Parallax: rays meet height maps at known points, on planes with any mapping of texture coordinates.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/height_map.h"
#include "raster/frame/frame_record.h"
#include "shading/surface/parallax.t.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr float kDepth = 0.2f; // in texture coordinates

// Returns a plane of one triangle whose heights are one texel row.
Scene plane_of(const std::vector<int>& heights)
{
    Scene s = scene_of({Triangle{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}}, true);
    Texture t;
    t.image = 0, t.wrap_s = t.wrap_t = WrapMode::clamp;
    s.images.push_back(make_image(static_cast<int>(heights.size()), 1, 1, PixelType::u8));
    for (std::size_t i = 0; i < heights.size(); ++i)
        s.images[0].bytes[i] = static_cast<std::byte>(heights[i]);
    s.textures.push_back(t);
    s.materials[0].height_tex.texture = 0;
    s.materials[0].height_scale = kDepth;
    EXPECT_TRUE(pack_height_maps(s, Limits(), ""));
    EXPECT_TRUE(s.materials[0].has_height_map);
    return s;
}

struct Plane { // place = u * along_u + v * along_v
    glm::vec3 along_u, along_v;
};

struct Moved {
    glm::vec2 uv;
    visible_point p;
};

// v: direction to the eye, any length, as (u, negative bitangent, normal) on a plane whose tangent is along_u.
Moved moved(const Stage& stage, const Plane& plane, const glm::vec3& v, const glm::vec2& from, int metric, float scale = 1.0f)
{
    FrameDesc desc;
    desc.width = desc.height = 8;
    desc.view = make_view({0, 0, 2}, {0, 0, 0}, 0.4f, 8, 8);
    desc.pom_metric = metric, desc.height_scale = scale;
    FrameMaker maker(stage.input());
    const ShadingFrame f = maker.make(desc);
    const auto real3_of = [](const glm::vec3& a) { return real3{a.x, a.y, a.z}; };
    const glm::vec3 n = glm::normalize(glm::cross(plane.along_v, plane.along_u)); // v points down where the bitangent points up
    visible_point p = {};
    p.normal = real3_of(n), p.tangent = real3_of(plane.along_u), p.tangent_sign = 1.0f, p.front = true;
    p.ray = real3_of(-v);
    p.uv0 = {from.x, from.y};
    p.uv0_dx = {0.01f, 0.0f}, p.uv0_dy = {0.0f, 0.02f};
    parallax_plane of = {};
    of.along = real3_of(plane.along_u * 0.3f + plane.along_v * 0.1f), of.across = real3_of(plane.along_v * 0.7f - plane.along_u * 0.2f);
    of.coordinates_along = {0.3f, 0.1f, 0.0f, 0.0f}, of.coordinates_across = {-0.2f, 0.7f, 0.0f, 0.0f};
    if (f.materials[0].parallax)
        apply_parallax(f, f.materials[0], of, p);
    return {{p.uv0.x, p.uv0.y}, p};
}

// Returns the depth that shading reads: 0 at the surface, 1 at the deepest place. parallax.of_height_one_is_the_surface alone tells depth
// from height.
double depth_read(const Stage& stage, float u)
{
    FrameDesc desc;
    desc.width = desc.height = 8;
    desc.view = make_view({0, 0, 2}, {0, 0, 0}, 0.4f, 8, 8);
    FrameMaker maker(stage.input());
    const ShadingFrame f = maker.make(desc);
    const texture_desc map = texture_desc_of(f, f.materials[0], kNormalTex);
    const texture_one_level level = texture_one_level_of(map, texture_footprint_of(map, {0.01f, 0.0f}, {0.0f, 0.02f}, f.texture_taps));
    return static_cast<double>(depth_in_map(level, {u, 0.5f}));
}
int code_of_surface()
{
    return depth_read(Stage(plane_of({255, 255})), 0.5f) < 0.5 ? 255 : 0;
}

// Returns where a ray from `from` reaches depth d (in texture coordinates), in double precision.
glm::dvec2 expected(const Plane& plane, const glm::dvec3& v, const glm::dvec2& from, double d)
{
    const glm::dvec3 u = plane.along_u, w = plane.along_v, n = glm::normalize(glm::cross(w, u));
    const double metres = d * std::sqrt(glm::length(glm::cross(u, w)));
    const glm::dvec3 unit = glm::normalize(v), along = (n * glm::dot(n, unit) - unit) * (metres / glm::dot(n, unit));
    const double a = glm::dot(u, u), b = glm::dot(u, w), c = glm::dot(w, w), det = a * c - b * b;
    const double x = glm::dot(u, along), y = glm::dot(w, along);
    return from + glm::dvec2(c * x - b * y, a * y - b * x) / det;
}

const Plane kEven = {{1, 0, 0}, {0, -1, 0}}, kStretched = {{1, 0, 0}, {0, -3, 0}}, kSkewed = {{0.7f, 0.1f, 0.2f}, {0.3f, -1.1f, 0.4f}};
const glm::vec3 kViews[] = {{0.3f, 0.4f, 0.8660254f}, {-0.7f, 0.2f, 0.5f}, {0.0f, -0.8f, 0.3f}, {0.0f, 0.0f, 1.0f}};

TEST(parallax, of_height_one_is_the_surface)
{
    const Stage stage(plane_of({255, 51, 0, 0}));
    EXPECT_EQ(depth_read(stage, 0.125f), 0.0);
    EXPECT_NEAR(depth_read(stage, 0.375f), 0.8, 1e-3);
    EXPECT_EQ(depth_read(stage, 0.875f), 1.0);
    EXPECT_EQ(moved(stage, kEven, {0.5f, 0.2f, 1.0f}, {0.1f, 0.5f}, kParallaxOnSurface).uv, glm::vec2(0.1f, 0.5f));
}

TEST(parallax, of_one_depth_moves_by_it_however_a_plane_is_stretched)
{
    for (const int height : {0, 51, 204}) { // of 255
        const Stage stage(plane_of({height, height}));
        const double depth = depth_read(stage, 0.4f) * static_cast<double>(kDepth);
        for (const Plane& plane : {kEven, kStretched})
            for (const glm::vec3& v : kViews) {
                const glm::vec2 from(0.4f, 0.6f);
                const Moved on = moved(stage, plane, v, from, kParallaxOnSurface), in = moved(stage, plane, v, from, kParallaxInTexture);
                const glm::dvec2 right = expected(plane, v, from, depth);
                EXPECT_LT(glm::length(glm::dvec2(on.uv) - right), 1e-5) << height;
                const double off = glm::length(glm::dvec2(in.uv) - right), way = glm::length(right - glm::dvec2(from));
                if (plane.along_v == kEven.along_v) {
                    EXPECT_LT(off, 1e-5);
                } else if (way > 1e-6) {
                    EXPECT_GT(off, 0.4 * way); // off by a root of 3 along each axis
                }
                EXPECT_EQ(on.p.uv0_dx.x, 0.01f);
                EXPECT_EQ(on.p.uv0_dy.y, 0.02f);
            }
    }
}

TEST(parallax, knows_skewed_coordinates)
{
    const int deepest = 255 - code_of_surface();
    const Stage stage(plane_of({deepest, deepest}));
    const glm::vec3 n = glm::normalize(glm::cross(kSkewed.along_v, kSkewed.along_u));
    for (const glm::vec3& lean : {glm::vec3(0.3f, 0.1f, 0.0f), glm::vec3(-0.5f, 0.4f, 0.2f), glm::vec3(0.1f, -0.6f, -0.3f)}) {
        const glm::vec3 v = n + lean;
        const glm::dvec2 right = expected(kSkewed, v, {0.2, 0.3}, depth_read(stage, 0.2f) * static_cast<double>(kDepth));
        EXPECT_LT(glm::length(glm::dvec2(moved(stage, kSkewed, v, {0.2f, 0.3f}, kParallaxOnSurface).uv) - right), 1e-5);
    }
}

// Between two texels heights form a ramp. A ray meets the ramp where two lines cross.
TEST(parallax, of_a_ramp_is_met_where_lines_cross)
{
    const int surface = code_of_surface();
    const Stage stage(plane_of({surface, 255 - surface})); // depth goes from 0 at u = 1/4 to 1 at u = 3/4
    for (const float slope : {0.2f, -0.6f, 1.5f}) {
        const glm::vec3 v(slope, 0.0f, 1.0f);
        const double way = -static_cast<double>(slope) * static_cast<double>(kDepth); // change of u down to the deepest place
        const double from = 0.5;
        const double met = (from - 0.25) * 2.0 / (1.0 - 2.0 * way); // depth(u + way s) = s
        const Moved at = moved(stage, kEven, v, {0.5f, 0.5f}, kParallaxOnSurface);
        EXPECT_NEAR(static_cast<double>(at.uv.x), from + way * met, 2e-4) << slope; // heights are halves
        EXPECT_NEAR(static_cast<double>(at.uv.y), 0.5, 1e-6);
    }
    EXPECT_EQ(moved(stage, kEven, {0.5f, 0.2f, 1.0f}, {0.6f, 0.5f}, kParallaxOnSurface, 0.0f).uv, glm::vec2(0.6f, 0.5f)); // no depth
}

// A ridge hides the ground behind it, at every angle of the ray.
TEST(parallax, hides_what_lies_behind)
{
    const int surface = code_of_surface();
    std::vector<int> heights(64, 255 - surface);
    for (int i = 24; i < 32; ++i)
        heights[static_cast<std::size_t>(i)] = surface;
    const Stage stage(plane_of(heights)); // a ridge from u = .375 to .5, level with the surface
    for (const float slope : {1.0f, 2.0f, 3.0f}) {
        const glm::vec2 at = moved(stage, kEven, {slope, 0.0f, 1.0f}, {0.55f, 0.5f}, kParallaxOnSurface).uv;
        const float step = slope * kDepth / kLeastParallaxSteps;
        EXPECT_GT(at.x, 0.5f - step) << slope; // the ridge, within a step, and not the ground beyond
        EXPECT_LT(at.x, 0.52f);
    }
}

} // namespace
} // namespace burnish::test
