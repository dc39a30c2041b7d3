// One scene written in several ways: both renderers draw equal images.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

using Techniques = std::vector<std::string>;

const Techniques kEveryTechnique = {"split_isotropic", "bent_normal", "major_axis", "lobe_line", "filtered_is", "mc", "as_mc"};

// Returns a perspective view of a plate around `place`, partly beside the plate. Its numbers have few digits, so far away none is lost.
FrameDesc plate_seen_at(const glm::vec3& place)
{
    FrameDesc d = desc_of(32, 32, make_view(place + glm::vec3(0.75f, -0.5f, 1.5f), place, 1.0f, 32, 32));
    d.background = false;
    return d;
}

struct Written {
    Scene scene;
    glm::vec3 place = glm::vec3(0.0f); // position of the plate
};

// bound: on the relative difference of pixels.
void expect_same_pictures(const std::string& name, const Stage& one, const FrameDesc& of_one, const Stage& other, const FrameDesc& of_other,
                          const Techniques& by, double bound)
{
    for (const std::string& technique : by) {
        FrameDesc d[2] = {of_one, of_other};
        d[0].technique = d[1].technique = technique;
        const Frame a = one.render(d[0], best_isa()), b = other.render(d[1], best_isa());
        double worst = 0.0;
        for (int i = 0; i < 3 * d[0].width * d[0].height; ++i) {
            const double x = static_cast<double>(a.color.f32()[i]), y = static_cast<double>(b.color.f32()[i]);
            worst = std::max(worst, std::abs(x - y) / std::max({x, y, 1e-6}));
        }
        std::printf("%-28s %-16s off by %.2g at most, mean %.4f\n", name.c_str(), technique.c_str(), worst, mean_of(a));
        EXPECT_LE(worst, bound) << name << ", " << technique;
        EXPECT_GT(mean_of(a), 0.1) << name << ", " << technique;
    }
}

void expect_same(const std::string& name, const Written& one, const Written& other, const Techniques& by = kEveryTechnique,
                 double bound = 1e-5)
{
    const Stage a = under_coloured_sky(one.scene), b = under_coloured_sky(other.scene);
    const FrameDesc of_a = plate_seen_at(one.place), of_b = plate_seen_at(other.place);
    expect_same_pictures(name, a, of_a, b, of_b, by, bound);
    ReferenceOptions o;
    o.samples = 256;
    const ChannelEstimate x = estimate_channels(render_reference(a, of_a, o)), y = estimate_channels(render_reference(b, of_b, o));
    const glm::dvec3 off = 100.0 * (y.mean / x.mean - 1.0), error = 100.0 * x.deviation / x.mean;
    std::printf("%-28s %-16s off by %+.4f %+.4f %+.4f %%, standard errors %.3f %.3f %.3f %%\n", name.c_str(), "reference", off.x, off.y,
                off.z, error.x, error.y, error.z);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(x.mean[c], y.mean[c], 4.5 * std::hypot(x.deviation[c], y.deviation[c])) << name << ", channel " << c;
}

// Returns a material with every part of a surface. Its grain lies along neither axis.
Material grained(float rotation)
{
    Material m;
    m.base_color = glm::vec4(0.9f, 0.6f, 0.3f, 1.0f), m.metallic = 0.25f, m.roughness = 0.4f;
    m.anisotropy_strength = 0.7f, m.anisotropy_rotation = rotation;
    m.clearcoat = 0.5f, m.clearcoat_roughness = 0.25f;
    m.sheen_color = glm::vec3(0.25f, 0.5f, 0.75f), m.sheen_roughness = 0.5f;
    m.iridescence = 0.5f, m.iridescence_thickness = 300.0f;
    return m;
}

Scene placed_by(Scene scene, const glm::mat4& local)
{
    scene.nodes[0].local = local;
    update_world(scene);
    return scene;
}

TEST(outside, a_mirrored_node_is_a_mirrored_mesh)
{
    BN_NEEDS_EMBREE();
    const Scene plain = plane_scene(grained(0.5f));
    glm::mat4 mirror(1.0f);
    mirror[0].x = -1.0f;
    const Scene by_node = placed_by(plain, mirror);
    Scene by_mesh = plain;
    VertexTable& v = by_mesh.vertices;
    for (std::size_t i = 0; i < v.size(); ++i)
        v.px[i] = -v.px[i], v.nx[i] = -v.nx[i], v.tx[i] = -v.tx[i], v.tw[i] = -v.tw[i];
    for (std::size_t i = 0; i < by_mesh.indices.size(); i += 3)
        std::swap(by_mesh.indices[i], by_mesh.indices[i + 2]);
    expect_same("by node and by mesh", {by_node}, {by_mesh});
    // The other techniques place samples by the lobe's axes, one of which has flipped.
    expect_same("by node and by rotation", {by_node}, {plane_scene(grained(-0.5f))},
                {"split_isotropic", "bent_normal", "major_axis", "filtered_is"});
    const Stage turned = under_coloured_sky(by_node), level = under_coloured_sky(plain);
    const FrameDesc d = plate_seen_at(glm::vec3(0.0f));
    EXPECT_GT(std::abs(mean_of(turned.render(d, best_isa())) / mean_of(level.render(d, best_isa())) - 1.0), 1e-3) << "nothing is tested";
}

TEST(outside, far_away_a_scene_looks_as_it_does_near)
{
    BN_NEEDS_EMBREE();
    const glm::vec3 place(1000.0f, -1000.0f, 1000.0f);
    const Scene near = plane_scene(grained(0.5f));
    glm::mat4 move(1.0f);
    move[3] = glm::vec4(place, 1.0f);
    expect_same("near, and far by its node", {near}, {placed_by(near, move), place});
    Scene by_mesh = near;
    VertexTable& v = by_mesh.vertices;
    for (std::size_t i = 0; i < v.size(); ++i)
        v.px[i] += place.x, v.py[i] += place.y, v.pz[i] += place.z;
    expect_same("near, and far by its mesh", {near}, {by_mesh, place});
}

TEST(outside, split_triangles_are_the_whole_ones)
{
    BN_NEEDS_EMBREE();
    std::vector<Triangle> pieces;
    for (int y = -4; y < 4; ++y)
        for (int x = -4; x < 4; ++x) {
            const auto at = [&](int a, int b) { return glm::vec3(x + a, y + b, 0) / 4.0f; };
            pieces.push_back({at(0, 0), at(1, 0), at(1, 1)});
            pieces.push_back({at(0, 0), at(1, 1), at(0, 1)});
        }
    Scene split = scene_of(pieces, false);
    split.materials[0] = grained(0.5f);
    expect_same("split and whole", {split}, {plane_scene(grained(0.5f))});
}

// Halves hold these numbers exactly, so that nothing is rounded.
Material of_short_numbers(float strength)
{
    Material m = grained(std::atan2(0.5f, 1.0f));
    m.base_color = glm::vec4(1.0f, 0.5f, 0.25f, 1.0f), m.roughness = 0.5f;
    m.anisotropy_strength = strength;
    return m;
}

template <class Change> Written with_change(const Material& material, Change change)
{
    Scene scene = plane_scene(material);
    change(scene, scene.materials[0]);
    return {std::move(scene)};
}

TEST(outside, a_texture_of_one_texel_is_a_factor)
{
    BN_NEEDS_EMBREE();
    const Material m = of_short_numbers(0.75f), round = of_short_numbers(0.0f);
    const Written grain = {plane_scene(m)};
    expect_same("base colour", grain, with_change(m, [](Scene& s, Material& to) {
                    to.base_color = glm::vec4(1.0f), to.base_color_tex = add_texel(s, glm::vec3(1.0f, 0.5f, 0.25f));
                }));
    expect_same("coat", grain, with_change(m, [](Scene& s, Material& to) {
                    to.clearcoat = to.clearcoat_roughness = 1.0f;
                    to.clearcoat_tex = to.clearcoat_roughness_tex = add_texel(s, glm::vec3(0.5f, 0.25f, 0.0f));
                }));
    expect_same("sheen", grain, with_change(m, [](Scene& s, Material& to) {
                    to.sheen_color = glm::vec3(1.0f), to.sheen_color_tex = add_texel(s, glm::vec3(0.25f, 0.5f, 0.75f));
                    to.sheen_roughness = 1.0f, to.sheen_roughness_tex = add_texel(s, glm::vec4(0.0f, 0.0f, 0.0f, 0.5f));
                }));
    expect_same("thin film", grain, with_change(m, [](Scene& s, Material& to) {
                    to.iridescence = 1.0f, to.iridescence_tex = add_texel(s, glm::vec3(0.5f, 0.0f, 0.0f));
                    to.iridescence_thickness_least = 100.0f, to.iridescence_thickness = 500.0f;
                    to.iridescence_thickness_tex = add_texel(s, glm::vec3(0.0f, 0.5f, 0.0f));
                }));
    // as_mc finds half vectors in another way where roughness has a texture.
    expect_same("roughness and metal", {plane_scene(round)},
                with_change(round,
                            [](Scene& s, Material& to) {
                                to.roughness = to.metallic = 1.0f, to.metallic_roughness_tex = add_texel(s, glm::vec3(0.0f, 0.5f, 0.25f));
                            }),
                {"split_isotropic", "bent_normal", "major_axis", "lobe_line", "filtered_is", "mc"});
    // Halves round 8-bit colours.
    Material coded = m;
    for (int c = 0; c < 3; ++c)
        coded.base_color[c] = std::pow((static_cast<float>(200 - 20 * c) / 255.0f + 0.055f) / 1.055f, 2.4f);
    expect_same("base colour of 8 bits", {plane_scene(coded)},
                with_change(coded,
                            [](Scene& s, Material& to) {
                                to.base_color = glm::vec4(1.0f), to.base_color_tex = add_texel(s, glm::ivec3(200, 180, 160));
                            }),
                kEveryTechnique, 0x1p-11);
}

// A lobe without textures has its exact albedo. With a texture the albedo comes from a coarser table over all lobes.
TEST(outside, an_anisotropy_texture_of_one_texel_is_a_factor)
{
    BN_NEEDS_EMBREE();
    Material metal_alone = of_short_numbers(0.75f);
    metal_alone.metallic = 1.0f;
    for (const Material& m : {metal_alone, of_short_numbers(0.75f)}) {
        const bool needs_albedo = m.metallic < 1.0f;
        const Written factors = {plane_scene(m)};
        const Written by_texture = with_change(m, [](Scene& s, Material& to) {
            to.anisotropy_strength = 1.0f, to.anisotropy_rotation = 0.0f;
            to.anisotropy_tex = add_texel(s, glm::vec3(1.0f, 0.75f, 0.75f));
        });
        expect_same(needs_albedo ? "over a diffuse part" : "metal", factors, by_texture, {"filtered_is", "mc"}, needs_albedo ? 1e-3 : 1e-5);
        expect_same(needs_albedo ? "over a diffuse part" : "metal", factors, by_texture,
                    {"split_isotropic", "bent_normal", "major_axis", "lobe_line"}, 5e-3);
    }
}

} // namespace
} // namespace burnish::test
