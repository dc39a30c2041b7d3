// The directional albedo table of anisotropic lobes, against dense quadrature in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Lobe {
    double alpha_x, alpha_y;
    double x, y, z; // to the eye, unit
};

Lobe lobe_of(double roughness, double eta, double cosine, double azimuth_rad)
{
    const double alpha = roughness * roughness, sine = std::sqrt(1.0 - cosine * cosine);
    return {std::max(alpha * (1.0 + eta), 1e-3), std::max(alpha * (1.0 - eta), 1e-3), sine * std::cos(azimuth_rad),
            sine * std::sin(azimuth_rad), cosine};
}

struct Albedo {
    double scale, bias;
};

// Integrates the BRDF over all normals, while the table uses visible normals. Slopes have length alpha r, where r^2 / (1 + r^2) is uniform
// in [0,1], finer where they are steep. Schlick's Fresnel is split at F0.
Albedo integral(const Lobe& l, int n)
{
    const auto stretch = [&](double x, double y, double z) {
        return std::sqrt(l.alpha_x * x * l.alpha_x * x + l.alpha_y * y * l.alpha_y * y + z * z);
    };
    const double so = stretch(l.x, l.y, l.z);
    Albedo sum = {0.0, 0.0};
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < 2 * n; ++b) {
            const double rest = 1.0 - (a + 0.5) / n, u = 1.0 - rest * rest * rest, du = 3.0 * rest * rest;
            const double r = std::sqrt(u / (1.0 - u)), phi = kPi * (b + 0.5) / n;
            const double sx = l.alpha_x * r * std::cos(phi), sy = l.alpha_y * r * std::sin(phi),
                         length = std::sqrt(sx * sx + sy * sy + 1.0);
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

std::vector<Albedo> lookup(const IsaFns& isa, const char* name, const float* pairs, const std::vector<Lobe>& lobes)
{
    const std::size_t n = lobes.size();
    std::vector<double> in(5 * n);
    for (std::size_t i = 0; i < n; ++i) {
        const Lobe& l = lobes[i];
        const double values[5] = {l.alpha_x * std::sqrt(0.5), l.alpha_y * std::sqrt(0.5), l.x, l.y, l.z};
        for (std::size_t k = 0; k < 5; ++k)
            in[k * n + i] = values[k];
    }
    const std::vector<double> out = test::call(isa, name, in, {.pairs = pairs, .size = kLobeAlbedoSize});
    std::vector<Albedo> r;
    for (std::size_t i = 0; i < n; ++i)
        r.push_back({out[i], out[n + i]});
    return r;
}

std::vector<Albedo> lookup(const IsaFns& isa, const std::vector<Lobe>& lobes)
{
    return lookup(isa, "lobe_albedo", lobe_albedo_pairs(), lobes);
}

std::vector<Albedo> lookup_slice(const IsaFns& isa, const float* slice, const std::vector<Lobe>& lobes)
{
    return lookup(isa, "lobe_slice", slice, lobes);
}

// Albedos fall to 0.25 here and compensation divides by them, so the relative error counts.
TEST(lobe_albedo, is_near_the_integral_for_all_lobes_and_views)
{
    std::vector<Lobe> lobes;
    Random random(11);
    const auto in = [&](double lo, double hi) { return lo + (hi - lo) * random(); };
    for (int i = 0; i < 1500; ++i) {
        const double eta = i % 5 == 0 ? 0.95 : in(0.0, 0.95), cosine = in(0.05, i % 3 == 0 ? 0.3 : 1.0);
        lobes.push_back(lobe_of(in(0.1, 1.0), eta, cosine, i % 4 == 0 ? in(0.45, 0.5) * kPi : in(-kPi, kPi))); // many across the wide axis
    }
    const std::vector<Albedo> got = lookup(float_fns().back(), lobes);
    double largest = 0.0, relative = 0.0, squares = 0.0, of_bias = 0.0, least = 1.0;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        const Albedo reference = integral(lobes[i], 128);
        const double albedo = reference.scale + reference.bias, error = std::abs(got[i].scale + got[i].bias - albedo);
        largest = std::max(largest, error), relative = std::max(relative, error / albedo), squares += error / albedo * (error / albedo);
        of_bias = std::max(of_bias, std::abs(got[i].bias - reference.bias));
        least = std::min(least, albedo);
    }
    const double rms = std::sqrt(squares / static_cast<double>(lobes.size()));
    std::printf("albedo off by %.4f at most, relative %.4f, rms %.4f; bias by %.4f; least albedo %.3f\n", largest, relative, rms, of_bias,
                least);
    EXPECT_LT(largest, 0.015);
    EXPECT_LT(relative, 0.04);
    EXPECT_LT(rms, 0.005);
    EXPECT_LT(of_bias, 0.015);
    EXPECT_LT(least, 0.35);
}

TEST(lobe_albedo, of_a_round_lobe_is_the_other_tables)
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
    std::vector<float> in = cosines;
    in.insert(in.end(), roughnesses.begin(), roughnesses.end());
    const std::vector<float> expected = results(float_fns()[0], "dfg_lookup", in, {.pairs = round.pairs.data(), .size = round.size});
    const std::vector<Albedo> got = lookup(float_fns()[0], lobes);
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        EXPECT_NEAR(got[i].scale, static_cast<double>(expected[2 * i]), 0.008) << cosines[i] << " " << roughnesses[i];
        EXPECT_NEAR(got[i].bias, static_cast<double>(expected[2 * i + 1]), 0.005) << cosines[i] << " " << roughnesses[i];
    }
}

TEST(lobe_albedo, threads_and_instruction_sets_give_the_same_bits)
{
    const Column<float> a = bake_lobe_albedo(8, Jobs(1)), b = bake_lobe_albedo(8, Jobs(3));
    ASSERT_EQ(a.size(), std::size_t{2 * 8 * 8 * 4 * 4});
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin()));
    std::vector<Lobe> lobes;
    Random random(3);
    for (int i = 0; i < 256; ++i)
        lobes.push_back(lobe_of(random(), random(), random(), 7.0 * random()));
    const std::vector<Albedo> expected = lookup(float_fns()[0], lobes);
    for (const IsaFns& isa : float_fns()) {
        const std::vector<Albedo> got = lookup(isa, lobes);
        for (std::size_t i = 0; i < lobes.size(); ++i) {
            ASSERT_EQ(got[i].scale, expected[i].scale);
            ASSERT_EQ(got[i].bias, expected[i].bias);
        }
    }
}

TEST(lobe_albedo, of_the_program_is_the_one_that_is_baked_here)
{
    const Column<float> baked = bake_lobe_albedo(kLobeAlbedoSize, Jobs(2));
    ASSERT_GE(lobe_albedo_bytes(), baked.size() * sizeof baked[0]);
    EXPECT_TRUE(std::equal(baked.begin(), baked.end(), lobe_albedo_pairs()));
}

// A slice knows its lobe's widths exactly and interpolates its two axes alone.
TEST(lobe_albedo, slices_are_near_the_integral_of_their_lobe)
{
    Random random(5);
    const auto in = [&](double lo, double hi) { return lo + (hi - lo) * random(); };
    double largest = 0.0, squares = 0.0;
    constexpr int kLobes = 24, kViews = 32;
    for (int i = 0; i < kLobes; ++i) {
        const double roughness = in(0.1, 1.0), eta = in(0.0, 0.95);
        Column<float> slice;
        slice.resize(2 * kLobeSliceSize * kLobeSliceSize / 2);
        std::vector<Lobe> lobes;
        for (int k = 0; k < kViews; ++k)
            lobes.push_back(lobe_of(roughness, eta, in(0.05, 1.0), in(-kPi, kPi)));
        bake_lobe_slice(lobes[0].alpha_x, lobes[0].alpha_y, slice.data());
        const std::vector<Albedo> first = lookup_slice(float_fns().front(), slice.data(), lobes);
        for (const IsaFns& isa : float_fns()) {
            const std::vector<Albedo> got = lookup_slice(isa, slice.data(), lobes);
            for (std::size_t k = 0; k < lobes.size(); ++k) {
                ASSERT_EQ(got[k].scale, first[k].scale);
                ASSERT_EQ(got[k].bias, first[k].bias);
            }
        }
        for (std::size_t k = 0; k < lobes.size(); ++k) {
            const Albedo reference = integral(lobes[k], 96);
            const double error = first[k].scale + first[k].bias - reference.scale - reference.bias;
            largest = std::max(largest, std::abs(error)), squares += error * error;
        }
    }
    std::printf("slices: off by %.4f at most, rms %.4f\n", largest, std::sqrt(squares / (kLobes * kViews)));
    EXPECT_LT(largest, 0.005);
    EXPECT_LT(std::sqrt(squares / (kLobes * kViews)), 0.0014);
}

TEST(lobe_albedo, of_mirrors_threads_and_views_from_the_edge_is_sound)
{
    const double nan = std::nan("");
    const std::vector<Lobe> lobes = {{0, 0, 0, 0, 1},     {0, 0, 1, 0, 0},    {2, 0, 0, 1, 0},          {2, 0, 0, 0, 1},
                                     {2, 2, 0.6, 0, 0.8}, {1, 0, 0, 1, -0.1}, {nan, nan, nan, nan, nan}};
    for (const IsaFns& isa : float_fns()) {
        const std::vector<Albedo> got = lookup(isa, lobes);
        for (const Albedo& v : got) {
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
