// Light that lobes reflect. With energy compensation the single-scattering loss between microfacets returns, for all lobe widths. With
// tilts every technique reflects as much as Monte Carlo of the ellipsoid distribution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "raster/frame/grid_samples.h"
#include "tests/unit/raster/floor.h"

namespace burnish::test {
namespace {

constexpr double kDegree = 3.14159265358979 / 180.0;

constexpr float kRoughness[] = {0.1f, 0.3f, 0.5f, 0.7f, 0.85f, 1.0f};
constexpr float kEta[] = {0.0f, -0.5f, 0.5f, 0.8f, 0.95f};

struct Range {
    double least = 9.0, most = 0.0;
};

// Returns the range of the floor's reflected light over lobes and views.
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

// The albedo table alone determines mc's light. The other techniques scale by the compensated albedo or by their samples' albedo.
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

// For an absorbing metal and for a dielectric, whose diffuse part gets the light that the lobe leaves, prefiltered techniques match
// sampling.
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
                        const double reference = floor.seen(d, cosine, azimuth * kDegree);
                        d.technique = "bent_normal";
                        const double error = std::abs(floor.seen(d, cosine, azimuth * kDegree) - reference);
                        EXPECT_LT(error, 0.02) << "metallic " << metallic << ", roughness " << roughness << ", eta " << eta << ", cosine "
                                               << cosine << ", azimuth " << azimuth;
                        largest = std::max(largest, error);
                    }
    }
    std::printf("largest difference %.4f\n", largest);
}

// Without compensation, too, a technique's light is scaled by the albedo of its anisotropic lobe.
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
                    const double reference = floor.seen(d, cosine, azimuth * kDegree);
                    for (const char* technique : {"split_isotropic", "bent_normal", "major_axis", "major_axis_weighted", "lobe_line"}) {
                        d.technique = technique, d.samples = 4;
                        const double error = std::abs(floor.seen(d, cosine, azimuth * kDegree) / reference - 1.0);
                        EXPECT_LT(error, 0.01) << technique << ", roughness " << roughness << ", eta " << eta << ", cosine " << cosine
                                               << ", azimuth " << azimuth;
                        largest = std::max(largest, error);
                    }
                }
    std::printf("largest relative difference %.4f\n", largest);
}

// The light that a tilted lobe loses, below the surface too, returns, and no more. Lobes that face so far away that hardly any light
// returns get less back, since compensation is limited.
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
        EXPECT_GT(r.least, mc ? 0.9 : 0.999) << t.name; // a few samples estimate mc's albedo
        EXPECT_LT(r.most, mc ? 1.1 : 1.001) << t.name;
    }
}

// On every round object there is a place where the grain's axis flips.
TEST(energy, samples_of_a_grid_lie_opposite_each_other)
{
    for (int n = 1; n <= 8; ++n) {
        const std::vector<GridSample> grid = grid_samples(n * n, Sampling::grid, kGgxGrid);
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

// An eye against the lobe's normal, as floor.seen() takes it.
struct EyeOfLobe {
    double cosine, azimuth_rad;
};
EyeOfLobe eye_of_lobe(const glm::vec2& tilt_rad, double cosine, double azimuth_rad)
{
    const glm::dvec3 eye = Floor::eye(cosine, azimuth_rad);
    const double sx = std::sin(static_cast<double>(tilt_rad.x)), cx = std::cos(static_cast<double>(tilt_rad.x));
    const double sy = std::sin(static_cast<double>(tilt_rad.y)), cy = std::cos(static_cast<double>(tilt_rad.y));
    const glm::dvec3 t(cy, 0.0, sy), across(-sy, 0.0, cy), y(0.0, 1.0, 0.0); // Walter et al. 2014, eq. 3
    return {glm::dot(eye, y * sx + across * cx), std::atan2(glm::dot(eye, y * cx - across * sx), glm::dot(eye, t))};
}

// A tilted lobe loses light that faces away, that microfacets mask, and that would leave below the surface. Filtered samples have another
// albedo than the lobe, tilted or not, so the test compares their loss alone.
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
                        const double reference = floor.seen(d, cosine, azimuth * kDegree);
                        const EyeOfLobe eye = eye_of_lobe(d.tilt_rad, cosine, azimuth * kDegree);
                        FrameDesc upright = d;
                        upright.tilt_rad = glm::vec2(0.0f);
                        const bool level = eye.cosine > 0.05;
                        const double of_level = level ? floor.seen(upright, eye.cosine, eye.azimuth_rad) : 1.0;
                        for (std::size_t i = 0; i < off.size(); ++i) {
                            const TechniqueInfo& t = techniques()[i];
                            d.technique = upright.technique = t.name, d.samples = upright.samples = t.default_samples;
                            double own = 1.0;
                            if (level && (t.sampling == Sampling::grid || t.traits & kPhongGrid)) // lobes with another albedo
                                own = floor.seen(upright, eye.cosine, eye.azimuth_rad) / of_level;
                            off[i].add(floor.seen(d, cosine, azimuth * kDegree) - reference * own);
                        }
                    }
    for (std::size_t i = 0; i < off.size(); ++i) {
        const std::string name = techniques()[i].name;
        std::printf("%s: rms %.4f, at most %.4f\n", name.c_str(), off[i].rms(), off[i].largest);
        const bool phong = techniques()[i].traits & kPhongGrid, box = techniques()[i].traits & kReadsBox;
        EXPECT_LT(off[i].rms(), phong ? 0.04 : 0.02) << name;               // the Phong lobe loses more at lower views
        EXPECT_LT(off[i].largest, phong ? 0.4 : box ? 0.25 : 0.08) << name; // few samples see the eye from behind
    }
}

// A tilt of a thousandth of a degree changes nothing. With separable masking and an eye straight down a long lobe, the few samples turn
// with the tilt, so the bound is wider.
TEST(tilt, that_is_next_to_none_changes_nothing)
{
    const Floor floor;
    FrameDesc d;
    d.override_anisotropy = true;
    double largest = 0.0;
    for (const TechniqueInfo& t : techniques())
        for (int masking : {0, 1})
            for (bool compensated : {false, true})
                for (float roughness : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f})
                    for (float eta : {0.0f, 0.8f})
                        for (double cosine : {1.0, 0.7, 0.35, 0.1}) {
                            d.technique = t.name, d.samples = t.default_samples;
                            if (t.traits & kSamplesLobe && masking) // separable ones have other samples
                                continue;
                            d.masking = masking, d.energy_compensation = compensated;
                            d.roughness = roughness, d.anisotropy = eta;
                            d.tilt_rad = glm::vec2(0.0f);
                            const double level = floor.seen(d, cosine, 0.4);
                            d.tilt_rad = glm::vec2(static_cast<float>(0.001 * kDegree), 0.0f);
                            const double change = std::abs(floor.seen(d, cosine, 0.4) / level - 1.0);
                            EXPECT_LT(change, masking ? 3e-4 : 1e-4)
                                << t.name << ", masking " << masking << ", compensated " << compensated << ", roughness " << roughness
                                << ", eta " << eta << ", cosine " << cosine;
                            largest = std::max(largest, change);
                        }
    std::printf("largest relative difference %.2e\n", largest);
}

// From 0 to 40 degrees the reflected light bends where the eye crosses the lobe's horizon, and jumps nowhere.
TEST(tilt, dims_without_a_jump)
{
    const Floor floor;
    FrameDesc d;
    d.override_anisotropy = true;
    double largest = 0.0;
    for (const TechniqueInfo& t : techniques())
        for (int masking : {0, 1})
            for (float roughness : {0.3f, 0.7f, 0.9f})
                for (double cosine : {0.9, 0.35}) {
                    d.technique = t.name, d.samples = t.traits & kSamplesLobe ? 4096 : t.default_samples;
                    d.masking = masking, d.roughness = roughness, d.anisotropy = 0.5f;
                    double before = 0.0, last = 0.0;
                    for (int degrees = 0; degrees <= 40; ++degrees) {
                        d.tilt_rad = glm::vec2(static_cast<float>(degrees * kDegree), 0.0f);
                        const double now = floor.seen(d, cosine, 1.9);
                        if (degrees > 1) {
                            const double bend = std::abs(now - 2.0 * last + before);
                            EXPECT_LT(bend, 0.03) << t.name << ", masking " << masking << ", roughness " << roughness << ", cosine "
                                                  << cosine << ", degrees " << degrees;
                            largest = std::max(largest, bend);
                        }
                        before = last, last = now;
                    }
                }
    std::printf("largest second difference %.4f\n", largest);
}

// With separable masking the white metal reflects as much as Monte Carlo with the same masking.
TEST(masking, every_technique_gives_back_what_monte_carlo_does)
{
    const Floor floor;
    FrameDesc d;
    d.override_anisotropy = true;
    double largest = 0.0, apart = 0.0;
    for (float roughness : {0.2f, 0.5f, 0.7f, 0.9f})
        for (float eta : {0.0f, 0.8f})
            for (double cosine : {0.9, 0.35, 0.1}) {
                d.roughness = roughness, d.anisotropy = eta, d.technique = "mc", d.samples = 1024, d.masking = 0;
                const double correlated = floor.seen(d, cosine, 0.4);
                d.masking = 1;
                const double reference = floor.seen(d, cosine, 0.4);
                apart = std::max(apart, correlated - reference);
                for (const char* technique : {"split_isotropic", "bent_normal", "major_axis_weighted", "lobe_line"}) {
                    d.technique = technique, d.samples = 4;
                    const double error = std::abs(floor.seen(d, cosine, 0.4) - reference);
                    EXPECT_LT(error, 0.015) << technique << ", roughness " << roughness << ", eta " << eta << ", cosine " << cosine;
                    largest = std::max(largest, error);
                }
            }
    std::printf("off by %.4f at most, where the maskings are %.4f apart\n", largest, apart);
    EXPECT_GT(apart, 0.05);
}

} // namespace
} // namespace burnish::test
