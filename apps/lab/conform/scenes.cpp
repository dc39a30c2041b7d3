#include "apps/lab/conform/scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "core/base/text.h"

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Adds a grid of (columns + 1) x (rows + 1) vertices; counter-clockwise triangles where v points down.
void add_grid(SceneFile& to, int columns, int rows, const std::function<FileVertex(double u, double v)>& at)
{
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            to.vertices.push_back(at(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
    const auto wide = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j)
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
            const std::uint32_t a = first + j * wide + i, b = a + 1, c = a + wide, d = c + 1;
            to.triangles.insert(to.triangles.end(), {a, c, b, b, c, d});
        }
}

// Returns a point of the unit sphere. Seen from outside, u runs to the right and v down; u is 0.5 at +Z.
FileVertex on_sphere(double u, double v)
{
    const double phi = (u - 0.5) * 2.0 * kPi, theta = v * kPi;
    FileVertex r;
    r.normal = glm::vec3(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
    r.position = r.normal;
    r.tangent = glm::vec4(std::cos(phi), 0.0, -std::sin(phi), 1.0);
    r.uv0 = glm::vec2(2.0 * u, v);
    r.uv1 = glm::vec2(v, 2.0 * u);
    return r;
}

SceneFile sphere()
{
    SceneFile s;
    add_grid(s, 128, 64, on_sphere);
    return s;
}

// Returns a plate that faces +Z, seen at a slant.
SceneFile plate(float repeats)
{
    SceneFile s;
    add_grid(s, 8, 8, [repeats](double u, double v) {
        FileVertex r;
        r.position = glm::vec3(2.0 * u - 1.0, 1.0 - 2.0 * v, 0.0);
        r.uv0 = glm::vec2(u, v) * repeats;
        r.uv1 = glm::vec2(v, u) * repeats;
        return r;
    });
    s.eye = glm::vec3(1.6f, 1.4f, 3.4f);
    s.fov_y_rad = 0.6f;
    return s;
}

// Returns a metal's material.
Json metal(float roughness)
{
    Json m = Json::object();
    m["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.82, 0.76, 0.66, 1.0}}, {"metallicFactor", 1.0}, {"roughnessFactor", shortest_decimal(roughness)}};
    return m;
}
Json brushed(float roughness, float strength, float rotation_deg)
{
    Json m = metal(roughness);
    Json& a = m["extensions"]["KHR_materials_anisotropy"];
    a["anisotropyStrength"] = shortest_decimal(strength);
    if (rotation_deg != 0.0f)
        a["anisotropyRotation"] = shortest_decimal(glm::radians(rotation_deg));
    return m;
}
SceneFile brushed_sphere(float roughness, float strength, float rotation_deg)
{
    SceneFile s = sphere();
    s.material = brushed(roughness, strength, rotation_deg);
    return s;
}

// Makes a texture of `side` x `side` texels. of: values in [0,1].
Image texture(int side, const std::function<glm::dvec3(double u, double v)>& of)
{
    Image image = make_image(side, side, 3, PixelType::u8);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::dvec3 value = of((x + 0.5) / side, (y + 0.5) / side);
            for (int c = 0; c < 3; ++c)
                image.bytes[static_cast<std::size_t>((y * side + x) * 3 + c)] =
                    static_cast<std::byte>(static_cast<int>(std::clamp(value[c], 0.0, 1.0) * 255.0 + 0.5));
        }
    return image;
}
glm::dvec3 direction(double degrees, double strength)
{
    const double a = degrees * kPi / 180.0;
    return {0.5 + 0.5 * std::cos(a), 0.5 + 0.5 * std::sin(a), strength};
}
void add_directions(SceneFile& to, int side, const std::function<glm::dvec3(double u, double v)>& of)
{
    to.material["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"]["index"] = to.textures.size();
    to.textures.push_back(texture(side, of));
}
Json& anisotropy_texture(SceneFile& of)
{
    return of.material["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"];
}

SceneFile strength_by_map()
{
    SceneFile s = brushed_sphere(0.3f, 1.0f, 0.0f);
    add_directions(s, 64, [](double u, double) { return direction(0.0, std::clamp(std::abs(u - 0.5) * 4.0 - 0.5, 0.0, 1.0)); });
    return s;
}

SceneFile directions_by_map()
{
    SceneFile s = brushed_sphere(0.28f, 0.9f, 0.0f);
    add_directions(s, 128, [](double u, double v) { return direction(360.0 * u + 90.0 * std::sin(2.0 * kPi * v), 1.0); });
    return s;
}

SceneFile one_direction_by_map() // 8-bit values that an sRGB curve turns to another angle
{
    SceneFile s = brushed_sphere(0.28f, 0.9f, 0.0f);
    add_directions(s, 8, [](double, double) { return direction(-60.0, 0.8); });
    return s;
}

SceneFile mirrored_coordinates() // the visible surface's left half has mirrored coordinates, as its tangents say
{
    SceneFile s;
    add_grid(s, 64, 64, [](double u, double v) {
        FileVertex r = on_sphere(u * 0.5, v);
        r.uv0.x = -r.uv0.x, r.tangent = glm::vec4(-glm::vec3(r.tangent), -1.0f);
        return r;
    });
    add_grid(s, 64, 64, [](double u, double v) { return on_sphere(0.5 + u * 0.5, v); });
    s.material = brushed(0.28f, 0.9f, 30.0f);
    return s;
}

SceneFile second_coordinates()
{
    SceneFile s = directions_by_map();
    anisotropy_texture(s)["texCoord"] = 1;
    return s;
}

SceneFile moved_coordinates()
{
    SceneFile s = directions_by_map();
    anisotropy_texture(s)["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.25, 0.1}}, {"rotation", shortest_decimal(glm::half_pi<float>())}, {"scale", {0.5, 2.0}}};
    return s;
}

SceneFile under_a_normal_map()
{
    SceneFile s = brushed_sphere(0.25f, 0.85f, 0.0f);
    s.textures.push_back(texture(256, [](double u, double v) {
        const double slope_u = 0.45 * std::cos(2.0 * kPi * 4.0 * u), slope_v = 0.3 * std::cos(2.0 * kPi * 3.0 * v);
        const glm::dvec3 n = glm::normalize(glm::dvec3(slope_u, slope_v, 1.0));
        return n * 0.5 + 0.5;
    }));
    s.material["normalTexture"]["index"] = 0;
    return s;
}

SceneFile from_above()
{
    SceneFile s = brushed_sphere(0.28f, 0.9f, 0.0f);
    s.eye = glm::vec3(0.0f, 4.2f, 0.6f);
    return s;
}

SceneFile at_the_limb() // a small part of a ball, where the eye grazes it
{
    SceneFile s = brushed_sphere(0.3f, 0.85f, 20.0f);
    s.target = glm::vec3(0.88f, 0.1f, 0.3f);
    s.fov_y_rad = 0.13f;
    return s;
}

SceneFile dielectric()
{
    SceneFile s = brushed_sphere(0.3f, 0.85f, 0.0f);
    s.material["pbrMetallicRoughness"]["metallicFactor"] = 0.0;
    s.material["pbrMetallicRoughness"]["baseColorFactor"] = {0.8, 0.75, 0.7, 1.0};
    return s;
}

SceneFile round_plastic(double albedo, float roughness)
{
    SceneFile s = sphere();
    s.material["pbrMetallicRoughness"] = {
        {"baseColorFactor", {albedo, albedo, albedo, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", shortest_decimal(roughness)}};
    return s;
}

SceneFile high_index() // reflects a sixth, and the rest is for the diffuse part
{
    SceneFile s = round_plastic(0.5, 0.25f);
    s.material["extensions"]["KHR_materials_ior"]["ior"] = shortest_decimal(2.4f);
    return s;
}

SceneFile dark_limb() // a small part of a ball that reflects little but at grazing angles
{
    SceneFile s = round_plastic(0.02, 0.15f);
    s.target = glm::vec3(0.925f, 0.1f, 0.3f);
    s.fov_y_rad = 0.05f;
    return s;
}

SceneFile few_triangles() // of a ball, under the ball's own normals
{
    SceneFile s;
    add_grid(s, 20, 10, on_sphere);
    s.material = brushed(0.28f, 0.9f, 0.0f);
    return s;
}

SceneFile coated()
{
    SceneFile s = brushed_sphere(0.35f, 0.9f, 0.0f);
    s.material["pbrMetallicRoughness"]["baseColorFactor"] = {0.25, 0.24, 0.22, 1.0};
    s.material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.05}};
    return s;
}

SceneFile under_a_lamp()
{
    SceneFile s = brushed_sphere(0.35f, 0.85f, 20.0f);
    s.lamp = true;
    return s;
}

SceneFile minified() // more texels than pixels, in two directions that lie 60 degrees apart
{
    SceneFile s = plate(300.0f);
    s.material = brushed(0.25f, 0.9f, 0.0f);
    add_directions(s, 64, [](double u, double) { return direction(u < 0.5 ? 60.0 : 120.0, 1.0); });
    return s;
}

SceneFile from_behind() // a bowl, of which the inside is seen
{
    SceneFile s;
    add_grid(s, 64, 64, [](double u, double v) { return on_sphere(0.5 * u + 1.0 - 0.25, v); });
    s.material = brushed(0.28f, 0.9f, 30.0f);
    s.material["doubleSided"] = true;
    return s;
}

SceneFile with_node(const glm::mat4& inner, const glm::mat4& outer)
{
    SceneFile s = brushed_sphere(0.28f, 0.9f, 30.0f);
    s.nodes = {inner, outer};
    return s;
}

SceneFile without_tangents()
{
    SceneFile s = brushed_sphere(0.28f, 0.9f, 30.0f);
    s.tangents = false;
    return s;
}

SceneFile tangents_of_their_own() // turned by 45 degrees from the coordinates
{
    SceneFile s = brushed_sphere(0.28f, 0.9f, 0.0f);
    for (FileVertex& v : s.vertices) {
        const glm::vec3 t(v.tangent), b = glm::cross(v.normal, t);
        v.tangent = glm::vec4(glm::normalize(t + b), 1.0f);
    }
    return s;
}

SceneFile left_handed_tangents()
{
    SceneFile s = brushed_sphere(0.28f, 0.9f, 30.0f);
    for (FileVertex& v : s.vertices)
        v.tangent.w = -1.0f;
    return s;
}

SceneFile mirror()
{
    SceneFile s = sphere();
    s.material = metal(0.08f);
    return s;
}

SceneFile round_lobe()
{
    SceneFile s = sphere();
    s.material = metal(0.4f);
    return s;
}

// Returns an area's share of light in a direction: 1 within, 0 outside, with soft edges. Angles in degrees.
double panel(double azimuth, double elevation, double at_azimuth, double at_elevation, double half_width, double half_height)
{
    const double across = std::remainder(azimuth - at_azimuth, 360.0) * std::cos(elevation * kPi / 180.0);
    const double inside = std::min(half_width - std::abs(across), half_height - std::abs(elevation - at_elevation));
    const double t = std::clamp(inside / 4.0 + 0.5, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

} // namespace

const std::vector<ConformScene>& conform_scenes()
{
    const glm::mat4 still(1.0f);
    static const std::vector<ConformScene> scenes = {
        {"mirror", "a smooth ball: environment, view and exposure", true, false, mirror},
        {"round", "a round lobe: prefiltered light", true, false, round_lobe},
        {"rotation_0", "no rotation: the highlight stretches along the tangent", true, false,
         [] { return brushed_sphere(0.28f, 0.9f, 0.0f); }},
        {"rotation_30", "30 degrees, counter-clockwise", true, false, [] { return brushed_sphere(0.28f, 0.9f, 30.0f); }},
        {"rotation_90", "90 degrees: the highlight stretches along the bitangent", true, false,
         [] { return brushed_sphere(0.28f, 0.9f, 90.0f); }},
        {"strength_half", "a strength of a half, which the formula squares", true, false, [] { return brushed_sphere(0.28f, 0.5f, 0.0f); }},
        {"rough", "a rough lobe", true, false, [] { return brushed_sphere(0.7f, 0.8f, 0.0f); }},
        {"smooth", "a smooth lobe of full strength", true, false, [] { return brushed_sphere(0.15f, 1.0f, 0.0f); }},
        {"direction_map", "directions from a texture", true, false, directions_by_map},
        {"strength_map", "strength from a texture's blue, 0 in its middle", true, false, strength_by_map},
        {"linear_map", "one direction from a texture: its values are linear, not sRGB", true, false, one_direction_by_map},
        {"second_coordinates", "directions by the second texture coordinates", true, false, second_coordinates},
        {"moved_coordinates", "KHR_texture_transform on the directions", true, false, moved_coordinates},
        {"own_tangents", "tangents that the coordinates do not give", true, false, tangents_of_their_own},
        {"no_tangents", "no tangents: they follow from the coordinates", true, false, without_tangents},
        {"left_handed", "tangents with w = -1", true, false, left_handed_tangents},
        {"mirrored_coordinates", "mirrored coordinates on the left half", true, false, mirrored_coordinates},
        {"mirrored_node", "a node that mirrors", true, false,
         [still] { return with_node(glm::scale(glm::mat4(1.0f), glm::vec3(-1.0f, 1.0f, 1.0f)), still); }},
        {"skewed_node", "nodes that stretch and skew", true, false,
         [] {
             return with_node(glm::rotate(glm::mat4(1.0f), 0.6f, glm::vec3(0.0f, 0.0f, 1.0f)),
                              glm::scale(glm::mat4(1.0f), glm::vec3(1.05f, 0.55f, 0.8f)));
         }},
        {"normal_map", "a normal map under the lobe", true, false, under_a_normal_map},
        {"pole", "the pole, where tangents meet", true, false, from_above},
        {"grazing", "a ball's limb, at grazing angles", true, false, at_the_limb},
        {"back", "the inside of a double-sided bowl", true, false, from_behind},
        {"minified", "a texture of directions from afar", true, false, minified},
        {"dielectric", "a plastic: Fresnel's reflectance, and the light that is left for the diffuse part", true, false, dielectric},
        {"high_index", "an index of 2.4: the diffuse part gets the light that is not reflected", true, false, high_index},
        {"dark_limb", "a dark plastic at grazing angles, where reflectance rises", true, false, dark_limb},
        {"few_triangles", "a ball of few triangles: its normals are the ball's", true, false, few_triangles},
        {"coat", "a clear coat over the lobe", true, false, coated},
        {"lamp", "a directional light alone", false, false, under_a_lamp},
        {"area_light", "a rectangle of light alone", false, true, [] { return brushed_sphere(0.35f, 0.85f, 20.0f); }},
    };
    return scenes;
}

std::vector<std::string> scene_names()
{
    std::vector<std::string> names;
    for (const ConformScene& scene : conform_scenes())
        names.push_back(scene.name);
    return names;
}

AreaLight conform_area_light()
{
    AreaLight light;
    light.shape = AreaShape::quad;
    const glm::vec3 centre(1.8f, 1.6f, 2.2f), n = glm::normalize(-centre);
    const glm::vec3 x = glm::normalize(glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), n)) * 0.5f, y = glm::normalize(glm::cross(n, x)) * 1.0f;
    light.points = {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
    light.radiance = glm::vec3(9.0f, 8.0f, 6.0f);
    return light;
}

Image conform_environment()
{
    constexpr int kWidth = 1024, kHeight = 512;
    Image image = make_image(kWidth, kHeight, 3, PixelType::f32);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double azimuth = ((x + 0.5) / kWidth - 0.5) * 360.0; // from +X towards +Z
            const double elevation = 90.0 - (y + 0.5) / kHeight * 180.0;
            const double up = std::sin(elevation * kPi / 180.0);
            const glm::dvec3 high(0.34, 0.40, 0.52), level(0.20, 0.20, 0.20), low(0.11, 0.09, 0.06);
            glm::dvec3 light = up > 0.0 ? glm::mix(level, high, up) : glm::mix(level, low, -up);
            const auto add = [&](const glm::dvec3& radiance, double at, double height, double half_width, double half_height) {
                light += radiance * panel(azimuth, elevation, at, height, half_width, half_height);
            };
            add({5.0, 4.2, 3.2}, 55.0, 38.0, 12.0, 22.0);  // before and to the right
            add({1.4, 2.4, 3.8}, 165.0, 12.0, 9.0, 36.0);  // to the left
            add({2.2, 2.4, 2.0}, -80.0, 22.0, 46.0, 8.0);  // behind
            add({2.6, 0.5, 0.3}, 105.0, -34.0, 14.0, 9.0); // below
            add({0.5, 2.2, 0.7}, 20.0, -14.0, 7.0, 16.0);  // at the right, low
            add({4.0, 4.0, 4.0}, -20.0, 74.0, 8.0, 8.0);   // overhead
            for (int c = 0; c < 3; ++c)
                image.f32()[(y * kWidth + x) * 3 + c] = static_cast<float>(light[c]);
        }
    return image;
}

} // namespace burnish
