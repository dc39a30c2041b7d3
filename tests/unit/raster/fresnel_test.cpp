// Exact reflectances (FrameDesc::fresnel). Mirrors, lamps and suns match Fresnel's equations in complex double. Rough lobes match Monte
// Carlo for every technique.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <string>

#include "shading/lang/records.h"
#include "tests/unit/raster/floor.h"

namespace burnish::test {
namespace {

// Returns the unpolarised reflectance. Born and Wolf 1999, "Principles of Optics", section 1.5.
double reflectance(double cosine, std::complex<double> index)
{
    const std::complex<double> g = std::sqrt(index * index - 1.0 + cosine * cosine);
    const std::complex<double> s = (cosine - g) / (cosine + g), p = (index * index * cosine - g) / (index * index * cosine + g);
    return 0.5 * (std::norm(s) + std::norm(p));
}

struct Metal {
    const char* name;
    glm::vec3 eta, k;
    double at(int channel, double cosine) const
    {
        return reflectance(cosine, {static_cast<double>(eta[channel]), static_cast<double>(k[channel])});
    }
    double mean(double cosine) const { return (at(0, cosine) + at(1, cosine) + at(2, cosine)) / 3.0; }
};
constexpr Metal kMetals[] = {{"gold", glm::vec3(0.143f, 0.375f, 1.44f), glm::vec3(3.98f, 2.39f, 1.60f)},
                             {"aluminium", glm::vec3(1.66f, 0.88f, 0.52f), glm::vec3(9.22f, 6.27f, 4.84f)},
                             {"titanium", glm::vec3(2.74f, 2.54f, 2.27f), glm::vec3(3.81f, 3.43f, 3.04f)},
                             {"glassy", glm::vec3(2.0f, 3.0f, 4.5f), glm::vec3(0.0f, 0.1f, 0.2f)}};

Scene of_metal(const Metal& metal)
{
    Scene scene = square(1.0f, 0.5f); // the index replaces the colour
    scene.materials[0].conductor_eta = metal.eta, scene.materials[0].conductor_k = metal.k;
    return scene;
}

Scene of_glass(float ior, float specular = 1.0f)
{
    Scene scene = square(0.0f, 0.0f);
    scene.materials[0].ior = ior, scene.materials[0].specular = specular;
    return scene;
}

FrameDesc with_law(int fresnel)
{
    FrameDesc d;
    d.override_anisotropy = true, d.fresnel = fresnel;
    return d;
}

TEST(fresnel, a_mirror_reflects_what_the_equations_say)
{
    double largest = 0.0;
    for (const TechniqueInfo& t : techniques()) {
        const auto expect = [&](const Floor& floor, FrameDesc d, double cosine, double reference) {
            d.technique = t.name, d.samples = t.default_samples, d.roughness = 0.0f;
            const double off = std::abs(floor.seen(d, cosine, 0.4) - reference);
            EXPECT_LT(off, 2e-3) << t.name << ", cosine " << cosine;
            largest = std::max(largest, off);
        };
        for (double cosine : {1.0, 0.8, 0.5, 0.25, 0.1}) {
            for (const Metal& metal : kMetals)
                expect(Floor(of_metal(metal)), with_law(kFresnelConductor), cosine, metal.mean(cosine));
            for (int law : {kFresnelConductor, kFresnelDielectric})
                expect(Floor(of_glass(1.8f)), with_law(law), cosine, reflectance(cosine, 1.8));
        }
    }
    std::printf("off by %.5f at most\n", largest);
}

// Each law applies to its own kind of material: metals without an index keep Schlick's colour, and Schlick's frames ignore the index.
TEST(fresnel, a_law_is_of_what_it_names)
{
    const Floor plain(square(1.0f, 0.5f)), gold(of_metal(kMetals[0])), glass(of_glass(1.8f));
    const double cosine = 0.3;
    const auto seen = [&](const Floor& floor, int law) {
        FrameDesc d = with_law(law);
        d.technique = "bent_normal", d.roughness = 0.3f;
        return floor.seen(d, cosine, 0.4);
    };
    EXPECT_EQ(seen(plain, kFresnelSchlick), seen(gold, kFresnelSchlick));
    EXPECT_NEAR(seen(plain, kFresnelConductor), seen(plain, kFresnelSchlick), 1e-5);
    EXPECT_NEAR(seen(plain, kFresnelDielectric), seen(plain, kFresnelSchlick), 1e-5);
    EXPECT_NEAR(seen(gold, kFresnelDielectric), seen(plain, kFresnelSchlick), 1e-5);
    EXPECT_GT(std::abs(seen(gold, kFresnelConductor) - seen(gold, kFresnelSchlick)), 0.05);
    EXPECT_EQ(seen(glass, kFresnelConductor), seen(glass, kFresnelDielectric));
    EXPECT_GT(std::abs(seen(glass, kFresnelDielectric) - seen(glass, kFresnelSchlick)), 0.005);
}

// KHR_materials_specular scales all of a dielectric's reflection, under any law. An index of 1 reflects nothing, an index of 0 everything.
TEST(fresnel, extensions_of_dielectrics_keep_their_meaning)
{
    FrameDesc d = with_law(kFresnelDielectric);
    d.technique = "mc", d.samples = 64, d.roughness = 0.4f;
    for (double cosine : {0.9, 0.3, 0.1}) {
        const double whole = Floor(of_glass(1.6f)).seen(d, cosine, 0.4);
        EXPECT_NEAR(Floor(of_glass(1.6f, 0.25f)).seen(d, cosine, 0.4), 0.25 * whole, 1e-5);
        EXPECT_EQ(Floor(of_glass(1.0f)).seen(d, cosine, 0.4), 0.0);
        const double all = Floor(of_glass(0.0f)).seen(d, cosine, 0.4), metal = Floor(square(1.0f, 1.0f)).seen(d, cosine, 0.4);
        EXPECT_NEAR(all, metal, 1e-5 * metal);
        EXPECT_NEAR(Floor(of_glass(1e30f)).seen(d, cosine, 0.4), metal, 0.01 * metal);
    }
}

// A white metal has reflectance 1 at every angle. The ratio to it under one light is the reflectance at the half vector.
TEST(fresnel, lamps_and_suns_meet_it_at_the_half_vector)
{
    const glm::dvec3 l = glm::normalize(glm::dvec3(0.7, 0.2, 0.4));
    for (bool sun : {false, true})
        for (double cosine : {0.9, 0.5, 0.2})
            for (const Metal& metal : kMetals) {
                Floor white(square(1.0f, 1.0f), 0.0f), coloured(of_metal(metal), 0.0f);
                for (Floor* floor : {&white, &coloured})
                    sun ? floor->put_sun(l, 2e-3) : floor->put_lamp(l);
                FrameDesc d = with_law(kFresnelConductor);
                d.technique = "bent_normal", d.roughness = 0.7f, d.background = false;
                const glm::dvec3 eye = Floor::eye(cosine, 3.3), h = glm::normalize(eye + l);
                const glm::dvec3 a = coloured.colour(d, cosine, 3.3), b = white.colour(d, cosine, 3.3);
                for (int c = 0; c < 3; ++c) {
                    ASSERT_GT(b[c], 1e-3);
                    EXPECT_NEAR(a[c] / b[c], metal.at(c, glm::dot(eye, h)), 2e-4) << metal.name << ", sun " << sun << ", cosine " << cosine;
                }
            }
}

// One value of the reflectance replaces its mean over the lobe: see mean_v_dot_h().
TEST(fresnel, one_fetch_gives_back_what_sampling_does)
{
    for (const Metal& metal : kMetals) {
        const Floor floor(of_metal(metal));
        double largest = 0.0, squares = 0.0, schlick = 0.0;
        int count = 0;
        for (float roughness : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f})
            for (double cosine : {0.95, 0.7, 0.45, 0.25, 0.1}) {
                FrameDesc d = with_law(kFresnelConductor);
                d.roughness = roughness, d.technique = "mc", d.samples = 1024;
                const double reference = floor.seen(d, cosine, 0.4);
                d.technique = "bent_normal";
                const double off = floor.seen(d, cosine, 0.4) - reference;
                EXPECT_LT(std::abs(off), 0.025) << metal.name << ", roughness " << roughness << ", cosine " << cosine;
                largest = std::max(largest, std::abs(off)), squares += off * off, ++count;
                Scene approximate = square(1.0f, 1.0f);
                for (int c = 0; c < 3; ++c)
                    approximate.materials[0].base_color[c] = static_cast<float>(metal.at(c, 1.0));
                const double approximated = Floor(std::move(approximate)).seen(d, cosine, 0.4);
                schlick = std::max(schlick, std::abs(approximated - reference));
            }
        std::printf("%s: rms %.4f, at most %.4f; Schlick's approximation at most %.4f\n", metal.name, std::sqrt(squares / count), largest,
                    schlick);
        EXPECT_LT(largest, schlick) << metal.name;
    }
}

// Draws a material that is half metal and half dielectric on every instruction set.
TEST(fresnel, is_the_same_for_every_isa)
{
    Scene scene = of_metal(kMetals[0]);
    scene.materials[0].metallic = 0.5f;
    scene.materials[0].base_color = glm::vec4(0.9f, 0.5f, 0.2f, 1.0f);
    Floor floor(std::move(scene));
    floor.put_lamp(glm::normalize(glm::dvec3(0.3, -0.2, 0.6)));
    floor.put_sun(glm::normalize(glm::dvec3(-0.3, 0.5, 0.6)), 0.05);
    for (const TechniqueInfo& t : techniques())
        for (int law : {kFresnelConductor, kFresnelDielectric})
            for (bool compensated : {false, true}) {
                FrameDesc d = with_law(law);
                d.technique = t.name, d.samples = std::min(t.default_samples, 9), d.energy_compensation = compensated;
                d.roughness = 0.4f, d.anisotropy = 0.6f, d.width = 24, d.height = 16, d.msaa = 1;
                d.view = make_view(glm::vec3(1.0f, 0.4f, 0.7f), {0, 0, 0}, 0.8f, d.width, d.height);
                const std::uint64_t hash = pixel_hash(floor.stage.render(d, Isa::scalar).color);
                for (Isa isa : available_isas())
                    EXPECT_EQ(pixel_hash(floor.stage.render(d, isa).color), hash) << t.name << " " << isa_name(isa);
            }
}

} // namespace
} // namespace burnish::test
