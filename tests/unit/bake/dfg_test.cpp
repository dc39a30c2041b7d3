#include <gtest/gtest.h>

#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

const DfgTable& table()
{
    static const DfgTable t = bake_dfg(64, 1024, Jobs(2));
    return t;
}

float scale_at(const DfgTable& t, std::size_t i)
{
    return t.pairs[2 * i];
}
float bias_at(const DfgTable& t, std::size_t i)
{
    return t.pairs[2 * i + 1];
}

struct Value {
    float scale, bias;
};
Value lookup(const DfgTable& t, float roughness, float n_dot_v)
{
    const std::vector<float> out = results(float_fns()[0], "dfg_lookup", {n_dot_v, roughness}, {.pairs = t.pairs.data(), .size = t.size});
    return {out[0], out[1]};
}

TEST(dfg, equals_known_albedos)
{
    const struct {
        float roughness, n_dot_v, scale, bias;
    } known[] = {{0.2f, 0.5f, 0.963f, 0.032f}, {0.5f, 0.3f, 0.772f, 0.065f}, {0.9f, 0.8f, 0.453f, 0.001f}};
    for (const auto& k : known) {
        const Value v = lookup(table(), k.roughness, k.n_dot_v);
        EXPECT_NEAR(v.scale, k.scale, 0.002f);
        EXPECT_NEAR(v.bias, k.bias, 0.002f);
    }
}

TEST(dfg, converges_to_the_integral_over_light_directions)
{
    // A second integral, over the hemisphere of light directions: D G2 (n.l) / (4 n.v n.l) dl.
    const double alpha = 0.36, n_dot_v = 0.5; // roughness 0.6
    const double vx = std::sqrt(1.0 - n_dot_v * n_dot_v), a2 = alpha * alpha;
    const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1.0 + a2 * (1.0 - c * c) / (c * c)) - 1.0); };
    double scale = 0.0, bias = 0.0;
    const int n = 1000;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double lz = (j + 0.5) / n, phi = (i + 0.5) / n * 6.283185307179586, rho = std::sqrt(1.0 - lz * lz);
            const double hx = vx + rho * std::cos(phi), hy = rho * std::sin(phi), hz = n_dot_v + lz;
            const double h2 = hx * hx + hy * hy + hz * hz, nh2 = hz * hz / h2;
            const double v_dot_h = (vx * hx + n_dot_v * hz) / std::sqrt(h2);
            const double q = nh2 * (a2 - 1.0) + 1.0, d = a2 / (3.141592653589793 * q * q);
            const double f = d / (1.0 + lambda(n_dot_v) + lambda(lz)) / (4.0 * n_dot_v) * 6.283185307179586 / (n * double(n));
            const double fresnel = std::pow(1.0 - v_dot_h, 5.0);
            scale += (1.0 - fresnel) * f;
            bias += fresnel * f;
        }
    const DfgTable t = bake_dfg(11, 4096, Jobs(1)); // row 6, column 5
    EXPECT_NEAR(static_cast<double>(scale_at(t, 6 * 11 + 5)), scale, 2e-4);
    EXPECT_NEAR(static_cast<double>(bias_at(t, 6 * 11 + 5)), bias, 2e-4);
}

TEST(dfg, never_gains_energy_and_starts_at_the_mirror)
{
    const DfgTable& t = table();
    const std::size_t n = static_cast<std::size_t>(t.size);
    for (std::size_t i = 0; i < n * n; ++i) {
        ASSERT_GE(scale_at(t, i), 0.0f);
        ASSERT_GE(bias_at(t, i), 0.0f);
        ASSERT_LE(scale_at(t, i) + bias_at(t, i), 1.0f + 1e-6f);
    }
    for (std::size_t x = 4; x < n; ++x) { // roughness 0: the Fresnel factor
        const float m = 1.0f - static_cast<float>(x) / 63.0f;
        EXPECT_NEAR(bias_at(t, x), m * m * m * m * m, 1e-3f);
        EXPECT_NEAR(scale_at(t, x) + bias_at(t, x), 1.0f, 1e-3f);
    }
}

TEST(dfg, lookup_interpolates_and_clamps)
{
    const DfgTable& t = table();
    EXPECT_NEAR(lookup(t, 0.0f, 1.0f).scale, scale_at(t, 63), 1e-6f);
    EXPECT_NEAR(lookup(t, 1.0f, 1.0f).scale, scale_at(t, 63 * 64 + 63), 1e-6f);
    EXPECT_NEAR(lookup(t, 7.0f, -3.0f).bias, bias_at(t, 63 * 64), 1e-6f);
    EXPECT_NEAR(lookup(t, NAN, NAN).bias, bias_at(t, 0), 1e-6f);
    const float middle =
        0.25f * (scale_at(t, 10 * 64 + 20) + scale_at(t, 10 * 64 + 21) + scale_at(t, 11 * 64 + 20) + scale_at(t, 11 * 64 + 21));
    EXPECT_NEAR(lookup(t, 10.5f / 63.0f, 20.5f / 63.0f).scale, middle, 2e-6f);
}

TEST(dfg, fit_equals_its_test_vectors)
{
    const struct {
        float roughness, n_dot_v, scale, bias;
    } vectors[] = {{0.2f, 0.5f, .91772582f, .07910979f},
                   {0.5f, 0.3f, .85421360f, .11662912f},
                   {0.9f, 0.8f, .62035780f, .00218220f},
                   {1.0f, .05f, .62981349f, .04903651f},
                   {0.0f, 1.0f, .99218750f, .00781250f}};
    for (const auto& v : vectors) {
        const std::vector<float> out = results(float_fns()[0], "dfg_fit", {v.n_dot_v, v.roughness});
        EXPECT_NEAR(out[0], v.scale, 1e-6f);
        EXPECT_NEAR(out[1], v.bias, 1e-6f);
    }
}

TEST(dfg, threads_and_instruction_sets_give_the_same_bits)
{
    const DfgTable a = bake_dfg(16, 64, Jobs(1)), b = bake_dfg(16, 64, Jobs(3));
    for (std::size_t i = 0; i < a.pairs.size(); ++i)
        ASSERT_EQ(a.pairs[i], b.pairs[i]);
    Random random(5);
    std::vector<float> in(128); // n.v, roughness
    for (float& x : in)
        x = random.in(-0.1, 1.1);
    const TexelView view = {.pairs = a.pairs.data(), .size = a.size};
    for (const IsaFns& isa : float_fns())
        ASSERT_EQ(results(isa, "dfg_lookup", in, view), results(float_fns()[0], "dfg_lookup", in, view)) << isa.name;
}

} // namespace
} // namespace burnish
