// The table of directional albedo of lobes of two widths, against dense quadrature in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;

const LobeAlbedoTable& table()
{
    static const LobeAlbedoTable t = bake_lobe_albedo(kLobeAlbedoSize, Jobs(2));
    return t;
}

struct Lobe {
    double alpha_x, alpha_y;
    double x, y, z; // to the eye, unit
};

Lobe lobe_of(double alpha_lin, double eta, double cosine, double azimuth_rad)
{
    const double alpha = alpha_lin * alpha_lin, sine = std::sqrt(1.0 - cosine * cosine);
    return {std::max(alpha * (1.0 + eta), 1e-3), std::max(alpha * (1.0 - eta), 1e-3), sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine};
}

struct Value {
    double scale, bias;
};

// The BRDF's integral over all normals, not the visible ones that the table is made from: slopes of length alpha r, of which
// r^2 / (1 + r^2) is uniform in [0,1], finer where they are steep. Schlick's Fresnel is split at F0.
Value integral(const Lobe& l, int n)
{
    const auto stretch = [&](double x, double y, double z) {
        return std::sqrt(l.alpha_x * x * l.alpha_x * x + l.alpha_y * y * l.alpha_y * y + z * z);
    };
    const double so = stretch(l.x, l.y, l.z);
    Value sum = {0.0, 0.0};
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < 2 * n; ++b) {
            const double rest = 1.0 - (a + 0.5) / n, u = 1.0 - rest * rest * rest, du = 3.0 * rest * rest;
            const double r = std::sqrt(u / (1.0 - u)), phi = kPi * (b + 0.5) / n;
            const double sx = l.alpha_x * r * std::cos(phi), sy = l.alpha_y * r * std::sin(phi), length = std::sqrt(sx * sx + sy * sy + 1.0);
            const double hx = sx / length, hy = sy / length, hz = 1.0 / length, o_dot_h = l.x * hx + l.y * hy + l.z * hz;
            const double ix = 2.0 * o_dot_h * hx - l.x, iy = 2.0 * o_dot_h * hy - l.y, iz = 2.0 * o_dot_h * hz - l.z;
            if (o_dot_h <= 0.0 || iz <= 0.0)
                continue;
            // D hz dh is the density of normals, dl = 4 o.h dh, and the BRDF is D / 2 / (iz so + oz si)
            const double weight = 4.0 * o_dot_h / hz * 0.5 / (iz * so + l.z * stretch(ix, iy, iz)) * iz * du;
            const double fresnel = std::pow(1.0 - std::min(o_dot_h, 1.0), 5.0);
            sum.scale += (1.0 - fresnel) * weight;
            sum.bias += fresnel * weight;
        }
    const double count = 2.0 * n * n;
    return {sum.scale / count, sum.bias / count};
}

std::vector<Value> lookup(const FilterOps& ops, const std::vector<Lobe>& lobes)
{
    const std::size_t n = (lobes.size() + 15) / 16 * 16;
    std::vector<float> in(5 * n, 0.25f), out(2 * n);
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        const Lobe& l = lobes[i];
        const double values[5] = {l.alpha_x * std::sqrt(0.5), l.alpha_y * std::sqrt(0.5), l.x, l.y, l.z};
        for (std::size_t k = 0; k < 5; ++k)
            in[k * n + i] = static_cast<float>(values[k]);
    }
    ops.lobe_albedo(table().texels.data(), table().size, in.data(), static_cast<int>(n), out.data());
    std::vector<Value> r;
    for (std::size_t i = 0; i < lobes.size(); ++i)
        r.push_back({static_cast<double>(out[2 * i]), static_cast<double>(out[2 * i + 1])});
    return r;
}

// Albedos fall to 0.25 here, and compensation divides by them: the relative error is what counts.
TEST(LobeAlbedo, IsNearTheIntegralForAllLobesAndViews)
{
    std::vector<Lobe> lobes;
    Random random(11);
    const auto in = [&](double lo, double hi) { return lo + (hi - lo) * random(); };
    for (int i = 0; i < 1500; ++i) {
        const double eta = i % 5 == 0 ? 0.95 : in(0.0, 0.95), cosine = in(0.05, i % 3 == 0 ? 0.3 : 1.0);
        lobes.push_back(lobe_of(in(0.1, 1.0), eta, cosine, i % 4 == 0 ? in(0.45, 0.5) * kPi : in(-kPi, kPi))); // many across the wide axis
    }
    const std::vector<Value> got = lookup(*available_filter_ops().back(), lobes);
    double largest = 0.0, relative = 0.0, squares = 0.0, of_bias = 0.0, least = 1.0;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        const Value truth = integral(lobes[i], 128);
        const double albedo = truth.scale + truth.bias, error = std::abs(got[i].scale + got[i].bias - albedo);
        largest = std::max(largest, error), relative = std::max(relative, error / albedo), squares += error / albedo * (error / albedo);
        of_bias = std::max(of_bias, std::abs(got[i].bias - truth.bias));
        least = std::min(least, albedo);
    }
    const double rms = std::sqrt(squares / static_cast<double>(lobes.size()));
    std::printf("albedo off by %.4f at most, relative %.4f, rms %.4f; bias by %.4f; least albedo %.3f\n", largest, relative, rms, of_bias, least);
    EXPECT_LT(largest, 0.015);
    EXPECT_LT(relative, 0.04);
    EXPECT_LT(rms, 0.005);
    EXPECT_LT(of_bias, 0.015);
    EXPECT_LT(least, 0.35);
}

TEST(LobeAlbedo, OfARoundLobeIsTheOtherTables)
{
    const DfgTable round = bake_dfg(64, 4096, Jobs(2));
    std::vector<Lobe> lobes;
    std::vector<float> cosines, roughnesses;
    for (double roughness : {0.15, 0.4, 0.65, 0.9, 1.0})
        for (double cosine : {1.0, 0.6, 0.3, 0.15})
            for (double azimuth : {0.0, 1.0, -1.57}) {
                lobes.push_back(lobe_of(roughness, 0.0, cosine, azimuth));
                cosines.push_back(static_cast<float>(cosine)), roughnesses.push_back(static_cast<float>(roughness));
            }
    cosines.resize(64), roughnesses.resize(64);
    float expected[128];
    const FilterOps& ops = bn_scalar::filter_ops();
    ops.dfg_lookup(round.texels.data(), round.size, cosines.data(), roughnesses.data(), 64, expected);
    const std::vector<Value> got = lookup(ops, lobes);
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        EXPECT_NEAR(got[i].scale, static_cast<double>(expected[2 * i]), 0.008) << cosines[i] << " " << roughnesses[i];
        EXPECT_NEAR(got[i].bias, static_cast<double>(expected[2 * i + 1]), 0.005) << cosines[i] << " " << roughnesses[i];
    }
}

TEST(LobeAlbedo, ThreadsAndInstructionSetsGiveTheSameBits)
{
    const LobeAlbedoTable a = bake_lobe_albedo(8, Jobs(1)), b = bake_lobe_albedo(8, Jobs(3));
    ASSERT_EQ(a.texels.size(), std::size_t{4 * 8 * 8 * 4 * 4});
    EXPECT_TRUE(std::equal(a.texels.begin(), a.texels.end(), b.texels.begin()));
    std::vector<Lobe> lobes;
    Random random(3);
    for (int i = 0; i < 256; ++i)
        lobes.push_back(lobe_of(random(), random(), random(), 7.0 * random()));
    const std::vector<Value> expected = lookup(bn_scalar::filter_ops(), lobes);
    for (const FilterOps* ops : available_filter_ops()) {
        const std::vector<Value> got = lookup(*ops, lobes);
        for (std::size_t i = 0; i < lobes.size(); ++i) {
            ASSERT_EQ(got[i].scale, expected[i].scale);
            ASSERT_EQ(got[i].bias, expected[i].bias);
        }
    }
}

TEST(LobeAlbedo, OfMirrorsThreadsAndViewsFromTheEdgeIsSound)
{
    const double nan = std::nan("");
    const std::vector<Lobe> lobes = {{0, 0, 0, 0, 1}, {0, 0, 1, 0, 0}, {2, 0, 0, 1, 0}, {2, 0, 0, 0, 1}, {2, 2, 0.6, 0, 0.8}, {1, 0, 0, 1, -0.1}, {nan, nan, nan, nan, nan}};
    for (const FilterOps* ops : available_filter_ops()) {
        const std::vector<Value> got = lookup(*ops, lobes);
        for (const Value& v : got) {
            EXPECT_GE(v.scale, 0.0);
            EXPECT_GE(v.bias, 0.0);
            EXPECT_LE(v.scale + v.bias, 1.0 + 1e-6);
        }
        EXPECT_NEAR(got[0].scale, 1.0, 1e-6); // a mirror seen from above
        EXPECT_NEAR(got[1].bias, 1.0, 1e-6);  // and from the edge
    }
}

} // namespace
} // namespace burnish
