#include "apps/lab/conform/mutants.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/image/colour.h"
#include "core/scene/tangents.h"
#include "shading/lab/conform/mutated.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

// Edits each material. True where one of them changes.
template <class Edit> bool each_material(Scene& scene, const Edit& edit)
{
    bool changed = false;
    for (Material& m : scene.materials)
        changed = edit(m) || changed;
    return changed;
}

// Edits each texel of the maps that materials name: red, green and blue, [0,1]. Maps of other types than 8 bits stay.
template <class Edit> bool each_texel(Scene& scene, TextureRef Material::*map, const Edit& edit)
{
    std::set<std::int32_t> images;
    for (const Material& m : scene.materials)
        if ((m.*map).used())
            images.insert(scene.textures[static_cast<std::size_t>((m.*map).texture)].image);
    bool changed = false;
    for (const std::int32_t index : images) {
        Image& image = scene.images[static_cast<std::size_t>(index)];
        if (image.type != PixelType::u8 || image.channels < 3)
            continue;
        changed = true;
        const auto channels = static_cast<std::size_t>(image.channels);
        for (std::size_t at = 0; at + channels <= image.bytes.size(); at += channels) {
            float texel[3];
            for (std::size_t c = 0; c < 3; ++c)
                texel[c] = static_cast<float>(static_cast<int>(image.bytes[at + c])) / 255.0f;
            edit(texel);
            for (std::size_t c = 0; c < 3; ++c)
                image.bytes[at + c] = static_cast<std::byte>(static_cast<int>(std::clamp(texel[c], 0.0f, 1.0f) * 255.0f + 0.5f));
        }
    }
    return changed;
}
template <class Edit> bool each_direction(Scene& scene, const Edit& edit)
{
    return each_texel(scene, &Material::anisotropy_tex, edit);
}

bool no_anisotropy(Scene& scene)
{
    return each_material(scene, [](Material& m) {
        const bool had = m.anisotropy_strength != 0.0f;
        m.anisotropy_strength = 0.0f, m.anisotropy_tex = {};
        return had;
    });
}
bool degrees_for_radians(Scene& scene)
{
    return each_material(scene, [](Material& m) {
        const bool had = m.anisotropy_rotation != 0.0f;
        m.anisotropy_rotation = glm::radians(m.anisotropy_rotation);
        return had;
    });
}
bool negative_rotation(Scene& scene)
{
    return each_material(scene, [](Material& m) {
        const bool had = m.anisotropy_rotation != 0.0f;
        m.anisotropy_rotation = -m.anisotropy_rotation;
        return had;
    });
}
bool no_rotation(Scene& scene)
{
    return each_material(scene, [](Material& m) { return std::exchange(m.anisotropy_rotation, 0.0f) != 0.0f; });
}
// Changes the strength, a factor times a texture's blue.
template <class Change> bool other_strength(Scene& scene, const Change& change)
{
    const bool factors = each_material(scene, [&](Material& m) {
        const float before = std::exchange(m.anisotropy_strength, change(m.anisotropy_strength));
        return m.anisotropy_strength != before;
    });
    return each_direction(scene, [&](float* t) { t[2] = change(t[2]); }) || factors;
}
bool strength_squared_twice(Scene& scene)
{
    return other_strength(scene, [](float s) { return s * s; });
}
bool strength_not_squared(Scene& scene)
{
    return other_strength(scene, [](float s) { return std::sqrt(s); });
}
bool no_direction_map(Scene& scene)
{
    return each_material(scene, [](Material& m) { return std::exchange(m.anisotropy_tex, {}).used(); });
}
bool strength_of_map_ignored(Scene& scene)
{
    return each_direction(scene, [](float* t) { t[2] = 1.0f; });
}
bool direction_map_srgb(Scene& scene)
{
    return each_direction(scene, [](float* t) {
        for (int c = 0; c < 3; ++c)
            t[c] = srgb_to_linear(t[c]);
    });
}
bool direction_green_down(Scene& scene)
{
    return each_direction(scene, [](float* t) { t[1] = 1.0f - t[1]; });
}

// Gives a map that repeats often one texel: the mean of its directions at full length, and of the strengths, which the mean's length may
// multiply. The mean of angles is the same here.
bool one_direction(Scene& scene, bool length_counts)
{
    constexpr float kOften = 8.0f; // times across a surface
    const auto& u = scene.vertices.u0;
    if (u.size() == 0 || *std::max_element(u.begin(), u.end()) < kOften)
        return false;
    float sum[3] = {}, count = 0.0f;
    const auto add = [&](const float* t) { sum[0] += t[0] * 2.0f - 1.0f, sum[1] += t[1] * 2.0f - 1.0f, sum[2] += t[2], count += 1.0f; };
    if (!each_direction(scene, [&](float* t) { add(t); }) || count == 0.0f)
        return false;
    const float length = std::hypot(sum[0], sum[1]), strength = sum[2] / count * (length_counts ? length / count : 1.0f);
    return length > 0.0f && each_direction(scene, [&](float* t) {
               t[0] = 0.5f + 0.5f * sum[0] / length, t[1] = 0.5f + 0.5f * sum[1] / length, t[2] = strength;
           });
}
bool directions_averaged(Scene& scene)
{
    return one_direction(scene, false);
}
bool directions_unnormalised(Scene& scene)
{
    return one_direction(scene, true);
}
bool first_coordinates(Scene& scene)
{
    return each_material(scene, [](Material& m) { return std::exchange(m.anisotropy_tex.uv_set, std::uint8_t{0}) != 0; });
}
bool no_texture_transform(Scene& scene)
{
    return each_material(scene,
                         [](Material& m) { return std::exchange(m.anisotropy_tex.uv_transform, glm::mat3x2(1.0f)) != glm::mat3x2(1.0f); });
}
bool no_normal_map(Scene& scene)
{
    return each_material(scene, [](Material& m) { return std::exchange(m.normal_tex, {}).used(); });
}
bool has_normal_map(Scene& scene)
{
    return each_material(scene, [](const Material& m) { return m.normal_tex.used(); });
}
bool normal_green_down(Scene& scene)
{
    return each_texel(scene, &Material::normal_tex, [](float* t) { t[1] = 1.0f - t[1]; });
}
bool no_coat(Scene& scene)
{
    return each_material(scene, [](Material& m) { return std::exchange(m.clearcoat, 0.0f) != 0.0f; });
}
bool faces_culled(Scene& scene)
{
    return each_material(scene, [](Material& m) { return std::exchange(m.double_sided, false); });
}
bool no_lamps(Scene& scene)
{
    bool had = false;
    for (Node& node : scene.nodes)
        had = std::exchange(node.light, kNone) != kNone || had;
    return had;
}
bool no_area_lights(Scene& scene)
{
    bool had = false;
    for (Node& node : scene.nodes)
        had = std::exchange(node.area_light, kNone) != kNone || had;
    return had;
}
bool has_lamp(const Scene& scene)
{
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [](const Node& node) { return node.light != kNone; });
}
bool has_area_light(const Scene& scene)
{
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [](const Node& node) { return node.area_light != kNone; });
}
bool lamps_round(Scene& scene)
{
    return has_lamp(scene) && no_anisotropy(scene);
}
bool area_lights_round(Scene& scene)
{
    return has_area_light(scene) && no_anisotropy(scene);
}

// Replaces the file's tangents by tangents of the coordinates.
bool own_tangents_ignored(Scene& scene)
{
    VertexTable& v = scene.vertices;
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    for (const std::uint32_t i : scene.indices) {
        positions.emplace_back(v.px[i], v.py[i], v.pz[i]);
        normals.emplace_back(v.nx[i], v.ny[i], v.nz[i]);
        uvs.emplace_back(v.u0[i], v.v0[i]);
    }
    const std::vector<glm::vec4> tangents = mikk_tangents(positions, normals, uvs);
    bool changed = false;
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::size_t i = scene.indices[corner];
        const glm::vec4& t = tangents[corner];
        changed = changed || glm::dot(glm::vec3(t), glm::vec3(v.tx[i], v.ty[i], v.tz[i])) < 0.9f || t.w != v.tw[i];
        v.tx[i] = t.x, v.ty[i] = t.y, v.tz[i] = t.z, v.tw[i] = t.w;
    }
    return changed;
}

// Turns the bitangents round.
void other_hand(Scene& scene)
{
    for (float& w : scene.vertices.tw)
        w = -w;
}
bool made_tangents_left_handed(Scene& scene)
{
    const bool made =
        std::none_of(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& p) { return p.has_file_tangents; });
    if (made)
        other_hand(scene);
    return made;
}
bool mirroring_node_ignored(Scene& scene)
{
    const bool mirrors = std::any_of(scene.nodes.begin(), scene.nodes.end(),
                                     [](const Node& node) { return node.mesh != kNone && glm::determinant(glm::mat3(node.world)) < 0.0f; });
    if (mirrors)
        other_hand(scene);
    return mirrors;
}

// Gives each triangle the normal of its plane.
bool geometric_normals(Scene& scene)
{
    VertexTable from;
    std::swap(from, scene.vertices);
    VertexTable& to = scene.vertices;
    bool curved = false;
    const auto each_column = [&](const auto& edit) {
        edit(to.px, from.px), edit(to.py, from.py), edit(to.pz, from.pz), edit(to.tx, from.tx), edit(to.ty, from.ty), edit(to.tz, from.tz);
        edit(to.tw, from.tw), edit(to.u0, from.u0), edit(to.v0, from.v0), edit(to.u1, from.u1), edit(to.v1, from.v1);
        edit(to.cr, from.cr), edit(to.cg, from.cg), edit(to.cb, from.cb), edit(to.ca, from.ca);
    };
    for (Primitive& p : scene.primitives) {
        const auto first_vertex = static_cast<std::uint32_t>(to.px.size());
        for (std::uint32_t at = p.first_index; at < p.first_index + p.index_count; at += 3) {
            glm::vec3 corner[3], mean(0.0f);
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::size_t i = scene.indices[at + k];
                corner[k] = glm::vec3(from.px[i], from.py[i], from.pz[i]);
                mean += glm::vec3(from.nx[i], from.ny[i], from.nz[i]);
            }
            const glm::vec3 across = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            const glm::vec3 n = glm::dot(across, across) > 0.0f ? glm::normalize(across) : glm::normalize(mean);
            curved = curved || glm::length(mean) < 2.9999f;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::size_t i = scene.indices[at + k];
                each_column([i](auto& column, const auto& old) { column.push_back(old[i]); });
                to.nx.push_back(n.x), to.ny.push_back(n.y), to.nz.push_back(n.z);
                const std::size_t last = to.px.size() - 1;
                const glm::vec3 t(to.tx[last], to.ty[last], to.tz[last]);
                const glm::vec3 level = t - n * glm::dot(n, t), unit = glm::length(level) > 1e-4f ? glm::normalize(level) : any_tangent(n);
                to.tx[last] = unit.x, to.ty[last] = unit.y, to.tz[last] = unit.z;
                scene.indices[at + k] = static_cast<std::uint32_t>(last);
            }
        }
        p.first_vertex = first_vertex;
        p.vertex_count = static_cast<std::uint32_t>(to.px.size()) - first_vertex;
    }
    return curved;
}

void across_for_up(FrameDesc& desc) // the field of view across is the one up
{
    const float aspect = desc.view.tan_half_x / desc.view.tan_half_y;
    desc.view.tan_half_x = desc.view.tan_half_y;
    desc.view.tan_half_y /= aspect;
}
void axes_not_turned(FrameDesc& desc)
{
    desc.frame_map = kFrameNormalOnly;
}

template <class Edit> void each_value(Image& image, const Edit& edit)
{
    for (std::size_t i = 0; i < image.bytes.size() / sizeof(float); ++i)
        image.f32()[i] = edit(image.f32()[i]);
}
void flipped(Image& image)
{
    const std::size_t row = static_cast<std::size_t>(image.width) * 3;
    for (int y = 0; y < image.height / 2; ++y)
        std::swap_ranges(image.f32() + static_cast<std::size_t>(y) * row, image.f32() + static_cast<std::size_t>(y + 1) * row,
                         image.f32() + static_cast<std::size_t>(image.height - 1 - y) * row);
}
void left_for_right(Image& image)
{
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width / 2; ++x)
            std::swap_ranges(
                image.f32() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) * 3,
                image.f32() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) * 3 + 3,
                image.f32() +
                    (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(image.width - 1 - x)) *
                        3);
}
void encoded(Image& image)
{
    each_value(image, [](float v) { return linear_to_srgb(std::clamp(v, 0.0f, 1.0f)); });
}
// Applies a tone curve, and takes off the display's encoding and the exposure.
void toned(Image& image, Tonemap curve)
{
    const Image shown = tonemap_to_srgb8(image, curve, 0.0f);
    for (std::size_t i = 0; i < shown.bytes.size(); ++i)
        image.f32()[i] = srgb_to_linear(static_cast<float>(static_cast<int>(shown.bytes[i])) / 255.0f);
}
void toned_neutral(Image& image)
{
    toned(image, Tonemap::pbr_neutral);
}
void toned_aces(Image& image)
{
    toned(image, Tonemap::aces);
}

void toned_reinhard(Image& image)
{
    each_value(image, [](float v) { return std::max(v, 0.0f) / (1.0f + std::max(v, 0.0f)); });
}
void toned_aces_fit(Image& image) // Narkowicz 2015, "ACES Filmic Tone Mapping Curve"
{
    each_value(image, [](float v) {
        const float x = std::max(v, 0.0f);
        return std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
    });
}

constexpr std::uint32_t bit(KernelMutant mutant)
{
    return mutant_bit(mutant);
}

} // namespace

const std::vector<Mutant>& mutants()
{
    using K = KernelMutant;
    static const std::vector<Mutant> all = {
        {"anisotropy_ignored", "anisotropy is ignored", 0, no_anisotropy},
        {"rotation_clockwise", "rotations and directions turn clockwise", bit(K::rotation_clockwise)},
        {"rotation_negated", "the rotation turns clockwise, directions of textures do not", 0, negative_rotation},
        {"rotation_in_degrees", "the rotation's radians are taken for degrees", 0, degrees_for_radians},
        {"rotation_ignored", "the rotation is ignored", 0, no_rotation},
        {"axes_swapped", "tangent and bitangent are swapped", bit(K::axes_swapped)},
        {"bend_across", "the normal for image light is bent about the tangent, not the bitangent", bit(K::bend_across)},
        {"bend_factor", "the bend factor is 2^(2^x), where x^4 is meant", bit(K::bend_factor)},
        {"no_bend", "image light ignores anisotropy", bit(K::no_bend)},
        {"mean_width", "image light takes a round lobe of the mean width", bit(K::mean_width)},
        {"no_specular_image", "the environment's specular light is lost", bit(K::no_specular_image)},
        {"handedness_ignored", "the tangents' w is taken for 1", bit(K::handedness_ignored)},
        {"tangents_ignored", "the file's tangents are ignored: they follow from the coordinates", 0, own_tangents_ignored},
        {"made_tangents_left_handed", "tangents that follow from the coordinates are left-handed", 0, made_tangents_left_handed},
        {"mirroring_node_ignored", "bitangents do not follow a node that mirrors", 0, mirroring_node_ignored},
        {"geometric_normals", "normals are those of the triangles", 0, geometric_normals},
        {"strength_squared_twice", "the strength is squared twice", 0, strength_squared_twice},
        {"strength_not_squared", "the strength is not squared", 0, strength_not_squared},
        {"alpha_is_roughness", "the lobe's width is the roughness, not its square", bit(K::alpha_is_roughness)},
        {"direction_map_ignored", "the texture of directions is ignored", 0, no_direction_map},
        {"direction_map_srgb", "the texture of directions is read as sRGB", 0, direction_map_srgb},
        {"direction_green_down", "the texture's directions have green down", 0, direction_green_down},
        {"map_strength_ignored", "the strength in the texture's blue is ignored", 0, strength_of_map_ignored},
        {"directions_averaged", "mip levels average directions or angles, and keep the length", 0, directions_averaged},
        {"directions_unnormalised", "directions of the texture are not normalised: their length counts as strength", 0,
         directions_unnormalised},
        {"first_coordinates", "the second texture coordinates are ignored", 0, first_coordinates},
        {"transform_ignored", "KHR_texture_transform is ignored", 0, no_texture_transform},
        {"normal_map_ignored", "the normal map is ignored", 0, no_normal_map},
        {"axes_not_turned", "the normal map turns the normal, but not the lobe's axes", 0, has_normal_map, MutantSky::right,
         axes_not_turned},
        {"normal_green_down", "the normal map has green down", 0, normal_green_down},
        {"coat_ignored", "the clear coat is ignored", 0, no_coat},
        {"backs_culled", "the backs of double-sided surfaces are not drawn", 0, faces_culled},
        {"no_fresnel", "reflectance does not rise at grazing angles", bit(K::no_fresnel)},
        {"no_energy_share", "the diffuse part gets the light that the lobe reflects, too", bit(K::no_energy_share)},
        {"lamps_ignored", "directional lights are ignored", 0, no_lamps},
        {"lamps_round", "directional lights ignore anisotropy", 0, lamps_round},
        {"area_lights_ignored", "area lights are ignored", 0, no_area_lights},
        {"area_lights_round", "area lights ignore anisotropy", 0, area_lights_round},
        {"sky_mirrored_x", "the environment is mirrored along x", 0, nullptr, MutantSky::mirrored_x},
        {"sky_mirrored_y", "the environment is upside down", 0, nullptr, MutantSky::mirrored_y},
        {"sky_mirrored_z", "the environment is mirrored along z", 0, nullptr, MutantSky::mirrored_z},
        {"sky_turned_quarter", "the environment is turned by 90 degrees", 0, nullptr, MutantSky::turned_quarter},
        {"sky_turned_half", "the environment is turned by 180 degrees", 0, nullptr, MutantSky::turned_half},
        {"sky_turned_back", "the environment is turned by -90 degrees", 0, nullptr, MutantSky::turned_back},
        {"field_of_view", "the field of view up is used across", 0, nullptr, MutantSky::right, across_for_up},
        {"upside_down", "the picture is upside down", 0, nullptr, MutantSky::right, nullptr, flipped},
        {"mirrored", "the picture is mirrored", 0, nullptr, MutantSky::right, nullptr, left_for_right},
        {"encoded", "the picture is encoded as sRGB, where linear values are asked for", 0, nullptr, MutantSky::right, nullptr, encoded},
        {"tonemapped_neutral", "the picture is tone mapped (PBR Neutral)", 0, nullptr, MutantSky::right, nullptr, toned_neutral},
        {"tonemapped_reinhard", "the picture is tone mapped (Reinhard)", 0, nullptr, MutantSky::right, nullptr, toned_reinhard},
        {"tonemapped_aces_fit", "the picture is tone mapped (Narkowicz's fit of ACES)", 0, nullptr, MutantSky::right, nullptr,
         toned_aces_fit},
        {"tonemapped_aces", "the picture is tone mapped (ACES)", 0, nullptr, MutantSky::right, nullptr, toned_aces},
    };
    return all;
}

Image changed_sky(const Image& environment, MutantSky sky)
{
    Image out = environment;
    const int w = environment.width, h = environment.height;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            int from_x = x, from_y = y;
            switch (sky) { // azimuth runs from +X over +Z, and +X is in the middle
            case MutantSky::mirrored_x:
                from_x = (w + w / 2 - 1 - x) % w;
                break;
            case MutantSky::mirrored_y:
                from_y = h - 1 - y;
                break;
            case MutantSky::mirrored_z:
                from_x = w - 1 - x;
                break;
            case MutantSky::turned_quarter:
                from_x = (x + w / 4) % w;
                break;
            case MutantSky::turned_half:
                from_x = (x + w / 2) % w;
                break;
            case MutantSky::turned_back:
                from_x = (x + w - w / 4) % w;
                break;
            default:
                break;
            }
            for (int c = 0; c < 3; ++c)
                out.f32()[(y * w + x) * 3 + c] = environment.f32()[(from_y * w + from_x) * 3 + c];
        }
    return out;
}

} // namespace burnish
