// Analytic scenes: the reflected radiance is known in closed form, or from the directional albedo table.
#include <gtest/gtest.h>

#include <cmath>

#include "shading/surface/dfg.k.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kSigmas = 4.5; // several dozen comparisons: 1 in 10,000 runs would fail if the seeds were not fixed

ReferenceOptions to_samples(ReferenceMode mode, std::uint64_t samples)
{
    ReferenceOptions o;
    o.mode = mode, o.samples = samples;
    return o;
}

// Returns the radiance of a square with this material under the stage's environment.
Estimate seen_from(const Stage& stage, const glm::vec3& direction, const ReferenceOptions& options, FrameDesc d = {})
{
    d.width = d.height = 8, d.msaa = 1;
    d.view = view_from(direction, 0.05f);
    return estimate(render_reference(stage, d, options));
}

glm::vec3 at_cosine(float cosine)
{
    return {std::sqrt(1.0f - cosine * cosine) * 0.8f, std::sqrt(1.0f - cosine * cosine) * 0.6f, cosine};
}

TEST(furnace, a_white_metal_reflects_its_directional_albedo)
{
    BN_NEEDS_EMBREE();
    for (float roughness : {0.2f, 0.5f, 0.8f, 1.0f})
        for (float cosine : {1.0f, 0.6f, 0.2f})
            for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light}) {
                Stage stage(plane_scene(metal(roughness, 0.0f)));
                stage.dfg = bake_dfg(64, 4096, stage.jobs);
                ReferenceOptions o = to_samples(ReferenceMode::direct, 1024);
                o.strategy = strategy;
                const Estimate e = seen_from(stage, at_cosine(cosine), o);
                const dfg_value albedo = dfg_lookup(stage.dfg.pairs.data(), stage.dfg.size, cosine, roughness);
                EXPECT_NEAR(e.mean, static_cast<double>(albedo.scale + albedo.bias), kSigmas * e.deviation + 1.5e-3)
                    << "roughness " << roughness << " cosine " << cosine << " strategy " << static_cast<int>(strategy);
                EXPECT_GT(e.mean, 0.3);
            }
}

TEST(furnace, a_dielectric_loses_nothing_but_what_its_base_absorbs)
{
    BN_NEEDS_EMBREE();
    Material m;
    m.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    m.metallic = 0.0f, m.roughness = 0.4f;
    for (float cosine : {0.9f, 0.3f}) {
        Stage stage(plane_scene(m));
        stage.dfg = bake_dfg(64, 4096, stage.jobs);
        const dfg_value a = dfg_lookup(stage.dfg.pairs.data(), stage.dfg.size, cosine, 0.4f);
        const double specular = 0.04 * static_cast<double>(a.scale) + static_cast<double>(a.bias);
        const Estimate e = seen_from(stage, at_cosine(cosine), to_samples(ReferenceMode::shadowed, 4096));
        EXPECT_NEAR(e.mean, specular + 0.5 * (1.0 - specular), kSigmas * e.deviation + 1e-3) << cosine;
    }
}

TEST(furnace, energy_compensation_returns_what_a_metal_loses)
{
    BN_NEEDS_EMBREE();
    Stage stage(plane_scene(metal(0.9f, 0.0f)));
    stage.dfg = bake_dfg(64, 4096, stage.jobs);
    FrameDesc d;
    d.energy_compensation = true;
    const Estimate e = seen_from(stage, at_cosine(0.5f), to_samples(ReferenceMode::direct, 4096), d);
    EXPECT_NEAR(e.mean, 1.0, kSigmas * e.deviation + 2e-3);
}

TEST(furnace, energy_compensation_returns_what_an_anisotropic_metal_loses)
{
    BN_NEEDS_EMBREE();
    const Stage stage(plane_scene(metal(0.7f, 0.5f)));
    FrameDesc d;
    d.energy_compensation = true, d.override_anisotropy = true;
    for (float roughness : {0.1f, 0.4f, 0.7f, 1.0f})
        for (float eta : {-0.5f, 0.8f, 0.95f})
            for (float cosine : {0.9f, 0.5f, 0.2f}) {
                d.roughness = roughness, d.anisotropy = eta;
                const Estimate e = seen_from(stage, at_cosine(cosine), to_samples(ReferenceMode::direct, 256), d);
                EXPECT_NEAR(e.mean, 1.0, kSigmas * e.deviation + 0.015)
                    << "roughness " << roughness << " eta " << eta << " cosine " << cosine;
                EXPECT_LT(e.deviation, 3e-3);
            }
}

// Returns an anisotropic lobe's albedo by quadrature over directions, in double precision.
double anisotropic_albedo(double ax, double ay, glm::dvec3 o)
{
    const auto stretch = [&](const glm::dvec3& w) { return std::sqrt(ax * ax * w.x * w.x + ay * ay * w.y * w.y + w.z * w.z); };
    constexpr int kZ = 1024, kPhi = 2048;
    double sum = 0.0;
    for (int a = 0; a < kZ; ++a)
        for (int b = 0; b < kPhi; ++b) {
            const double z = (a + 0.5) / kZ, phi = (b + 0.5) / kPhi * 2.0 * 3.14159265358979323846, s = std::sqrt(1.0 - z * z);
            const glm::dvec3 i(s * std::cos(phi), s * std::sin(phi), z), h = glm::normalize(i + o);
            const double q = h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay) + h.z * h.z;
            const double d = 1.0 / (3.14159265358979323846 * ax * ay * q * q);
            sum += d * 0.5 / (i.z * stretch(o) + o.z * stretch(i)) * z;
        }
    return sum * 2.0 * 3.14159265358979323846 / (static_cast<double>(kZ) * kPhi);
}

TEST(furnace, an_anisotropic_metal_reflects_its_directional_albedo)
{
    BN_NEEDS_EMBREE();
    for (float eta : {-0.6f, 0.7f}) {
        const Stage stage(plane_scene(metal(0.6f, eta)));
        FrameDesc d;
        d.roughness = 0.6f, d.anisotropy = eta, d.override_anisotropy = true;
        const double alpha = 0.36, e = static_cast<double>(eta);
        const glm::dvec3 o = glm::normalize(glm::dvec3(at_cosine(0.5f)));
        const Estimate got = seen_from(stage, at_cosine(0.5f), to_samples(ReferenceMode::direct, 4096), d);
        EXPECT_NEAR(got.mean, anisotropic_albedo(alpha * (1.0 + e), alpha * (1.0 - e), o), kSigmas * got.deviation + 5e-4) << eta;
    }
}

TEST(analytic, a_lambert_plane_under_a_constant_and_under_a_linear_environment)
{
    BN_NEEDS_EMBREE();
    Stage stage(plane_scene(lambert(0.6f)), 2.0f);
    const Estimate constant = seen_from(stage, {0.3f, 0.2f, 1.0f}, to_samples(ReferenceMode::direct, 1024));
    EXPECT_NEAR(constant.mean, 0.6 * 2.0, kSigmas * constant.deviation + 1e-4);
    // L = a + b.d gives the irradiance pi (a + 2/3 b.n)
    stage.environment =
        environment_of([](const glm::vec3& d) { return glm::vec3(1.0f + 0.3f * d.x - 0.2f * d.y + 0.45f * d.z); }, 64, stage.jobs);
    for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light}) {
        ReferenceOptions o = to_samples(ReferenceMode::shadowed, 4096);
        o.strategy = strategy;
        const Estimate linear = seen_from(stage, {0.3f, 0.2f, 1.0f}, o);
        EXPECT_NEAR(linear.mean, 0.6 * (1.0 + 0.45 * 2.0 / 3.0), kSigmas * linear.deviation + 5e-4) << static_cast<int>(strategy);
        EXPECT_LT(linear.deviation, 2e-3);
    }
}

TEST(analytic, a_mirror_shows_the_environment_and_what_stands_in_it)
{
    BN_NEEDS_EMBREE();
    Scene scene = plane_scene(metal(0.0f, 0.0f));
    Stage stage(scene);
    stage.environment = environment_of([](const glm::vec3& d) { return glm::vec3(1.0f + 0.5f * d.x); }, 64, stage.jobs);
    const glm::vec3 from = glm::normalize(glm::vec3(0.6f, 0.0f, 0.8f));
    for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light}) {
        ReferenceOptions o = to_samples(ReferenceMode::shadowed, 256);
        o.strategy = strategy;
        const Estimate e = seen_from(stage, from, o);
        EXPECT_NEAR(e.mean, 1.0 - 0.5 * 0.6, 2e-3) << static_cast<int>(strategy);
    }
    Material glow = lambert(0.0f);
    glow.emissive = glm::vec3(7.0f);
    add_scene(scene, ball_scene(glow, false), glm::vec3(-0.6f, 0.0f, 0.8f) * 2.0f, 0.4f);
    const Stage lamp(scene);
    ReferenceOptions o = to_samples(ReferenceMode::path, 256);
    EXPECT_NEAR(seen_from(lamp, from, o).mean, 7.0, 1e-3);
    o.bounces = 0;
    EXPECT_EQ(seen_from(lamp, from, o).mean, 0.0);
    o.mode = ReferenceMode::shadowed;
    EXPECT_EQ(seen_from(lamp, from, o).mean, 0.0);
    o.mode = ReferenceMode::direct;
    EXPECT_NEAR(seen_from(lamp, from, o).mean, 1.0, 1e-3);
}

} // namespace
} // namespace burnish::test
