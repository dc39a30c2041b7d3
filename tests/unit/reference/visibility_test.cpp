// Two independent visibility tests: the tile renderer's integer edge functions and Embree's rays, at equal sample positions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "core/scene/builtin/builtin.h"
#include "raster/frame/frame_record.h"
#include "shading/kernels/camera.t.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the distance in pixels from a sample to a triangle's nearest edge on the screen; infinite for a triangle behind the eye.
double distance_to_edges(const DrawTables& t, const View& v, int width, int height, std::uint32_t triangle, glm::dvec2 sample)
{
    glm::dvec2 p[3];
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t i = t.indices[3 * triangle + static_cast<std::uint32_t>(k)];
        const glm::dvec3 d = glm::dvec3(t.px[i], t.py[i], t.pz[i]) - glm::dvec3(v.eye);
        const double w = glm::dot(glm::dvec3(v.forward), d);
        if (w <= 0.0)
            return kInfinity;
        p[k] = {(glm::dot(glm::dvec3(v.right), d) / w / static_cast<double>(v.tan_half_x) + 1.0) * 0.5 * width,
                (1.0 - glm::dot(glm::dvec3(v.up), d) / w / static_cast<double>(v.tan_half_y)) * 0.5 * height};
    }
    double nearest = kInfinity;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 a = p[k], b = p[(k + 1) % 3], ab = b - a;
        const double length2 = glm::dot(ab, ab);
        const double s = length2 > 0.0 ? std::min(std::max(glm::dot(sample - a, ab) / length2, 0.0), 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(sample - a - ab * s));
    }
    return nearest;
}

struct Count {
    std::size_t samples = 0, covered = 0;
    std::size_t silhouettes = 0;     // one of the two sees nothing
    std::size_t far_silhouettes = 0; // and no edge is near
    std::size_t triangles = 0;       // both see a triangle, but different ones
    std::size_t far_triangles = 0;   // and no edge of either triangle is near
    double farthest_px = 0.0;        // largest distance to an edge, over differing samples
};

// The rasterizer snaps vertices to a grid of 1/256 pixel. Each vertex, and with it each edge, moves by up to 1/512 along either axis.
constexpr double kSnapped = 1.0 / 128.0; // pixels

// Returns the tables with every vertex at its grid position, as the vertex kernel finds it, at an unchanged distance from the eye's plane.
// Rays then meet the triangles that the edge functions see.
DrawTables on_the_grid(DrawTables t, const FrameDesc& d)
{
    const ViewRecord v = view_record(d.view);
    const view_params view = view_params_of(v);
    const glm::dvec3 eye(d.view.eye), right(d.view.right), up(d.view.up), forward(d.view.forward);
    const float half_x = 0.5f * static_cast<float>(d.width), half_y = 0.5f * static_cast<float>(d.height);
    const int centre_x = d.width / 2 * kSubpixel, centre_y = d.height / 2 * kSubpixel;
    for (std::size_t i = 0; i < t.px.size(); ++i) {
        const real4 clip = clip_position(vec3_of(t.px[i], t.py[i], t.pz[i]), view);
        const snapped_vertex s = snap_vertex(clip, view, half_x, half_y, static_cast<float>(centre_x), static_cast<float>(centre_y),
                                             int_lit(centre_x), int_lit(centre_y), 1e6f);
        EXPECT_TRUE(s.valid);
        const double depth = static_cast<double>(clip.z); // the kernel's order: (x, y, w, z)
        const double x = (s.x + centre_x) / 256.0 / static_cast<double>(half_x) - 1.0,
                     y = 1.0 - (s.y + centre_y) / 256.0 / static_cast<double>(half_y);
        const glm::dvec3 p =
            eye + depth * (forward + x / static_cast<double>(v.inv_tan_x) * right + y / static_cast<double>(v.inv_tan_y) * up);
        t.px[i] = static_cast<float>(p.x), t.py[i] = static_cast<float>(p.y), t.pz[i] = static_cast<float>(p.z);
    }
    return t;
}

enum class Vertices { as_given, on_the_grid }; // of the triangles that rays meet

Count compare_ids(const char* name, Vertices vertices, int width, int height, int msaa)
{
    Result<Scene> scene = make_builtin_scene(name);
    EXPECT_TRUE(scene);
    update_world(*scene);
    Stage stage(std::move(*scene), 1.0f, 2);
    FrameDesc d = desc_of(width, height, auto_frame(stage.tables, width, height));
    d.msaa = msaa;
    d.triangle_ids = true;
    const Frame raster = stage.render(d, best_isa());
    ReferenceOptions options;
    options.samples = 1;
    if (vertices == Vertices::on_the_grid)
        stage.tables = on_the_grid(stage.tables, d);
    const Frame rays = render_reference(stage, d, options);
    const SamplePattern pattern = standard_samples(msaa);
    Count c;
    c.samples = raster.triangle_ids.size();
    EXPECT_EQ(c.samples, rays.triangle_ids.size());
    for (std::size_t i = 0; i < c.samples; ++i) {
        const std::uint32_t a = raster.triangle_ids[i], b = rays.triangle_ids[i];
        c.covered += a != kNoTriangle;
        if (a == b)
            continue;
        const std::size_t pixel = i / static_cast<std::size_t>(msaa), s = i % static_cast<std::size_t>(msaa);
        const glm::dvec2 at(static_cast<double>(pixel % static_cast<std::size_t>(width)) + pattern.x[s] / 256.0,
                            static_cast<double>(pixel / static_cast<std::size_t>(width)) + pattern.y[s] / 256.0);
        double edge = kInfinity;
        for (std::uint32_t id : {a, b})
            if (id != kNoTriangle)
                edge = std::min(edge, distance_to_edges(stage.tables, d.view, width, height, id, at));
        const bool far = edge > kSnapped;
        c.farthest_px = std::max(c.farthest_px, edge);
        if (a == kNoTriangle || b == kNoTriangle) {
            ++c.silhouettes;
            c.far_silhouettes += far;
        } else {
            ++c.triangles;
            c.far_triangles += far;
        }
    }
    const auto in_100000 = [&](std::size_t n) { return static_cast<double>(n) / static_cast<double>(c.samples) * 1e5; };
    std::printf(
        "%s %dx%d, %d samples a pixel, rays meet vertices %s: of %zu samples %zu are covered; %zu silhouette samples differ (%.3f in "
        "100000), %zu of them farther than 1/128 pixel from an edge; %zu show another triangle (%.3f in 100000), %zu of them farther; "
        "farthest from an edge: %.2g pixel\n",
        name, width, height, msaa, vertices == Vertices::as_given ? "as given" : "on the rasterizer's grid", c.samples, c.covered,
        c.silhouettes, in_100000(c.silhouettes), c.far_silhouettes, c.triangles, in_100000(c.triangles), c.far_triangles, c.farthest_px);
    return c;
}

class visibility : public testing::TestWithParam<const char*> {};

TEST_P(visibility, by_rays_and_by_rasterization_agree_but_for_one_sample_in_100000)
{
    BN_NEEDS_EMBREE();
    const Count c = compare_ids(GetParam(), Vertices::on_the_grid, 640, 480, 8);
    EXPECT_GT(c.covered, c.samples / 8);
    EXPECT_LE(static_cast<double>(c.silhouettes), static_cast<double>(c.samples) * 1e-5);
    // Samples on a grid edge belong to either side: by the top-left rule, or to Embree's first hit.
    EXPECT_LE(static_cast<double>(c.triangles), static_cast<double>(c.covered) * 1e-4);
    EXPECT_LT(c.farthest_px, 1e-3);
}

// Rays use the given vertices, and the rasterizer uses snapped ones. The snapping alone explains the differences.
TEST_P(visibility, differs_elsewhere_only_by_the_grid_of_the_rasterizer)
{
    BN_NEEDS_EMBREE();
    const Count c = compare_ids(GetParam(), Vertices::as_given, 640, 480, 8);
    EXPECT_LE(static_cast<double>(c.far_silhouettes + c.far_triangles), static_cast<double>(c.samples) * 1e-5);
    EXPECT_LE(static_cast<double>(c.silhouettes), static_cast<double>(c.samples) * 3e-5);
    EXPECT_LE(static_cast<double>(c.triangles), static_cast<double>(c.covered) * 2e-3);
}

INSTANTIATE_TEST_SUITE_P(of, visibility, testing::Values("teapot", "spheres", "plate"),
                         [](const auto& name) { return std::string(name.param); });

// Rays need no clipping: a floor of 10 to 400 km, cut by the near plane and the guard band, ends where the rays' floor ends.
TEST(visibility_of_large_floors, by_rays_and_by_rasterization_is_the_same)
{
    BN_NEEDS_EMBREE();
    for (const float half : {5e3f, 5e4f, 1e5f, 2e5f})
        for (const float pitch : {0.15f, 0.9f}) {
            Stage stage(scene_of({{glm::vec3(-half, 0, half), glm::vec3(half, 0, half), glm::vec3(half, 0, -half)},
                                  {glm::vec3(-half, 0, half), glm::vec3(half, 0, -half), glm::vec3(-half, 0, -half)}},
                                 true));
            FrameDesc d = desc_of(160, 90, make_view(glm::vec3(0, 1.7f, 0), glm::vec3(0, 1.7f - std::tan(pitch), -1), 0.7f, 160, 90));
            d.view.znear = 0.01f, d.msaa = 4, d.triangle_ids = true;
            const Frame raster = stage.render(d, best_isa());
            ReferenceOptions options;
            options.samples = 1;
            const Frame rays = render_reference(stage, d, options);
            const double horizon_px = 45.0 - std::tan(static_cast<double>(pitch)) / std::tan(0.35) * 45.0; // from the top
            const SamplePattern pattern = standard_samples(d.msaa);
            std::size_t covered = 0, far = 0;
            for (std::size_t i = 0; i < raster.triangle_ids.size(); ++i) {
                const bool by_raster = raster.triangle_ids[i] != kNoTriangle, by_rays = rays.triangle_ids[i] != kNoTriangle;
                covered += by_rays;
                const double y = static_cast<double>(i / 4 / 160) + pattern.y[i % 4] / 256.0;
                far += by_raster != by_rays && std::fabs(y - horizon_px) > 1.0 / 16.0; // 1.7 m at 5 km: .04 pixel
            }
            EXPECT_EQ(far, 0u) << "half a side of " << half << " m, pitch " << pitch;
            EXPECT_GT(covered, raster.triangle_ids.size() / 2);
        }
}

} // namespace
} // namespace burnish::test
