// Slope covariances: from roughness, anisotropy and a direction; from KHR_materials_anisotropy with and without a texture; filtered and
// mixed; and back to axes.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <gtest/gtest.h>
#include <numbers>

#include "shading/bake/mip/anisotropy.h"
#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

using Tensor = std::array<double, 3>; // xx, yy, xy

Tensor operator*(double s, Tensor t)
{
    return {s * t[0], s * t[1], s * t[2]};
}
Tensor mixed(Tensor a, Tensor b)
{
    return .5 * Tensor{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Tensor of_direction(double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * c, s * s, c * s};
}

// By definition the variances are alpha^2 / 2 along the direction and across it.
Tensor of_alphas(double along, double across, double angle)
{
    const Tensor d = of_direction(angle);
    const double v = .5 * across * across, extra = .5 * along * along - v;
    return {v + extra * d[0], v + extra * d[1], extra * d[2]};
}
Tensor by_definition_eta(double roughness, double eta, double angle)
{
    return of_alphas(roughness * roughness * (1 + eta), roughness * roughness * (1 - eta), angle);
}
Tensor by_definition_khr(double alpha, double strength, double angle)
{
    return of_alphas(alpha + (1 - alpha) * strength * strength, alpha, angle);
}

// Runs a kernel of the renderers. Results must be equal on every instruction set.
std::vector<double> run(const char* name, const std::vector<double>& in)
{
    const std::vector<double> scalar = call(float_fns()[0], name, in);
    for (const IsaFns& isa : float_fns())
        EXPECT_EQ(call(isa, name, in), scalar) << name;
    return scalar;
}
Tensor from_eta(double roughness, double eta, double turn, Tensor t)
{
    const std::vector<double> r = run("covariance_eta_tensor", {roughness, eta, std::cos(turn), std::sin(turn), t[0], t[1], t[2]});
    return {r[0], r[1], r[2]};
}
Tensor from_khr(double alpha, double strength, double turn, Tensor t2, Tensor t4)
{
    const std::vector<double> r =
        run("covariance_tensors", {alpha, strength, std::cos(turn), std::sin(turn), t2[0], t2[1], t2[2], t4[0], t4[1], t4[2]});
    return {r[0], r[1], r[2]};
}
const Tensor kNoTexture = {1, 0, 0};

struct Axes {
    double sigma_u, sigma_v, x, y, roughness, eta;
};
Axes axes_of(Tensor s)
{
    const std::vector<double> r = run("covariance_axes", {s[0], s[1], s[2]});
    return {r[0], r[1], r[2], r[3], r[4], r[5]};
}

void expect_near(Tensor a, Tensor b, double tolerance, const char* what)
{
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(a[k], b[k], tolerance) << what << " entry " << k;
}

// Bakes a texel with the file's red, green and blue.
Tensor texel(double r, double g, double b, int power, PixelType type = PixelType::f32)
{
    Image image = make_image(1, 1, 3, type);
    const double channels[] = {r, g, b};
    for (std::size_t c = 0; c < 3; ++c) {
        if (type == PixelType::f32) {
            const float value = static_cast<float>(channels[c]);
            std::memcpy(image.bytes.data() + c * sizeof value, &value, sizeof value);
        } else if (type == PixelType::u16) {
            const std::uint16_t value = static_cast<std::uint16_t>(std::lround(channels[c] * 65535));
            std::memcpy(image.bytes.data() + c * sizeof value, &value, sizeof value);
        } else {
            const std::uint8_t value = static_cast<std::uint8_t>(std::lround(channels[c] * 255));
            std::memcpy(image.bytes.data() + c, &value, 1);
        }
    }
    const Image out = anisotropy_tensor(image, power);
    const float* t = out.f32();
    return {static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])};
}

TEST(covariance, follows_roughness_anisotropy_and_direction)
{
    for (double eta : {-1.0, -.95, -.4, 0.0, .3, .95, 1.0})
        for (double roughness : {0.0, .001, .3, 1.0})
            for (double angle : {0.0, .3, 1.4, 2.9})
                for (double turn : {0.0, .7}) {
                    const Tensor expected = by_definition_eta(roughness, eta, angle + turn);
                    const double scale = expected[0] + expected[1];
                    expect_near(from_eta(roughness, eta, turn, of_direction(angle)), expected, 3e-7 * scale, "eta");
                }
}

TEST(covariance, deviations_are_those_of_the_test_vectors)
{
    const Axes a = axes_of(from_eta(.5, .8, 0, kNoTexture));
    EXPECT_NEAR(a.sigma_u, .31819805, 1e-7);
    EXPECT_NEAR(a.sigma_v, .03535534, 1e-6);
    EXPECT_NEAR(a.roughness, .5, 1e-6);
    EXPECT_NEAR(a.eta, .8, 1e-5);
    EXPECT_EQ(a.x, 1);
    const Axes narrow = axes_of(from_eta(.4, .5, 0, kNoTexture));
    EXPECT_NEAR(narrow.sigma_u, .16970563, 1e-7);
    EXPECT_NEAR(narrow.sigma_v, .05656854, 1e-7);
    const Axes crossed = axes_of(from_eta(.6, -.7, 0, kNoTexture)); // sorted: the axis turns by 90 degrees
    EXPECT_NEAR(crossed.sigma_u, .43274935, 1e-7);
    EXPECT_NEAR(crossed.sigma_v, .07636753, 1e-6);
    EXPECT_EQ(crossed.x, 0);
    EXPECT_EQ(crossed.y, 1);
}

TEST(covariance, decomposition_is_the_inverse)
{
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        const double angle = (i - 1000) * std::numbers::pi / 2001, eta = 0.02 + 0.9 * (i % 97) / 97.0;
        const Axes a = axes_of(from_eta(.4, eta, angle, kNoTexture));
        const double sine = a.x * std::sin(angle) - a.y * std::cos(angle);
        worst = std::max(worst, std::abs(sine) * eta);
        ASSERT_NEAR(a.roughness, .4, 1e-6);
        ASSERT_NEAR(a.eta, eta, 1e-4);
        ASSERT_GE(a.x, 0);
        ASSERT_NEAR(a.x * a.x + a.y * a.y, 1, 1e-6);
    }
    std::printf("axis of float covariances: error times eta %.3g rad\n", worst);
    EXPECT_LE(worst, 1e-6);
}

TEST(covariance, degenerate_matrices_have_axes)
{
    const Tensor bad[] = {{0, 0, 0},         {1e-3, 1e-3, 0},  {1e-3, 1e-3, 1e-20}, {1e-3, 2e-3, 1e-25},  {2e-3, 1e-3, -1e-25},
                          {0, 1e-3, 0},      {1e-3, 0, 0},     {1e-3, 1e-3, 2e-3},  {1e-3, 1e-3, -2e-3},  {1e-12, 1e-12, 1e-13},
                          {1e-30, 1e-35, 0}, {-1e-9, 1e-9, 0}, {0.5, 1e-9, 1e-5},   {1e-38, 2e-38, 1e-38}};
    for (const Tensor& m : bad) {
        const Axes a = axes_of(m);
        EXPECT_NEAR(a.x * a.x + a.y * a.y, 1, 1e-6) << m[0] << " " << m[1] << " " << m[2];
        const double mean = std::sqrt(std::max(0.0, 0.5 * (m[0] + m[1])));
        EXPECT_GE(a.sigma_v, std::min(0.7071e-3, 0.9999 * mean)); // a round lobe keeps its width, even a narrow one
        EXPECT_GE(a.sigma_u, a.sigma_v);
        EXPECT_LE(a.sigma_u, 1);
        EXPECT_TRUE(mean == 0.0 || (a.eta >= 0 && a.eta < 1)) << a.eta;
    }
    const Axes steep = axes_of({1e-3, 2e-3, 1e-25});
    EXPECT_EQ(steep.y, 1) << "the axis of the larger entry, though the other is lost in rounding";
}

// alpha_t = mix(alpha, 1, strength^2), alpha_b = alpha; rotation counter-clockwise from the tangent.
TEST(covariance, follows_khr_materials_anisotropy)
{
    for (double alpha : {0.0, 1e-6, .16, 1.0})
        for (double strength : {0.0, .001, .6, 1.0})
            for (double turn : {0.0, .5, 2.0, 4.0}) {
                const Tensor expected = by_definition_khr(alpha, strength, turn);
                const double scale = expected[0] + expected[1];
                expect_near(from_khr(alpha, strength, turn, kNoTexture, kNoTexture), expected, 3e-7 * scale, "khr");
            }
    const Axes turned = axes_of(from_khr(.16, .6, .5, kNoTexture, kNoTexture));
    EXPECT_NEAR(turned.sigma_u, (.16 + .84 * .36) / std::numbers::sqrt2, 1e-6);
    EXPECT_NEAR(turned.sigma_v, .16 / std::numbers::sqrt2, 1e-6);
    EXPECT_NEAR(turned.x, std::cos(.5), 1e-6);
    EXPECT_NEAR(turned.y, std::sin(.5), 1e-6);
    EXPECT_NEAR(axes_of(from_khr(.16, 0, .5, kNoTexture, kNoTexture)).eta, 0, 1e-5);
}

// Red and green turn the axis, and blue weakens the anisotropy, for every file type.
TEST(direction_map, texels_turn_and_weaken_the_axis)
{
    for (const auto& [type, step] : {std::pair{PixelType::f32, 1e-7}, {PixelType::u16, 1e-4}, {PixelType::u8, 8e-3}})
        for (double angle : {0.0, .3, 1.4, 2.9, -2.0})
            for (double blue : {0.0, .5, 1.0}) {
                const double r = .5 + .5 * std::cos(angle), g = .5 + .5 * std::sin(angle);
                const Tensor got = from_khr(.16, .6, .5, texel(r, g, blue, 2, type), texel(r, g, blue, 4, type));
                expect_near(got, by_definition_khr(.16, .6 * blue, .5 + angle), step, "texel");
            }
}

TEST(direction_map, length_of_a_direction_does_not_count)
{
    const Tensor full = texel(1, .5, .7, 2), faint = texel(.51, .5, .7, 2);
    expect_near(full, {.49, 0, 0}, 1e-7, "full");
    expect_near(faint, full, 2e-6, "faint");
}

// (128, 128) in eight bits encodes no direction.
TEST(direction_map, a_texel_without_direction_is_isotropic)
{
    const double nan = std::nan("");
    const Tensor none[] = {texel(.5, .5, 1, 2),
                           texel(128 / 255., 128 / 255., 1, 2, PixelType::u8),
                           texel(.5 + .003, .5 + .003, 1, 2),
                           texel(nan, .5, 1, 2),
                           texel(.5, HUGE_VAL, 1, 2),
                           texel(1, .5, nan, 2)};
    for (const Tensor& t2 : none) {
        expect_near(t2, {0, 0, 0}, 0, "tensor");
        const Tensor khr = from_khr(.25, 1, .4, t2, t2);
        EXPECT_NEAR(khr[0], .03125, 1e-8);
        EXPECT_EQ(khr[0], khr[1]);
        EXPECT_EQ(khr[2], 0);
        for (double eta : {.8, .99, 1.0, -.9}) {
            const Tensor s = from_eta(.5, eta, 0, t2);
            EXPECT_NEAR(s[0], .03125, 1e-8) << eta;
            EXPECT_EQ(s[0], s[1]);
            EXPECT_EQ(s[2], 0);
        }
    }
}

// Averaging two texels' tensors averages their covariances, so filtering tensors filters covariances.
TEST(direction_map, filtering_is_exact)
{
    const double alpha = .09, strength = .8, turn = .4;
    const auto of = [](double weight, double angle, int power) {
        return texel(.5 + .5 * std::cos(angle), .5 + .5 * std::sin(angle), weight, power);
    };
    const Tensor got = from_khr(alpha, strength, turn, mixed(of(.7, .3, 2), of(1, 2, 2)), mixed(of(.7, .3, 4), of(1, 2, 4)));
    expect_near(got, mixed(by_definition_khr(alpha, strength * .7, turn + .3), by_definition_khr(alpha, strength, turn + 2)), 1e-7, "mean");
}

// A direction and its opposite are one grain, and a grain of any strength turns an override's axis.
TEST(direction_map, strength_does_not_change_an_override)
{
    for (double angle : {0.0, .3, 1.4, 2.9})
        for (double strength : {.2, 1.0})
            for (double turn : {0.0, std::numbers::pi})
                expect_near(from_eta(.5, .8, 0, strength * strength * of_direction(angle + turn)), by_definition_eta(.5, .8, angle), 1e-7,
                            "override");
}

TEST(covariance, mixing_crossed_grains_gives_an_isotropic_surface)
{
    const Tensor m = mixed(from_eta(.5, .8, 0, kNoTexture), from_eta(.5, .8, std::numbers::pi / 2, kNoTexture));
    const Axes a = axes_of(m);
    EXPECT_NEAR(a.eta, 0, 1e-6);
    EXPECT_NEAR(a.sigma_u * a.sigma_u, .5 * (.31819805 * .31819805 + .03535534 * .03535534), 1e-8);
}

} // namespace
} // namespace burnish::test
