// The reference against integrals of these tests, which share nothing with the shading text.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "tests/unit/reference/formulas.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

const glm::dvec3 kCopper(0.9, 0.6, 0.3);
constexpr glm::vec3 kOutsideEyes[] = {{0.5f, 0.2f, 0.8f}, {-0.3f, 0.8f, 0.45f}}, kGrazingEye(0.9f, 0.1f, 0.3f);

Material plate_material(float metallic, float roughness)
{
    Material m;
    m.base_color = glm::vec4(glm::vec3(kCopper), 1.0f), m.metallic = metallic, m.roughness = roughness;
    return m;
}

FrameDesc outside_desc(const glm::vec3& eye)
{
    return desc_of(8, 8, view_from(eye, 0.05f));
}

glm::dvec3 towards(const glm::vec3& eye)
{
    return glm::normalize(glm::dvec3(eye));
}

float radians_of(double degrees)
{
    return static_cast<float>(degrees / 360.0 * kFullTurn);
}

ChannelEstimate reference_of(const Stage& stage, const FrameDesc& d, ReferenceMode mode = ReferenceMode::direct)
{
    ReferenceOptions o;
    o.mode = mode, o.samples = 4096;
    return estimate_channels(render_reference(stage, d, o));
}

// Prints the deviations, and returns true where they are within the bounds.
bool is_near(const std::string& name, const ChannelEstimate& e, const glm::dvec3& expected)
{
    const glm::dvec3 off = 100.0 * (e.mean / expected - 1.0), error = 100.0 * e.deviation / expected;
    std::printf("%-36s %.4f %.4f %.4f, off by %+.3f %+.3f %+.3f %%, standard errors %.3f %.3f %.3f %%\n", name.c_str(), expected.x,
                expected.y, expected.z, off.x, off.y, off.z, error.x, error.y, error.z);
    return glm::all(glm::lessThanEqual(glm::abs(e.mean - expected), 3e-3 * expected + 4.5 * e.deviation));
}

void expect_integral(const std::string& name, const ChannelEstimate& e, const glm::dvec3& expected)
{
    EXPECT_TRUE(is_near(name, e, expected)) << name;
    EXPECT_TRUE(glm::all(glm::lessThan(e.deviation, 1e-3 * expected))) << name;
}

TEST(outside, formulas_cover_the_surface_once)
{
    const Facets level = gltf_facets(0.5, 0.7, 30.0), wide = gltf_facets(0.8, 0.3, 75.0);
    for (const Facets& f : {level, wide, tilted_by(level, 0.4, -0.3), tilted_by(wide, -0.6, 0.2)})
        for (const glm::vec3& eye : {kOutsideEyes[0], kOutsideEyes[1], glm::vec3(0.0f, 0.0f, 1.0f)}) {
            double surface = 0.0, seen = 0.0;
            for_each_facet(f, 400, [&](const glm::dvec3& m, double solid_angle) {
                surface += facet_density(f, m) * m.z * solid_angle;
                seen += facet_density(f, m) * std::max(glm::dot(m, towards(eye)), 0.0) * solid_angle;
            });
            EXPECT_NEAR(surface, 1.0, 1e-3);
            EXPECT_NEAR(seen, area_seen(f, towards(eye)), 1e-3 * seen);
            if (f.level()) {
                EXPECT_NEAR(seen, towards(eye).z * inverse_g1(f, towards(eye)), 1e-3 * seen);
            }
            const glm::dvec3 coarse = reflected_light(f, towards(eye), no_fresnel());
            const glm::dvec3 fine = reflected_light(f, towards(eye), no_fresnel(), coloured_sky, 3 * kFacetRings / 2);
            EXPECT_LT(glm::length(coarse - fine), 1e-4 * glm::length(fine));
        }
}

TEST(outside, an_anisotropic_metal_follows_its_formula)
{
    BN_NEEDS_EMBREE();
    const auto expect = [](const std::string& name, const Scene& scene, const Facets& f) {
        const Stage stage = under_coloured_sky(scene);
        for (const glm::vec3& eye : kOutsideEyes)
            expect_integral(name, reference_of(stage, outside_desc(eye)), reflected_light(f, towards(eye), schlick_of(kCopper)));
    };
    for (const int rotation : {0, 30, 75}) {
        Material m = plate_material(1.0f, 0.4f);
        m.anisotropy_strength = 0.7f, m.anisotropy_rotation = radians_of(rotation);
        expect("factors, " + std::to_string(rotation) + " degrees", plane_scene(m), gltf_facets(0.4, 0.7, rotation));

        m.anisotropy_strength = 1.0f, m.anisotropy_rotation = radians_of(-40.0); // turns the texture's directions
        Scene mapped = plane_scene(m);
        const double a = radians_of(rotation + 40.0);
        const glm::ivec3 code(glm::round(255.0 * glm::dvec3(0.5 + 0.5 * std::cos(a), 0.5 + 0.5 * std::sin(a), 0.7)));
        mapped.materials[0].anisotropy_tex = add_texel(mapped, code);
        const double held = std::atan2(2.0 * code.y / 255.0 - 1.0, 2.0 * code.x / 255.0 - 1.0) * 360.0 / kFullTurn;
        expect("texture, " + std::to_string(rotation) + " degrees", mapped, gltf_facets(0.4, code.z / 255.0, held - 40.0));
    }
    Material m = plate_material(1.0f, 0.4f);
    m.anisotropy_strength = 0.7f, m.anisotropy_rotation = radians_of(30.0);
    Scene left_handed = plane_scene(m);
    for (std::size_t i = 0; i < left_handed.vertices.size(); ++i)
        left_handed.vertices.tw[i] = -1.0f;
    expect("factors, left-handed tangents", left_handed, gltf_facets(0.4, 0.7, -30.0));
}

// The frame's anisotropy has a sign: widths are alpha (1 + eta) along the grain and alpha (1 - eta) across it.
TEST(outside, an_anisotropy_of_either_sign_follows_its_formula)
{
    BN_NEEDS_EMBREE();
    const Stage stage = under_coloured_sky(plane_scene(plate_material(1.0f, 0.5f)));
    for (const double eta : {0.6, -0.6})
        for (const glm::vec3& eye : kOutsideEyes) {
            FrameDesc d = outside_desc(eye);
            d.override_anisotropy = true, d.anisotropy = static_cast<float>(eta);
            Facets f = gltf_facets(0.5);
            f.along *= 1.0 + eta, f.across *= 1.0 - eta;
            expect_integral(eta > 0.0 ? "wider along" : "wider across", reference_of(stage, d),
                            reflected_light(f, towards(eye), schlick_of(kCopper)));
        }
}

TEST(outside, a_tilted_lobe_follows_the_ellipsoid_s_formula)
{
    BN_NEEDS_EMBREE();
    Material m = plate_material(1.0f, 0.5f);
    m.anisotropy_strength = 0.6f, m.anisotropy_rotation = radians_of(30.0);
    const Stage stage = under_coloured_sky(plane_scene(m));
    for (const glm::ivec2& tilt : {glm::ivec2(20, 0), {0, 20}, {-15, 30}, {35, -10}})
        for (const glm::vec3& eye : kOutsideEyes)
            for (const bool separable : {false, true}) {
                FrameDesc d = outside_desc(eye);
                d.tilt_rad = {radians_of(tilt.x), radians_of(tilt.y)}, d.masking = separable;
                Facets f = tilted_by(gltf_facets(0.5, 0.6, 30.0), radians_of(tilt.x), radians_of(tilt.y));
                f.correlated = !separable;
                expect_integral("tilt " + std::to_string(tilt.x) + "," + std::to_string(tilt.y) + (separable ? ", separable" : ""),
                                reference_of(stage, d), reflected_light(f, towards(eye), schlick_of(kCopper)));
            }
}

// The surface blocks light from behind, in each mode.
TEST(outside, a_tilt_turns_the_diffuse_part)
{
    BN_NEEDS_EMBREE();
    const Stage stage = under_coloured_sky(plane_scene(lambert(0.6f)));
    for (const glm::ivec2& tilt : {glm::ivec2(0, 0), {20, 0}, {-10, 25}})
        for (const ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed}) {
            FrameDesc d = outside_desc(kOutsideEyes[0]);
            d.tilt_rad = {radians_of(tilt.x), radians_of(tilt.y)};
            const glm::dmat3 axes = tilted_by(Facets(), radians_of(tilt.x), radians_of(tilt.y)).axes;
            expect_integral("diffuse, tilt " + std::to_string(tilt.x) + "," + std::to_string(tilt.y), reference_of(stage, d, mode),
                            0.6 * diffuse_light(axes));
        }
}

// The diffuse part gets the light that the lobe does not reflect under uniform light (shading/README.md).
glm::dvec3 dielectric_light(const Facets& f, const glm::dvec3& o, double index)
{
    const glm::dvec3 f0(std::pow((index - 1.0) / (index + 1.0), 2.0));
    const glm::dvec3 rest = 1.0 - reflected_light(f, o, schlick_of(f0), white_sky);
    return reflected_light(f, o, schlick_of(f0)) + rest * kCopper * diffuse_light();
}

TEST(outside, a_dielectric_shares_light_with_its_diffuse_part)
{
    BN_NEEDS_EMBREE();
    for (const double index : {1.5, 2.0})
        for (const double roughness : {0.3, 0.7})
            for (const double strength : {0.0, 0.8}) {
                Material m = plate_material(0.0f, static_cast<float>(roughness));
                m.ior = static_cast<float>(index), m.anisotropy_strength = static_cast<float>(strength);
                const Stage stage = under_coloured_sky(plane_scene(m));
                const Facets f = gltf_facets(roughness, strength);
                for (const glm::vec3& eye : {kOutsideEyes[1], kGrazingEye})
                    expect_integral("index " + std::to_string(index).substr(0, 3) + ", widths " + std::to_string(f.along).substr(0, 4) +
                                        ' ' + std::to_string(f.across).substr(0, 4),
                                    reference_of(stage, outside_desc(eye)), dielectric_light(f, towards(eye), index));
            }
}

// KHR_materials_clearcoat: a layer with index 1.5 whose share of the light depends on the view angle.
TEST(outside, a_clear_coat_lies_over_metals_and_dielectrics)
{
    BN_NEEDS_EMBREE();
    for (const bool is_metal : {true, false}) {
        Material m = plate_material(is_metal ? 1.0f : 0.0f, 0.5f);
        m.clearcoat = 0.8f, m.clearcoat_roughness = 0.25f, m.anisotropy_strength = 0.5f;
        const Stage stage = under_coloured_sky(plane_scene(m));
        const Facets below = gltf_facets(0.5, 0.5), coat = gltf_facets(0.25);
        for (const glm::vec3& eye : {kOutsideEyes[0], kOutsideEyes[1], kGrazingEye}) {
            const glm::dvec3 o = towards(eye);
            const double share = 0.8 * schlick_of(glm::dvec3(0.04))(o.z).x;
            const glm::dvec3 base = is_metal ? reflected_light(below, o, schlick_of(kCopper)) : dielectric_light(below, o, 1.5);
            expect_integral(is_metal ? "coat over a metal" : "coat over a dielectric", reference_of(stage, outside_desc(eye)),
                            (1.0 - share) * base + share * reflected_light(coat, o, no_fresnel()));
        }
    }
}

TEST(outside, rough_glass_refracts_by_its_formula)
{
    BN_NEEDS_EMBREE();
    for (const double roughness : {0.3, 0.6}) {
        Material m = plate_material(0.0f, static_cast<float>(roughness));
        m.transmission = 1.0f, m.double_sided = true, m.anisotropy_strength = 0.5f;
        const Stage stage = under_coloured_sky(plane_scene(m));
        Facets f = gltf_facets(roughness, 0.5);
        f.correlated = false;
        for (const glm::vec3& eye : kOutsideEyes) {
            expect_integral("glass, seen from outside", reference_of(stage, outside_desc(eye)),
                            glass_light(f, towards(eye), 1.5, kCopper, coloured_sky));
            expect_integral("glass, seen from inside", reference_of(stage, outside_desc({eye.x, eye.y, -eye.z})),
                            glass_light(f, towards(eye), 1.0 / 1.5, kCopper, sky_upside_down));
        }
    }
}

// Half of the unreflected light passes. The diffuse part gets the other half, as for all dielectrics.
TEST(outside, partly_clear_glass_shares_light_with_its_diffuse_part)
{
    BN_NEEDS_EMBREE();
    Material m = plate_material(0.0f, 0.5f);
    m.transmission = 0.5f;
    const Stage stage = under_coloured_sky(plane_scene(m));
    Facets f = gltf_facets(0.5);
    f.correlated = false;
    for (const glm::vec3& eye : {kOutsideEyes[0], kOutsideEyes[1], kGrazingEye}) {
        const glm::dvec3 o = towards(eye), glass = glass_light(f, o, 1.5, 0.5 * kCopper, coloured_sky);
        const glm::dvec3 diffuse = 0.5 * kCopper * diffuse_light();
        const ChannelEstimate e = reference_of(stage, outside_desc(eye));
        expect_integral("half clear", e, glass + (1.0 - reflected_light(f, o, fresnel_of(1.5), white_sky)) * diffuse);
    }
}

} // namespace
} // namespace burnish::test
