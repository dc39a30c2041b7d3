#include <gtest/gtest.h>

#include <cstring>

#include "shading/bake/equirect.h"
#include "shading/bake/prefilter.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

constexpr double kTwoPi = 6.283185307179586;

TEST(Prefilter, SamplesEqualTheirTestVectors)
{
    const struct {
        double alpha_lin, x2, cos_h, n_dot_l, pdf, mip;
    } vectors[] = {{1.0 / 9, .5, .99992380, .99969521, 130.56673947, -.04758863},
                   {1.0 / 3, .25, .99794872, .99180328, 3.65565150, 2.53166891},
                   {5.0 / 9, .75, .88189470, .55547653, .08631638, 5.23384406}};
    for (const auto& v : vectors) {
        const PrefilterSample s = prefilter_sample(v.alpha_lin, v.x2, 1024, 512, 10);
        EXPECT_NEAR(s.cos_h, v.cos_h, 1e-8);
        EXPECT_NEAR(s.n_dot_l, v.n_dot_l, 1e-8);
        EXPECT_NEAR(s.pdf, v.pdf, 1e-7);
        EXPECT_NEAR(s.mip, v.mip, 1e-8);
    }
    EXPECT_NEAR(prefilter_sample(1.0, .5, 1024, 512, 10).n_dot_l, 0.0, 1e-15);
}

TEST(Prefilter, SampleListsAreUnitVectorsAboveTheHorizonWithWeightsThatSumToOne)
{
    for (const double alpha_lin : {0.125, 0.5, 1.0}) {
        const PrefilterSamples s = make_prefilter_samples(alpha_lin, 1024, 512, 9);
        double sum = 0.0, mean_x = 0.0, mean_y = 0.0;
        for (std::size_t i = 0; i < s.x.size(); ++i) {
            const double x = static_cast<double>(s.x[i]), y = static_cast<double>(s.y[i]),
                         z = static_cast<double>(s.z[i]);
            ASSERT_NEAR(x * x + y * y + z * z, 1.0, 1e-6);
            ASSERT_GT(z, 0.0);
            ASSERT_TRUE(s.level[i] >= 0 && s.level[i] <= 7 && s.fraction[i] >= 0.0f && s.fraction[i] <= 1.0f);
            sum += static_cast<double>(s.weight[i]);
            mean_x += static_cast<double>(s.weight[i]) * x;
            mean_y += static_cast<double>(s.weight[i]) * y;
        }
        EXPECT_NEAR(sum, 1.0, 1e-5);
        EXPECT_NEAR(mean_x, 0.0, 5e-3);
        EXPECT_NEAR(mean_y, 0.0, 5e-3);
    }
}

// An environment with detail: bands of a few degrees over the smooth colours.
double radiance(double x, double y, double z)
{
    return 1.0 + 0.8 * x + 0.3 * y * z + 0.6 * std::sin(9.0 * x + 4.0 * z) * std::cos(7.0 * y);
}

// The integral of radiance * D(h) n.l over the hemisphere around n, over that of D(h) n.l, in half-vector
// angles.
double brute_force(const double n[3], double alpha)
{
    const double t[3] = {n[1], n[2], n[0]}; // not parallel to n for the directions used
    double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    const double length = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    for (double& c : b)
        c /= length;
    const double a[3] = {b[1] * n[2] - b[2] * n[1], b[2] * n[0] - b[0] * n[2], b[0] * n[1] - b[1] * n[0]};
    double sum = 0.0, weights = 0.0;
    const int steps = 600;
    for (int j = 0; j < steps; ++j) {
        const double tan_h =
            std::tan((j + 0.5) / steps * kTwoPi / 8.0 * 0.999999); // up to 45 degrees: l at the horizon
        const double c2 = 1.0 / (1.0 + tan_h * tan_h), cos_l = 2.0 * c2 - 1.0, sin_l = 2.0 * c2 * tan_h;
        const double q = c2 * (alpha * alpha - 1.0) + 1.0, d = 1.0 / (q * q);
        const double weight = d * cos_l * sin_l; // dl = sin_l dtheta dphi, theta_l = 2 theta_h
        for (int i = 0; i < 256; ++i) {
            const double phi = (i + 0.5) / 256 * kTwoPi, x = sin_l * std::cos(phi), y = sin_l * std::sin(phi);
            double l[3];
            for (int c = 0; c < 3; ++c)
                l[c] = x * a[c] + y * b[c] + cos_l * n[c];
            sum += weight * radiance(l[0], l[1], l[2]);
            weights += weight;
        }
    }
    return sum / weights;
}

TEST(Prefilter, LevelsEqualTheIntegralOverTheHemisphere)
{
    const Image image = equirect_of(512, [](double x, double y, double z, float* rgb) {
        rgb[0] = rgb[1] = rgb[2] = static_cast<float>(radiance(x, y, z));
    });
    EnvironmentOptions o = small_bake();
    o.cube_size = 128;
    o.samples = 1024;
    const Result<Environment> e = bake_environment(image, "test", o, Jobs(2));
    ASSERT_TRUE(e);
    for (const int level : {1, 2, 3, 4}) {
        const double alpha_lin = static_cast<double>(level) / (e->specular.levels - 1);
        const int n = 128 >> level;
        for (int face = 0; face < 6; ++face) {
            const int x = n / 3, y = n / 5;
            Direction d = cube_direction(face, (x + 0.5) * 2.0 / n - 1.0, (y + 0.5) * 2.0 / n - 1.0);
            const double r = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), v[3] = {d.x / r, d.y / r, d.z / r};
            const double expected = brute_force(v, alpha_lin * alpha_lin);
            EXPECT_NEAR(static_cast<double>(cube_texel(e->specular, level, face, x, y, 0)), expected, 0.015)
                << "level " << level << " face " << face;
        }
    }
}

TEST(Prefilter, EveryInstructionSetAndSplitGivesTheSameBits)
{
    const Jobs jobs(1);
    std::vector<std::string> warnings;
    const CubeLevel level0 =
        equirect_to_cube(make_equirect(smooth_equirect(64), warnings), 32, 0.0, 1.0, jobs);
    CubeMap chain = make_cube_map(32, 2, 1.0f);
    store_cube_level(chain, 0, level0.rgb.data(), jobs);
    store_cube_level(chain, 1, half_cube_level(level0, jobs).rgb.data(), jobs);
    const PrefilterSamples samples = make_prefilter_samples(0.6, 200, 32, 2);
    const IrradianceSource source = make_irradiance_source(level0);
    const auto run = [&](const BakeFns& fns, int piece) {
        std::vector<float> out(2 * 6 * 64 * 3);
        for (int face = 0; face < 6; ++face)
            for (int first = 0; first < 64; first += piece) {
                float* to = out.data() + (face * 64 + first) * 3;
                fns.prefilter(samples.input(chain), face, 8, first, piece, to);
                fns.irradiance(source.input(), face, 8, first, piece, to + 6 * 64 * 3);
            }
        return out;
    };
    const std::vector<float> expected = run(bake_fns_of(0), 64);
    for (const int piece : {4, 16, 64}) {
        EXPECT_EQ(run(bake_fns_of(0), piece), expected);
        if (bake_isa_available(1)) {
            EXPECT_EQ(run(bake_fns_of(1), piece), expected);
        }
        if (bake_isa_available(2)) {
            EXPECT_EQ(run(bake_fns_of(2), piece), expected);
        }
    }
}

} // namespace
} // namespace burnish
