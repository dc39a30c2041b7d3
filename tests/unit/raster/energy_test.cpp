// How much light lobes give back. Energy compensation: what single scattering between microfacets loses comes back, whatever the widths of
// the lobe. Tilts: every technique gives back what Monte Carlo of the ellipsoid distribution does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "raster/frame/grid_samples.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr double kDegree = 3.14159265358979 / 180.0;

Scene square(float metallic, float albedo)
{
    Scene scene = scene_of(
        {{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 1, 0)}, {glm::vec3(-1, -1, 0), glm::vec3(1, 1, 0), glm::vec3(-1, 1, 0)}},
        false);
    scene.materials[0].metallic = metallic;
    scene.materials[0].base_color = glm::vec4(albedo, albedo, albedo, 1.0f);
    return scene;
}

// A floor of one material under light of radiance 1.
struct Floor {
    explicit Floor(float metallic = 1.0f, float albedo = 1.0f)
        : stage(square(metallic, albedo)), renderer(make_tile_renderer(stage.input(), best_isa()))
    {
    }
    // Mean radiance that it gives back to an eye at a cosine against the normal and an azimuth against x, which the grain is turned to.
    double seen(const FrameDesc& shading, double cosine, double azimuth_rad) const
    {
        FrameDesc d = shading;
        d.width = d.height = 4, d.msaa = 1;
        const double sine = std::sqrt(1.0 - cosine * cosine);
        const glm::vec3 eye(sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine);
        d.view = make_view(eye * 20.0f, {0, 0, 0}, 0.001f, d.width, d.height);
        const Frame f = *renderer->render(d);
        double sum = 0.0;
        for (int i = 0; i < d.width * d.height * 3; ++i)
            sum += static_cast<double>(f.color.f32()[i]);
        return sum / (d.width * d.height * 3);
    }
    Stage stage;
    std::unique_ptr<Renderer> renderer;
};

constexpr float kRoughness[] = {0.1f, 0.3f, 0.5f, 0.7f, 0.85f, 1.0f};
constexpr float kEta[] = {0.0f, -0.5f, 0.5f, 0.8f, 0.95f};

struct Range {
    double least = 9.0, most = 0.0;
};

// What the floor gives back over lobes and views.
Range range_over_lobes(const Floor& floor, FrameDesc d)
{
    d.override_anisotropy = true;
    Range r;
    for (float roughness : kRoughness)
        for (float eta : kEta)
            for (double cosine : {1.0, 0.7, 0.4, 0.2, 0.1})
                for (double azimuth : {0.0, 30.0, 60.0, 80.0, 90.0}) {
                    d.roughness = roughness, d.anisotropy = eta;
                    const double v = floor.seen(d, cosine, azimuth * kDegree);
                    r.least = std::min(r.least, v), r.most = std::max(r.most, v);
                }
    return r;
}

// What mc gives back is the albedo table's doing; the others scale by the same albedo that is compensated for, or by their samples' own.
TEST(energy, a_white_metal_gives_back_all_light_whatever_its_lobe)
{
    const Floor floor;
    FrameDesc d;
    for (const TechniqueInfo& t : techniques()) {
        d.technique = t.name;
        const bool mc = d.technique == "mc";
        d.samples = mc ? 256 : t.default_samples;
        d.energy_compensation = true;
        const Range with = range_over_lobes(floor, d);
        EXPECT_GT(with.least, mc ? 0.98 : 0.999) << t.name;
        EXPECT_LT(with.most, mc ? 1.02 : 1.001) << t.name;
        d.energy_compensation = false;
        EXPECT_LT(range_over_lobes(floor, d).least, 0.5) << t.name;
        std::printf("%s: %.4f to %.4f\n", t.name, with.least, with.most);
    }
}

// A metal that absorbs and a dielectric, whose diffuse part gets what the lobe leaves: prefiltered techniques give back what sampling does.
TEST(energy, one_fetch_gives_back_what_sampling_does)
{
    double largest = 0.0;
    for (float metallic : {1.0f, 0.0f}) {
        const Floor floor(metallic, 0.5f);
        for (float roughness : kRoughness)
            for (float eta : kEta)
                for (double cosine : {0.9, 0.4, 0.15})
                    for (double azimuth : {10.0, 50.0, 85.0}) {
                        FrameDesc d;
                        d.override_anisotropy = true, d.energy_compensation = true;
                        d.roughness = roughness, d.anisotropy = eta;
                        d.technique = "mc", d.samples = 256;
                        const double truth = floor.seen(d, cosine, azimuth * kDegree);
                        d.technique = "bent_normal";
                        const double error = std::abs(floor.seen(d, cosine, azimuth * kDegree) - truth);
                        EXPECT_LT(error, 0.02) << "metallic " << metallic << ", alpha_lin " << roughness << ", eta " << eta << ", cosine "
                                               << cosine << ", azimuth " << azimuth;
                        largest = std::max(largest, error);
                    }
    }
    std::printf("largest difference %.4f\n", largest);
}

// Without compensation too: the light that a technique found is scaled by what its lobe of two widths gives back.
TEST(energy, prefiltered_techniques_give_back_what_their_lobe_does)
{
    const Floor floor;
    FrameDesc d;
    d.override_anisotropy = true;
    double largest = 0.0;
    for (float roughness : {0.3f, 0.5f, 0.7f, 0.9f})
        for (float eta : {-0.9f, 0.0f, 0.5f, 0.9f})
            for (double cosine : {0.95, 0.6, 0.25})
                for (double azimuth : {5.0, 45.0, 88.0}) {
                    d.roughness = roughness, d.anisotropy = eta;
                    d.technique = "mc", d.samples = 1024;
                    const double truth = floor.seen(d, cosine, azimuth * kDegree);
                    for (const char* technique : {"split_isotropic", "bent_normal", "major_axis", "major_axis_weighted", "lobe_line"}) {
                        d.technique = technique, d.samples = 4;
                        const double error = std::abs(floor.seen(d, cosine, azimuth * kDegree) / truth - 1.0);
                        EXPECT_LT(error, 0.01) << technique << ", alpha_lin " << roughness << ", eta " << eta << ", cosine " << cosine
                                               << ", azimuth " << azimuth;
                        largest = std::max(largest, error);
                    }
                }
    std::printf("largest relative difference %.4f\n", largest);
}

// What a tilted lobe loses, below the surface too, comes back, and no more. Of lobes that look away so far that hardly any light returns
// less comes back, as compensation is limited.
TEST(energy, a_tilted_white_metal_gives_back_all_light)
{
    const Floor floor;
    FrameDesc d;
    d.override_anisotropy = true;
    for (const TechniqueInfo& t : techniques()) {
        d.technique = t.name;
        const bool mc = d.technique == "mc";
        d.samples = mc ? 256 : t.default_samples;
        Range r, away;
        for (const glm::vec2& tilt : {glm::vec2(30, 0), glm::vec2(0, -20), glm::vec2(-15, 25)})
            for (float roughness : {0.3f, 0.7f, 1.0f})
                for (float eta : {0.0f, 0.8f})
                    for (double cosine : {0.9, 0.5})
                        for (double azimuth : {0.0, 90.0, 210.0}) {
                            d.tilt_rad = tilt * static_cast<float>(kDegree), d.roughness = roughness, d.anisotropy = eta;
                            d.energy_compensation = false;
                            const bool seen = floor.seen(d, cosine, azimuth * kDegree) > 0.1;
                            d.energy_compensation = true;
                            const double v = floor.seen(d, cosine, azimuth * kDegree);
                            Range& of = seen ? r : away;
                            of.least = std::min(of.least, v), of.most = std::max(of.most, v);
                        }
        std::printf("%s: %.4f to %.4f, looking away at most %.4f\n", t.name, r.least, r.most, away.most);
        EXPECT_LT(away.most, mc ? 1.12 : 1.001) << t.name;
        EXPECT_GT(r.least, mc ? 0.83 : 0.999) << t.name; // mc's own albedo is known by 21 samples
        EXPECT_LT(r.most, mc ? 1.12 : 1.001) << t.name;
    }
}

// Somewhere on every round thing the grain's axis turns to its opposite.
TEST(energy, samples_of_a_grid_lie_opposite_each_other)
{
    for (int n = 1; n <= 8; ++n) {
        const std::vector<GridSample> grid = grid_samples(n * n, true);
        ASSERT_EQ(grid.size(), static_cast<std::size_t>(n * n));
        for (const GridSample& g : grid) {
            const auto opposite = [&](const GridSample& o) {
                return std::abs(o.slope_x + g.slope_x) < 1e-5f && std::abs(o.slope_y + g.slope_y) < 1e-5f && o.density == g.density;
            };
            EXPECT_TRUE(std::any_of(grid.begin(), grid.end(), opposite)) << n << ": " << g.slope_x << " " << g.slope_y;
        }
    }
}

TEST(energy, one_sample_of_a_grid_lies_in_the_middle_of_the_lobe)
{
    const Floor floor;
    FrameDesc d;
    d.override_anisotropy = true, d.roughness = 0.5f, d.anisotropy = 0.8f, d.samples = 1;
    for (const char* technique : {"filtered_is", "filtered_is_ggx"}) {
        d.technique = technique;
        const double v = floor.seen(d, 0.6, 0.3);
        EXPECT_GT(v, 0.8) << technique;
        EXPECT_LT(v, 1.001) << technique;
    }
}

struct Difference {
    double squares = 0.0, largest = 0.0;
    int count = 0;
    void add(double d) { squares += d * d, largest = std::max(largest, std::abs(d)), ++count; }
    double rms() const { return std::sqrt(squares / count); }
};

// A tilted lobe loses what looks away, what its microfacets mask and what it would send below the surface.
TEST(tilt, every_technique_gives_back_what_monte_carlo_does)
{
    const Floor floor;
    const glm::vec2 tilts[] = {{15, 0}, {-15, 0}, {0, 15}, {0, -15}, {20, -20}, {40, 0}, {0, -40}}; // degrees
    std::vector<Difference> off(techniques().size());
    FrameDesc d;
    d.override_anisotropy = true;
    for (const glm::vec2& tilt : tilts)
        for (float roughness : {0.0f, 0.1f, 0.3f, 0.5f, 0.7f, 0.9f})
            for (float eta : {0.0f, -0.8f, 0.8f})
                for (double cosine : {1.0, 0.7, 0.35})
                    for (double azimuth : {0.0, 90.0, 180.0, 270.0}) {
                        d.tilt_rad = tilt * static_cast<float>(kDegree), d.roughness = roughness, d.anisotropy = eta;
                        d.technique = "mc", d.samples = 256;
                        const double truth = floor.seen(d, cosine, azimuth * kDegree);
                        for (std::size_t i = 0; i < off.size(); ++i) {
                            const TechniqueInfo& t = techniques()[i];
                            d.technique = t.name, d.samples = t.default_samples;
                            off[i].add(floor.seen(d, cosine, azimuth * kDegree) - truth);
                        }
                    }
    for (std::size_t i = 0; i < off.size(); ++i) {
        const std::string name = techniques()[i].name;
        std::printf("%s: rms %.4f, at most %.4f\n", name.c_str(), off[i].rms(), off[i].largest);
        EXPECT_LT(off[i].rms(), 0.02) << name;
        EXPECT_LT(off[i].largest, name == "filtered_is" ? 0.12 : 0.08) << name; // all of a Beckmann lobe's samples may be below the horizon
    }
}

} // namespace
} // namespace burnish::test
