// The contract of every surface lobe (BN_LOBE in shading/models.def): value, density, sample and albedo agree.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "raster/reference/samples.h"
#include "shading/surface/bsdf_lobe.t.h"
#include "tests/unit/reference/chi_square.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

struct LobeLine {
    const char* name;
    int place, traits;
};
constexpr LobeLine kLobes[] = {
#define BN_LOBE(id, at, type, lies, normals, traits, made_of) {#id, at, lobe_traits_of(at)},
#include "shading/models.def"
};

// Places a lobe on a surface whose axes are not aligned with coordinates. tilt: sines of the lobe normal's tilt, if it can tilt.
bsdf_lobe lobe_on_surface(const LobeLine& line, float alpha_u, float alpha_v, real3 eye, real2 tilt = {0.0f, 0.0f})
{
    const surface_frame axes = {{0, 0, 1}, {0.6f, 0.8f, 0.0f}, {-0.8f, 0.6f, 0.0f}};
    const surface_frame f =
        tilted_frame(axes, vec2_of(std::sqrt(1.0f - tilt.x * tilt.x), std::sqrt(1.0f - tilt.y * tilt.y)), vec2_of(tilt.x, tilt.y));
    const aniso_lobe lobe = {f.t, f.b, alpha_u * 0.70710678f, alpha_v * 0.70710678f};
    return make_bsdf_lobe(line.place, lobe, f.n, k_normalize3(eye), axes);
}

real3 direction_at(double z, double phi)
{
    const double c = std::sqrt(1.0 - z * z);
    return {static_cast<float>(c * std::cos(phi)), static_cast<float>(c * std::sin(phi)), static_cast<float>(z)};
}

constexpr int kZ = 16, kPhi = 24, kFine = 12; // bins of the hemisphere, and points along each side of a bin

struct Integral {
    double albedo = 0.0, inside = 0.0;
    std::vector<double> share = std::vector<double>(kZ * kPhi + 1); // part of samples in each bin; the last bin holds rejected samples
};

Integral integral_of(const bsdf_lobe& lobe)
{
    Integral sum;
    const double solid = 6.283185307179586 / (kZ * kFine) / (kPhi * kFine);
    for (int a = 0; a < kZ * kFine; ++a)
        for (int b = 0; b < kPhi * kFine; ++b) {
            const real3 wi = direction_at((a + 0.5) / (kZ * kFine), (b + 0.5) / (kPhi * kFine) * 6.283185307179586);
            const double pdf = static_cast<double>(bsdf_lobe_pdf(lobe, wi)) * solid;
            sum.albedo += static_cast<double>(bsdf_lobe_eval_cos(lobe, wi)) * solid;
            sum.share[static_cast<std::size_t>(a / kFine * kPhi + b / kFine)] += pdf;
            sum.inside += pdf;
        }
    sum.share.back() = 1.0 - sum.inside;
    return sum;
}

// Calls check for widths that the integrals resolve, and for views from above to grazing.
template <class Check> void for_each_lobe(Check check)
{
    for (const LobeLine& line : kLobes)
        for (const real2 alpha : {real2{0.5f, 0.2f}, real2{0.3f, 0.3f}, real2{0.7f, 0.4f}})
            for (const real3 eye : {real3{0.0f, 0.0f, 1.0f}, real3{0.5f, 0.1f, 0.8f}, real3{-0.7f, 0.6f, 0.35f}})
                for (const float tilt : {0.0f, 0.3f}) {
                    if (tilt != 0.0f && !(line.traits & kLies_surface))
                        continue;
                    SCOPED_TRACE(std::string(line.name) + " " + std::to_string(alpha.x) + " " + std::to_string(alpha.y) + " eye " +
                                 std::to_string(eye.x) + " tilt " + std::to_string(tilt));
                    check(lobe_on_surface(line, alpha.x, alpha.y, eye, {tilt, -0.5f * tilt}));
                }
}

TEST(lobe, has_the_albedo_that_its_values_add_up_to)
{
    for_each_lobe([](const bsdf_lobe& lobe) {
        if (lobe_has(lobe.model, kPunctualOnly))
            return;
        const Integral whole = integral_of(lobe);
        const double off = lobe_has(lobe.model, kPhongLobe) ? 0.02 : 0.07;
        EXPECT_NEAR(static_cast<double>(bsdf_lobe_own_energy(lobe).albedo), whole.albedo, off * std::max(1.0, whole.albedo));
        EXPECT_GT(whole.albedo, lobe_has(lobe.model, kBroadLobe) ? 0.02 : 0.05);
    });
}

TEST(lobe, samples_follow_their_density_and_weigh_value_over_it)
{
    constexpr int kSamples = 1 << 15;
    for_each_lobe([](const bsdf_lobe& lobe) {
        const Integral whole = integral_of(lobe);
        EXPECT_LT(whole.inside, 1.002);
        std::vector<double> seen(whole.share.size()), expected = whole.share;
        for (double& e : expected)
            e *= kSamples;
        Random random{5};
        double sum = 0.0, square = 0.0;
        for (int i = 0; i < kSamples; ++i) {
            const float x = random.unit(), y = random.unit();
            const bsdf_sample s = bsdf_lobe_sample(lobe, vec2_of(x, y));
            const double w = static_cast<double>(s.weight);
            sum += w, square += w * w;
            if (!s.valid) {
                EXPECT_EQ(w, 0.0);
                ++seen.back();
                continue;
            }
            if (i % 16 == 0) {
                const float pdf = bsdf_lobe_pdf(lobe, s.wi), value = bsdf_lobe_eval_cos(lobe, s.wi);
                EXPECT_NEAR(pdf, s.pdf, 1e-2f * s.pdf + 1e-4f);
                EXPECT_NEAR(value, s.weight * s.pdf, 2e-2f * value + 1e-4f);
            }
            float phi = std::atan2(s.wi.y, s.wi.x) / 6.2831853f;
            phi -= std::floor(phi);
            const int a = std::min(static_cast<int>(s.wi.z * kZ), kZ - 1), b = std::min(static_cast<int>(phi * kPhi), kPhi - 1);
            ++seen[static_cast<std::size_t>(a * kPhi + b)];
        }
        EXPECT_LT(std::abs(sigmas_of(seen, expected)), 5.5);
        const double mean = sum / kSamples, deviation = std::sqrt((square / kSamples - mean * mean) / kSamples);
        EXPECT_NEAR(mean, whole.albedo, 5.0 * deviation + 2e-3 * whole.albedo);
    });
}

// The albedo of a lobe decreases as it tilts away from the eye. A mirror's albedo is the limit of a narrow lobe's.
TEST(lobe, leaves_less_the_farther_it_is_tilted_away)
{
    for (const LobeLine& line : kLobes) {
        if (!(line.traits & kLies_surface))
            continue;
        double last = 1.0;
        const real3 eye = {0.0f, std::sin(0.6f), std::cos(0.6f)};
        for (const float tilt : {0.0f, 0.2f, 0.48f, 0.78f, 0.963f}) {
            const auto away = [&](float alpha_u, float alpha_v) {
                bsdf_lobe lobe = lobe_on_surface(line, alpha_u, alpha_v, eye, {-tilt, 0.0f});
                const surface_frame axes = lobe.axes; // the eye lies in the plane of the tilt
                lobe.o = k_normalize3(vec3_of(0.0f, eye.y, eye.z));
                lobe.axes = axes;
                return lobe;
            };
            EXPECT_NEAR(bsdf_lobe_own_energy(away(0.004f, 0.002f)).albedo, bsdf_lobe_mirror_albedo(away(0.004f, 0.002f)), 0.02f) << tilt;
            const double now = static_cast<double>(bsdf_lobe_own_energy(away(0.1f, 0.1f)).albedo);
            EXPECT_LT(now, last + 0.01) << tilt;
            last = now;
        }
        EXPECT_LT(last, 0.03) << line.name;
    }
}

} // namespace
} // namespace burnish::test
