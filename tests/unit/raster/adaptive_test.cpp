// Adaptive major-axis sampling: no seam where the sample count changes, and fewer fetches at no greater error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/scene/builtin/builtin.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

struct Judge {
    Scene scene = *make_builtin_scene("spheres");
    DrawTables tables = make_draw_tables(scene);
    Jobs jobs{0};
    DfgTable dfg = bake_dfg(32, 256, jobs);
    Environment environment;
    std::unique_ptr<Renderer> renderer;

    Judge()
    {
        EnvironmentOptions options;
        options.cube_size = 256, options.samples = 128, options.use_cache = false;
        environment = *load_environment("builtin:studio", options, Limits{}, jobs);
        renderer = make_tile_renderer({scene, tables, environment, dfg, jobs}, best_isa());
    }
    // The middle sphere fills the image's width: a row of 512 pixels sweeps over the sphere.
    Frame sphere(const char* technique, int samples, float roughness, float anisotropy) const
    {
        FrameDesc d;
        d.width = 512, d.height = 64, d.msaa = 1;
        d.view = make_view({0, 0, 1}, {0, 0, 0}, 0.0112f, d.width, d.height);
        d.technique = technique, d.samples = samples;
        d.roughness = roughness, d.override_anisotropy = true, d.anisotropy = anisotropy;
        return *renderer->render(d);
    }
};

// Maps radiance to a display value. The curve has no kink, which would hide seams.
double shown(float linear)
{
    return std::pow(static_cast<double>(linear) / (1.0 + static_cast<double>(linear)), 1.0 / 2.2);
}

constexpr int kNext = 3; // floats to the next pixel

// Returns the largest second difference along rows, in display values.
double roughest(const Frame& f)
{
    double most = 0.0;
    for (int y = 0; y < f.color.height; ++y)
        for (int x = 16; x + 16 < f.color.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float* p = f.color.f32() + 3 * (y * f.color.width + x) + c;
                most = std::max(most, std::abs(shown(p[-kNext]) - 2.0 * shown(p[0]) + shown(p[kNext])));
            }
    return most;
}

// A fixed sample count moves its samples smoothly. The adaptive count must add no steps to that. The bound is the worse of two fixed
// counts. Sixteen equally spaced samples leave sharper edges in narrow lobes. Sixteen samples by density leave more ripples in wide lobes.
// Samples that appear without fading would exceed the bound many times over.
TEST(adaptive, no_seam_shows_on_a_sweep_over_a_sphere)
{
    const Judge judge;
    for (float roughness : {0.2f, 0.35f, 0.5f})
        for (float anisotropy : {0.0f, 0.2f, 0.5f, 0.8f, -0.8f, 0.95f}) {
            const double equal = roughest(judge.sphere("major_axis", 16, roughness, anisotropy));
            const double by_density = roughest(judge.sphere("major_axis_weighted", 16, roughness, anisotropy));
            const double adaptive = roughest(judge.sphere("major_axis_adaptive", 16, roughness, anisotropy));
            EXPECT_LE(adaptive, std::max(equal, by_density) + 1.0 / 255.0) << "roughness " << roughness << " eta " << anisotropy;
            EXPECT_LE(adaptive, equal + 1.3 / 255.0) << "roughness " << roughness << " eta " << anisotropy;
        }
}

// Returns the mean of |a - b| a pixel, summed over channels, in display values.
double distance(const Frame& a, const Frame& b)
{
    double sum = 0.0;
    const int n = a.color.width * a.color.height * 3;
    for (int i = 0; i < n; ++i)
        sum += std::abs(shown(a.color.f32()[i]) - shown(b.color.f32()[i]));
    return sum / n;
}

// Monte Carlo integration of the same lobe is the reference. Over a grid of lobes, samples by density beat sixteen equal samples, and so
// does an adaptive count with a third of the fetches.
TEST(adaptive, samples_by_density_are_nearer_to_the_reference_than_equal_ones)
{
    const Judge judge;
    double bent = 0.0, equal = 0.0, weighted = 0.0, adaptive = 0.0;
    for (float roughness : {0.2f, 0.35f, 0.5f})
        for (float anisotropy : {0.5f, 0.8f, -0.5f, -0.8f}) {
            const Frame reference = judge.sphere("mc", 2048, roughness, anisotropy);
            const auto error = [&](const char* technique) {
                return distance(reference, judge.sphere(technique, 16, roughness, anisotropy));
            };
            bent += error("bent_normal"), equal += error("major_axis");
            weighted += error("major_axis_weighted"), adaptive += error("major_axis_adaptive");
        }
    EXPECT_LT(equal, 0.8 * bent);
    EXPECT_LT(weighted, 0.75 * equal);
    EXPECT_LT(adaptive, equal);
    std::printf("mean error of bent normal %.4f, equal samples %.4f, by density %.4f, adaptive %.4f\n", bent / 12, equal / 12,
                weighted / 12, adaptive / 12);
}

} // namespace
} // namespace burnish::test
