// Thin films: their reflectance against sums over wavelengths, both renderers against each other and against the formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>

#include "shading/kernels/fresnel.k.h"
#include "shading/kernels/thin_film.k.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kFilmSigmas = 4.5;

// CIE standard illuminant D65 from 380 to 780 nm in steps of 10 nm.
constexpr double kDaylight[] = {49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
                                108.811, 109.354, 107.802, 104.79,  107.689, 104.405, 104.046, 100.0,   96.3342, 95.788,  88.6856,
                                90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
                                74.349,  61.604,  69.8856, 75.087,  63.5927, 46.4182, 66.8054, 63.3828};

double daylight(double nm)
{
    const double place = (nm - 380.0) / 10.0;
    const int i = std::min(static_cast<int>(place), 39);
    return kDaylight[i] + (kDaylight[i + 1] - kDaylight[i]) * (place - i);
}

double bell(double nm, double middle, double before, double after)
{
    const double t = (nm - middle) * (nm < middle ? before : after);
    return std::exp(-0.5 * t * t);
}

// The CIE 1931 observer as linear Rec.709. Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching
// Functions".
glm::dvec3 observer(double nm)
{
    const double x =
        0.362 * bell(nm, 442.0, 0.0624, 0.0374) + 1.056 * bell(nm, 599.8, 0.0264, 0.0323) - 0.065 * bell(nm, 501.1, 0.049, 0.0382);
    const double y = 0.821 * bell(nm, 568.8, 0.0213, 0.0247) + 0.286 * bell(nm, 530.9, 0.0613, 0.0322);
    const double z = 1.217 * bell(nm, 437.0, 0.0845, 0.0278) + 0.681 * bell(nm, 459.0, 0.0385, 0.0725);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.969266 * x + 1.8760108 * y + 0.041556 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

// Returns the reflectance of a film at one wavelength: both interfaces' amplitudes, and all waves between them. Born and Wolf 1999,
// "Principles of Optics", section 7.6.
double airy(double nm, double cosine, double film, double below, double thickness)
{
    const double sine2 = 1.0 - cosine * cosine, cos2 = std::sqrt(1.0 - sine2 / (film * film)),
                 cos3 = std::sqrt(std::max(1.0 - sine2 / (below * below), 0.0));
    const std::complex<double> turn = std::polar(1.0, 4.0 * 3.14159265358979324 / nm * film * thickness * cos2);
    double sum = 0.0;
    for (bool parallel : {false, true}) {
        const double a = parallel ? film * cosine : cosine, b = parallel ? cos2 : film * cos2;
        const double c = parallel ? below * cos2 : film * cos2, d = parallel ? film * cos3 : below * cos3;
        const double outer = (a - b) / (a + b), inner = (c - d) / (c + d);
        sum += 0.5 * std::norm((outer + inner * turn) / (1.0 + outer * inner * turn));
    }
    return sum;
}

// Returns the colour that a film reflects of daylight; daylight is white.
glm::dvec3 film_colour(double cosine, double film, double below, double thickness)
{
    glm::dvec3 sum(0.0), white(0.0);
    for (double nm = 380.0; nm <= 780.0; nm += 2.0) {
        sum += observer(nm) * daylight(nm) * airy(nm, cosine, film, below, thickness);
        white += observer(nm) * daylight(nm);
    }
    return glm::clamp(sum / white, 0.0, 1.0);
}

double f0_of(double index)
{
    return (index - 1.0) * (index - 1.0) / ((index + 1.0) * (index + 1.0));
}

glm::dvec3 kernel_colour(double cosine, double film, double f0, double thickness)
{
    const auto below = static_cast<float>(f0);
    const real3 r =
        thin_film_reflectance(static_cast<float>(cosine), static_cast<float>(film), static_cast<float>(thickness), {below, below, below});
    return {r.x, r.y, r.z};
}

double worst_of(const glm::dvec3& a)
{
    return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

TEST(film, reflects_what_a_sum_over_wavelengths_does)
{
    struct Base {
        double index, mean, worst; // bounds on errors
    };
    for (const Base& base : {Base{1.5, 0.008, 0.02}, Base{3.0, 0.007, 0.02}, Base{8.0, 0.014, 0.08}, Base{38.0, 0.012, 0.16}})
        for (double film : {1.2, 1.33, 1.8, 2.4}) {
            double sum = 0.0, worst = 0.0;
            int count = 0;
            for (int nm = 0; nm <= 1000; nm += 25)
                for (double cosine : {1.0, 0.8, 0.5, 0.25, 0.1}) {
                    const double off =
                        worst_of(kernel_colour(cosine, film, f0_of(base.index), nm) - film_colour(cosine, film, base.index, nm));
                    sum += off, worst = std::max(worst, off), ++count;
                }
            std::printf("index %.2f over %.1f: off by %.4f, at most %.3f\n", film, base.index, sum / count, worst);
            EXPECT_LT(sum / count, base.mean) << film << ' ' << base.index;
            EXPECT_LT(worst, base.worst) << film << ' ' << base.index;
        }
}

TEST(film, without_thickness_or_index_is_the_surface_below)
{
    for (double cosine : {1.0, 0.7, 0.3, 0.05})
        for (double index : {1.5, 2.0, 4.0}) {
            const double below = static_cast<double>(fresnel_dielectric(static_cast<float>(cosine), static_cast<float>(index)));
            EXPECT_LT(worst_of(kernel_colour(cosine, 1.0, f0_of(index), 500.0) - below), 2e-5) << cosine << ' ' << index;
            EXPECT_LT(worst_of(kernel_colour(cosine, 1.33, f0_of(index), 0.0) - below), 8e-3) << cosine << ' ' << index;
        }
}

TEST(film, stays_in_bounds_whatever_it_is_given)
{
    for (double cosine : {0.0, 1e-20, 0.5, 1.0, 2.0})
        for (double film : {0.0, 1.0, 1.3, 1e30})
            for (double f0 : {0.0, 0.04, 1.0})
                for (double thickness : {0.0, 1e-30, 400.0, 1e30}) {
                    const glm::dvec3 r = kernel_colour(cosine, film, f0, thickness);
                    for (int c = 0; c < 3; ++c)
                        EXPECT_TRUE(r[c] >= 0.0 && r[c] <= 1.0) << cosine << ' ' << film << ' ' << f0 << ' ' << thickness;
                }
}

Material filmed(Material below, float thickness, float share = 1.0f, float ior = 1.4f)
{
    below.iridescence = share, below.iridescence_thickness = thickness, below.iridescence_ior = ior;
    return below;
}

Material copper(float roughness)
{
    Material m = metal(roughness, 0.0f);
    m.base_color = glm::vec4(0.9f, 0.6f, 0.4f, 1.0f);
    return m;
}

Material slate()
{
    Material m = metal(0.0f, 0.0f);
    m.metallic = 0.0f, m.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f), m.ior = 1.8f;
    return m;
}

FrameDesc film_view(float cosine, const char* technique, int samples)
{
    const float sine = std::sqrt(1.0f - cosine * cosine);
    FrameDesc d = desc_of(8, 8, view_from({sine * 0.8f, sine * 0.6f, cosine}, 0.002f));
    d.technique = technique, d.samples = samples;
    return d;
}

ReferenceOptions film_run(ReferenceMode mode, std::uint64_t samples)
{
    ReferenceOptions o;
    o.mode = mode, o.samples = samples;
    return o;
}

// Constant light of 1 on mirrors: every technique and the reference give the reflectance.
TEST(film, of_a_mirror_is_its_reflectance_by_every_technique)
{
    for (const Material& below : {copper(0.0f), slate()})
        for (float cosine : {0.95f, 0.5f}) {
            const Stage stage(plane_scene(filmed(below, 350.0f, 0.75f)), 1.0f, 2);
            glm::dvec3 expected;
            for (int c = 0; c < 3; ++c) {
                const double f0 = below.metallic > 0.0f ? static_cast<double>(below.base_color[c]) : f0_of(1.8);
                const double bare = f0 + (1.0 - f0) * std::pow(1.0 - static_cast<double>(cosine), 5.0);
                expected[c] = 0.25 * bare + 0.75 * kernel_colour(static_cast<double>(cosine), 1.4, f0, 350.0)[c];
            }
            for (const char* technique : {"split_isotropic", "bent_normal", "lobe_line", "auto"}) {
                const glm::dvec3 drawn = colour_of(stage.render(film_view(cosine, technique, 8), best_isa()));
                EXPECT_LT(worst_of(drawn - expected), 0.012) << technique << ' ' << cosine;
            }
            if (reference_available()) {
                const glm::dvec3 found =
                    estimate_channels(render_reference(stage, film_view(cosine, "mc", 1), film_run(ReferenceMode::direct, 16))).mean;
                EXPECT_LT(worst_of(found - expected), 2e-3) << cosine;
            }
        }
}

glm::vec3 film_sky(const glm::vec3& d)
{
    return glm::vec3(1.0f + 0.5f * d.x, 1.0f + 0.3f * d.y, 1.0f + 0.4f * d.z);
}

TEST(film, of_rough_metal_and_plastic_mc_agrees_with_the_reference)
{
    BN_NEEDS_EMBREE();
    Material plastic = slate();
    plastic.base_color = glm::vec4(0.5f, 0.4f, 0.3f, 1.0f), plastic.roughness = 0.4f;
    for (const Material& below : {copper(0.3f), copper(0.7f), plastic})
        for (float cosine : {0.8f, 0.3f}) {
            Stage stage(plane_scene(filmed(below, 500.0f)), 1.0f, 2);
            stage.environment = environment_of(film_sky, 64, stage.jobs);
            const glm::dvec3 drawn = colour_of(stage.render(film_view(cosine, "mc", 1024), best_isa()));
            for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light}) {
                ReferenceOptions o = film_run(ReferenceMode::direct, 1024);
                o.strategy = strategy;
                const ChannelEstimate e = estimate_channels(render_reference(stage, film_view(cosine, "mc", 1), o));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(drawn[c], e.mean[c], kFilmSigmas * e.deviation[c] + 3e-3) << cosine << ' ' << c;
            }
        }
}

// One fetch takes the film at the lobe's mean angle; samples take it at each.
TEST(film, of_rough_metal_by_one_fetch_is_near_its_samples)
{
    for (float roughness : {0.2f, 0.4f, 0.6f})
        for (float thickness : {150.0f, 400.0f, 800.0f})
            for (float cosine : {0.95f, 0.6f, 0.3f}) {
                const Stage stage(plane_scene(filmed(copper(roughness), thickness)), 1.0f, 2);
                const glm::dvec3 sampled = colour_of(stage.render(film_view(cosine, "mc", 1024), best_isa()));
                const glm::dvec3 fetched = colour_of(stage.render(film_view(cosine, "lobe_line", 8), best_isa()));
                std::printf("roughness %.1f, %4.0f nm, cosine %.2f: %+.3f %+.3f %+.3f of %.3f %.3f %.3f\n", static_cast<double>(roughness),
                            static_cast<double>(thickness), static_cast<double>(cosine), fetched.x - sampled.x, fetched.y - sampled.y,
                            fetched.z - sampled.z, sampled.x, sampled.y, sampled.z);
                EXPECT_LT(worst_of(fetched - sampled), roughness < 0.5f && thickness < 500.0f ? 0.02 : 0.035)
                    << roughness << ' ' << thickness << ' ' << cosine;
            }
}

// An index of 0 reflects all light by glTF; with a specular colour of .04 it is the usual plastic.
TEST(film, over_a_dielectric_without_an_index_is_not_seen_from_inside)
{
    Material plastic = slate(), bare = slate();
    plastic.ior = 1.5f, bare.ior = 0.0f, bare.specular_color = glm::vec3(0.04f);
    const FrameDesc d = film_view(0.7f, "split_isotropic", 1);
    const Stage with(plane_scene(filmed(plastic, 300.0f)), 1.0f, 2), without(plane_scene(filmed(bare, 300.0f)), 1.0f, 2);
    EXPECT_LT(worst_of(colour_of(with.render(d, best_isa())) - colour_of(without.render(d, best_isa()))), 1e-4);
}

TEST(film, with_energy_compensation_makes_no_light)
{
    Material white = slate();
    white.base_color = glm::vec4(1.0f), white.ior = 1.5f, white.roughness = 1.0f;
    for (float cosine : {0.95f, 0.6f, 0.3f}) {
        FrameDesc d = film_view(cosine, "mc", 1024);
        d.energy_compensation = true;
        const Stage stage(plane_scene(filmed(white, 80.0f, 1.0f, 2.4f)), 1.0f, 2);
        const glm::dvec3 drawn = colour_of(stage.render(d, best_isa()));
        EXPECT_LT(std::max({drawn.x, drawn.y, drawn.z}), 1.02) << cosine;
    }
}

TEST(film, without_a_share_is_none_word_for_word)
{
    Stage bare(plane_scene(copper(0.3f))), none(plane_scene(filmed(copper(0.3f), 400.0f, 0.0f))),
        full(plane_scene(filmed(copper(0.3f), 400.0f)));
    for (Stage* stage : {&bare, &none, &full})
        stage->environment = environment_of(film_sky, 16, stage->jobs);
    for (const TechniqueInfo& t : techniques()) {
        const FrameDesc d = film_view(0.4f, t.name, std::min(t.default_samples, 16));
        EXPECT_EQ(bare.render(d, best_isa()).color.bytes, none.render(d, best_isa()).color.bytes) << t.name;
        EXPECT_NE(bare.render(d, best_isa()).color.bytes, full.render(d, best_isa()).color.bytes) << t.name;
    }
}

// White glass under constant light: what the film does not reflect passes, from outside and from inside.
TEST(film, on_glass_loses_no_light)
{
    BN_NEEDS_EMBREE();
    Material glass = slate();
    glass.base_color = glm::vec4(1.0f), glass.transmission = 1.0f, glass.roughness = 0.1f;
    const Stage stage(ball_scene(filmed(glass, 380.0f), false), 1.0f, 2);
    for (float place : {0.0f, 0.6f}) {
        FrameDesc d = desc_of(8, 8, view_from({0.0f, place, 1.0f}, 0.5f));
        d.technique = "mc", d.samples = 256;
        ReferenceOptions o = film_run(ReferenceMode::path, 256);
        o.bounces = 64;
        const ChannelEstimate e = estimate_channels(render_reference(stage, d, o));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(e.mean[c], 1.0, kFilmSigmas * e.deviation[c] + 0.02) << c;
    }
}

// Rays meet a filmed and a bare plate side by side, so lanes mix both materials.
TEST(film, beside_a_bare_surface_leaves_it_alone)
{
    BN_NEEDS_EMBREE();
    Scene both = plane_scene(filmed(copper(0.3f), 400.0f));
    add_scene(both, plane_scene(copper(0.3f)), {2.0f, 0.0f, 0.0f}, 1.0f);
    const Stage mixed(both, 1.0f, 2), bare(plane_scene(copper(0.3f)), 1.0f, 2), film(plane_scene(filmed(copper(0.3f), 400.0f)), 1.0f, 2);
    FrameDesc d = desc_of(16, 16, view_from({0.0f, 0.0f, 1.0f}, 0.01f));
    const glm::dvec3 alone = estimate_channels(render_reference(bare, d, film_run(ReferenceMode::direct, 256))).mean,
                     under = estimate_channels(render_reference(film, d, film_run(ReferenceMode::direct, 256))).mean;
    d.view.eye.x += 1.0f;
    const ChannelEstimate half = estimate_channels(render_reference(mixed, d, film_run(ReferenceMode::direct, 256)));
    EXPECT_GT(worst_of(alone - under), 0.1) << "nothing is tested";
    EXPECT_LT(worst_of(half.mean - 0.5 * (alone + under)), 0.01);
}

} // namespace
} // namespace burnish::test
