// Random numbers become uniform and stratified points, and directions with their claimed densities.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raster/reference/light_sampling.h"
#include "raster/reference/samples.h"
#include "raster/reference/surface_bsdf.h"
#include "tests/unit/reference/chi_square.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

TEST(sobol, points_of_a_pass_are_stratified_whatever_the_seed)
{
    const SobolTable& table = sobol_table();
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        for (int d = 0; d < kSobolDimensions; ++d) {
            std::vector<int> hit(kPassSamples);
            for (int i = 0; i < kPassSamples; ++i)
                ++hit[static_cast<std::size_t>(owen_sobol(table, i, d, seed) * kPassSamples)];
            EXPECT_EQ(std::count(hit.begin(), hit.end(), 1), kPassSamples) << "dimension " << d;
        }
        for (int split = 0; split <= 6; ++split) { // (0, 6, 2)-net: every box of area 1/64, of any shape
            std::vector<int> hit(kPassSamples);
            const int nx = 1 << split, ny = kPassSamples / nx;
            for (int i = 0; i < kPassSamples; ++i) {
                const int x = static_cast<int>(owen_sobol(table, i, 0, seed) * static_cast<float>(nx));
                const int y = static_cast<int>(owen_sobol(table, i, 1, seed) * static_cast<float>(ny));
                ++hit[static_cast<std::size_t>(y * nx + x)];
            }
            EXPECT_EQ(std::count(hit.begin(), hit.end(), 1), kPassSamples) << nx << " x " << ny;
        }
        std::vector<int> order(kPassSamples), camera(kPassPositions);
        for (int i = 0; i < kPassSamples; ++i)
            ++order[static_cast<std::size_t>(shuffled(i, seed))];
        EXPECT_EQ(std::count(order.begin(), order.end(), 1), kPassSamples);
        for (int i = 0; i < kPassPositions; ++i) {
            const real2 p = camera_position(table, seed, i);
            ++camera[static_cast<std::size_t>(p.y * 4.0f) * 4 + static_cast<std::size_t>(p.x * 4.0f)];
        }
        EXPECT_EQ(std::count(camera.begin(), camera.end(), 1), kPassPositions);
    }
}

TEST(sobol, points_are_those_of_joe_and_kuo)
{
    const auto coordinate = [](int dimension, int index) {
        std::uint32_t x = 0;
        for (int b = 0; b < 32; ++b)
            x |= (sobol_table().points[dimension][index] >> b & 1u) << (31 - b);
        return static_cast<double>(x) * 0x1p-32;
    };
    // the first eight points in three dimensions, in the order of their binary index
    constexpr double kFirst[8][3] = {{0, 0, 0},          {.5, .5, .5},       {.25, .75, .75},    {.75, .25, .25},
                                     {.125, .625, .375}, {.625, .125, .875}, {.375, .375, .625}, {.875, .875, .125}};
    for (int i = 0; i < 8; ++i)
        for (int d = 0; d < 3; ++d)
            EXPECT_EQ(coordinate(d, i), kFirst[i][d]) << "point " << i << " dimension " << d;
    // Sobol's property A: every orthant of the five-dimensional cube holds one of the first 2^5 points
    std::vector<int> hit(32);
    for (int i = 0; i < 32; ++i) {
        unsigned orthant = 0;
        for (int d = 0; d < kSobolDimensions; ++d)
            orthant |= coordinate(d, i) >= 0.5 ? 1u << d : 0u;
        ++hit[orthant];
    }
    EXPECT_EQ(std::count(hit.begin(), hit.end(), 1), 32);
}

TEST(sobol, every_point_is_uniform_over_the_seeds_and_pairs_of_points_are_as_independent_as_nets_allow)
{
    const SobolTable& table = sobol_table();
    constexpr int kSeeds = 1 << 17, kBins = 16;
    double worst = 0.0;
    const auto test = [&](const auto& pair, const char* what) {
        std::vector<double> seen(kBins * kBins), expected(kBins * kBins, static_cast<double>(kSeeds) / (kBins * kBins));
        for (int s = 0; s < kSeeds; ++s) {
            const real2 p = pair(hash_seed(static_cast<std::uint32_t>(s), 77));
            ++seen[static_cast<std::size_t>(p.y * kBins) * kBins + static_cast<std::size_t>(p.x * kBins)];
        }
        const double sigmas = sigmas_of(seen, expected);
        worst = std::max(worst, std::abs(sigmas));
        EXPECT_LT(std::abs(sigmas), 4.5) << what;
    };
    for (int i : {0, 1, 7, 30, 63}) {
        const integer point = i;
        test([&](std::uint32_t s) { return vec2_of(owen_sobol(table, point, 0, s), owen_sobol(table, point, 1, s)); },
             "dimensions 0 and 1");
        test([&](std::uint32_t s) { return vec2_of(owen_sobol(table, point, 2, s), owen_sobol(table, point, 4, s)); },
             "dimensions 2 and 4");
        test(
            [&](std::uint32_t s) {
                return vec2_of(camera_position(table, s, point % 16).x, shade_sample(table, s, point % 16, 1, kPassShades, 0).light.x);
            },
            "camera and light");
        test(
            [&](std::uint32_t s) {
                return vec2_of(shade_sample(table, s, 3, 1, kPassShades, 0).lobe.x, shade_sample(table, s, 3, 1, kPassShades, 1).lobe.x);
            },
            "vertex 0 and 1");
        test([&](std::uint32_t s) { return vec2_of(owen_sobol(table, point, 0, s), owen_sobol(table, point, 0, hash_seed(s, 5))); },
             "two passes");
    }
    std::printf("worst of 25 chi-squares: %.2f sigma\n", worst);
}

glm::vec3 sky(const glm::vec3& d)
{
    glm::vec3 c(0.3f + 0.3f * d.y, 0.4f, 0.5f);
    if (glm::dot(d, glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f))) > 0.995f)
        c = glm::vec3(400.0f, 300.0f, 200.0f);
    if (d.x < -0.5f)
        c = glm::vec3(0.0f);
    return c;
}

TEST(environment_sampler, directions_follow_the_density_and_miss_no_light)
{
    const Jobs jobs(1);
    const Environment environment = environment_of(sky, 32, jobs);
    const EnvironmentSampler s = make_environment_sampler(environment.specular, jobs);
    constexpr int kSide = 16, kFine = 8, kSamples = 1 << 19; // bins along a face's side; quadrature points along a bin's side
    std::vector<double> seen(6 * kSide * kSide), expected(6 * kSide * kSide);
    double integral = 0.0, mean = 0.0;
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < kSide * kFine; ++y)
            for (int x = 0; x < kSide * kFine; ++x) {
                const float u = (static_cast<float>(x) + 0.5f) / (kSide * kFine) * 2.0f - 1.0f;
                const float v = (static_cast<float>(y) + 0.5f) / (kSide * kFine) * 2.0f - 1.0f;
                const float sign = face & 1 ? -1.0f : 1.0f;
                const real3 d = face < 2   ? vec3_of(sign, -v, -u * sign)
                                : face < 4 ? vec3_of(u, sign, v * sign)
                                           : vec3_of(u * sign, -v, sign);
                const double r2 = 1.0 + static_cast<double>(u * u + v * v);
                const double solid = 4.0 / (kSide * kFine * kSide * kFine) / (r2 * std::sqrt(r2));
                const double p = static_cast<double>(environment_pdf(s.view, d)) * solid;
                integral += p;
                expected[static_cast<std::size_t>((face * kSide + y / kFine) * kSide + x / kFine)] += p * kSamples;
                const real3 c =
                    cube_sample_level({environment.specular.texels.data(), environment.specular.size, environment.specular.levels}, d, 0);
                const double light = static_cast<double>(c.x * 0.2126f + c.y * 0.7152f + c.z * 0.0722f) * solid;
                mean += light;
                if (light > 0.0) {
                    EXPECT_GT(p, 0.0) << "light that is never sampled";
                }
            }
    EXPECT_NEAR(integral, 1.0, 1e-5);
    EXPECT_NEAR(s.mean_luminance, mean * static_cast<double>(environment.specular.scale) / (4.0 * 3.14159265358979),
                2e-3 * s.mean_luminance);
    Random random{11};
    for (int i = 0; i < kSamples; ++i) {
        const float a = random.unit(), b = random.unit();
        const LightSample l = sample_environment(s.view, vec2_of(a, b));
        const cube_place p = cube_face_uv(l.wi);
        const int x = std::min(static_cast<int>(p.u * kSide), kSide - 1), y = std::min(static_cast<int>(p.v * kSide), kSide - 1);
        ++seen[static_cast<std::size_t>((p.face * kSide + y) * kSide + x)];
        if (i % 64 == 0) {
            EXPECT_NEAR(k_length3(l.wi), 1.0f, 1e-5f);
            const float claimed = environment_pdf(s.view, l.wi * (1.0f + 3.0f * b));
            if (std::abs(p.u * 32.0f - std::round(p.u * 32.0f)) > 1e-3f && std::abs(p.v * 32.0f - std::round(p.v * 32.0f)) > 1e-3f) {
                EXPECT_NEAR(l.pdf, claimed, 1e-4f * claimed);
            }
        }
    }
    EXPECT_LT(std::abs(sigmas_of(seen, expected)), 4.5);
}

TEST(environment_sampler, black_is_sampled_evenly)
{
    const Jobs jobs(1);
    const Environment environment = environment_of([](const glm::vec3&) { return glm::vec3(0.0f); }, 16, jobs);
    const EnvironmentSampler s = make_environment_sampler(environment.specular, jobs);
    const LightSample l = sample_environment(s.view, vec2_of(0.3f, 0.7f));
    EXPECT_TRUE(std::isfinite(l.pdf) && l.pdf > 0.0f);
    EXPECT_EQ(s.mean_luminance, 0.0);
}

SurfaceBsdf surface_bsdf_of(float f0, float diffuse, float sigma_u, float sigma_v, real3 v, bool tilted = false)
{
    ShadingFrame f = {};
    f.lobe = lobe_with(tilted ? kTiltedLobe : kDefaultLobe), f.lobe_traits = lobe_traits_of(f.lobe);
    shaded_point x = {};
    x.geometric_axes = {{0, 0, 1}, {0.6f, 0.8f, 0.0f}, {-0.8f, 0.6f, 0.0f}};
    const surface_frame frame = tilted ? tilted_frame(x.geometric_axes, {0.94f, 0.96f}, {0.341174f, -0.28f}) : x.geometric_axes;
    x.s = metallic_roughness_surface({0, 0, 1}, k_normalize3(v), vec3_all(diffuse), 0.0f, 0.5f, vec3_all(f0), 1.0f, 1.0f);
    x.s.n = frame.n;
    x.lobe = {frame.t, frame.b, sigma_u, sigma_v};
    x.has_surface_horizon = tilted, x.diffuse = true;
    x.energy.dfg = {0.8f, 0.02f}, x.energy.gain = vec3_all(1.0f);
    x.dielectric_f0 = vec3_all(f0), x.dielectric_f90 = 1.0f;
    real reflected;
    return make_surface_bsdf(f, x, reflected);
}

TEST(surface_bsdf, samples_follow_their_density_and_weigh_value_over_it)
{
    constexpr int kZ = 16, kPhi = 24, kFine = 24, kSamples = 1 << 18;
    const SurfaceBsdf cases[] = {
        surface_bsdf_of(0.04f, 0.5f, 0.3f, 0.05f, {0.5f, 0.1f, 0.8f}), surface_bsdf_of(0.9f, 0.0f, 0.4f, 0.1f, {-0.7f, 0.6f, 0.3f}),
        surface_bsdf_of(0.5f, 0.5f, 0.15f, 0.15f, {0.0f, 0.0f, 1.0f}), surface_bsdf_of(0.9f, 0.0f, 0.4f, 0.1f, {-0.5f, 0.6f, 0.5f}, true)};
    for (const SurfaceBsdf& r : cases) {
        std::vector<double> seen(kZ * kPhi + 1), expected(kZ * kPhi + 1);
        double albedo = 0.0, inside = 0.0;
        for (int a = 0; a < kZ * kFine; ++a)
            for (int b = 0; b < kPhi * kFine; ++b) {
                const float z = (static_cast<float>(a) + 0.5f) / (kZ * kFine),
                            phi = (static_cast<float>(b) + 0.5f) / (kPhi * kFine) * 6.2831853f;
                const float c = std::sqrt(1.0f - z * z);
                const Reflection at = reflect(r, {c * std::cos(phi), c * std::sin(phi), z});
                const double solid = 6.283185307179586 / (kZ * kFine) / (kPhi * kFine);
                expected[static_cast<std::size_t>(a / kFine * kPhi + b / kFine)] += static_cast<double>(at.pdf) * solid * kSamples;
                inside += static_cast<double>(at.pdf) * solid;
                albedo += static_cast<double>(at.value.x) * solid;
            }
        expected.back() = (1.0 - inside) * kSamples; // samples that end below the horizon
        EXPECT_LT(inside, 1.001);
        Random random{5};
        double sum = 0.0, square = 0.0;
        for (int i = 0; i < kSamples; ++i) {
            const float x = random.unit(), y = random.unit(), choice = random.unit();
            const SurfaceBsdfSample s = sample_surface_bsdf(r, vec2_of(x, y), choice);
            const double w = static_cast<double>(s.weight.x);
            sum += w, square += w * w;
            if (!(s.wi.z > 0.0f)) {
                EXPECT_EQ(w, 0.0);
                ++seen.back();
                continue;
            }
            float phi = std::atan2(s.wi.y, s.wi.x) / 6.2831853f;
            phi -= std::floor(phi);
            const int a = std::min(static_cast<int>(s.wi.z * kZ), kZ - 1), b = std::min(static_cast<int>(phi * kPhi), kPhi - 1);
            ++seen[static_cast<std::size_t>(a * kPhi + b)];
        }
        EXPECT_LT(std::abs(sigmas_of(seen, expected)), 5.0);
        const double mean = sum / kSamples, deviation = std::sqrt((square / kSamples - mean * mean) / kSamples);
        EXPECT_NEAR(mean, albedo, 4.5 * deviation + 1e-3 * albedo);
    }
}

} // namespace
} // namespace burnish::test
