#include "core/scene/mtlx/surfaces.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/math/scalar_math.h"

namespace burnish::mtlx {
namespace {

enum Kind { kStandard, kOpen, kGltf };

Kind kind_of(const std::string& name)
{
    return name == "standard_surface" ? kStandard : name == "open_pbr_surface" ? kOpen : kGltf;
}

struct PartInfo {
    const char* names[3];
    float values[3];
};
constexpr PartInfo kParts[] = {
#define BN_PART(part, text, standard, standard_value, open, open_value, gltf, gltf_value)                                                  \
    {{standard, open, gltf}, {standard_value, open_value, gltf_value}},
#include "core/scene/mtlx/parts.def"
};

// Inputs without a part that say nothing alone.
constexpr const char* kSilent[] = {"subsurface_color",
                                   "subsurface_radius",
                                   "subsurface_radius_scale",
                                   "subsurface_scale",
                                   "subsurface_anisotropy",
                                   "subsurface_scatter_anisotropy",
                                   "transmission_scatter_anisotropy",
                                   "coat_darkening",
                                   "coat_rotation"};

bool says_something(const Input& input)
{
    if (std::find(std::begin(kSilent), std::end(kSilent), input.name) != std::end(kSilent))
        return false;
    return input.picture || input.value != glm::vec3(0.0f);
}

float unit(float x)
{
    return std::clamp(x, 0.0f, 1.0f);
}
glm::vec3 unit(const glm::vec3& x)
{
    return glm::clamp(x, 0.0f, 1.0f);
}

// Sets transmission and absorption. Light through a surface is tinted by the base colour, which the opaque part of it shares.
void put_transmission(Kind kind, const Parts& parts, Material& m)
{
    m.transmission = unit(number(parts, Part::transmission));
    if (const float abbe = number(parts, Part::abbe_number); abbe > 0.0f)
        m.dispersion = std::max(number(parts, Part::dispersion), 0.0f) * 20.0f / abbe;
    const glm::vec3 colour = unit(at(parts, Part::transmission_color).value);
    const float depth = std::max(number(parts, Part::transmission_depth), 0.0f);
    if (depth > 0.0f)
        m.attenuation_distance = depth, m.attenuation_color = colour;
    if (kind == kGltf)
        return;
    const glm::vec3 tint = depth > 0.0f ? glm::vec3(1.0f) : colour;
    for (int c = 0; c < 3; ++c)
        m.base_color[c] += (tint[c] - m.base_color[c]) * m.transmission;
}

void put_alpha(Kind kind, const Parts& parts, Material& m)
{
    const glm::vec3 opacity = unit(at(parts, Part::opacity).value);
    const float mode = number(parts, Part::alpha_mode);
    if (mode < 0.5f)
        return;
    m.base_color.a = kind == kStandard ? (opacity.r + opacity.g + opacity.b) / 3.0f : opacity.r;
    if (mode < 1.5f)
        m.alpha_mode = AlphaMode::mask, m.alpha_cutoff = std::max(number(parts, Part::alpha_cutoff), 0.0f);
    else if (m.base_color.a < 1.0f)
        m.alpha_mode = AlphaMode::blend;
}

void put_film(Kind kind, const Parts& parts, Material& m)
{
    const float thickness = std::max(number(parts, Part::film_thickness), 0.0f) * (kind == kOpen ? 1000.0f : 1.0f); // micrometres there
    m.iridescence =
        kind == kStandard && thickness == 0.0f && !at(parts, Part::film_thickness).picture ? 0.0f : unit(number(parts, Part::film));
    m.iridescence_thickness = thickness, m.iridescence_thickness_least = 0.0f;
    m.iridescence_ior = std::max(number(parts, Part::film_ior), 1.0f);
}

} // namespace

void put_emission(const glm::vec3& light, Material& m)
{
    const glm::vec3 positive = glm::max(light, 0.0f);
    const float most = std::max({positive.r, positive.g, positive.b, 1.0f});
    m.emissive = positive / most, m.emissive_strength = most;
}

LobeOfRoughness lobe_of(const SurfaceMaterial& surface, const Parts& parts)
{
    const auto share = [&](Part part) { return static_cast<double>(unit(number(parts, part))); };
    return {surface.kind, share(Part::anisotropy), share(Part::coat), share(Part::coat_roughness), share(Part::coat_roughens)};
}

// OpenPBR 1.1, "Roughening"; standard_surface, "coat_affect_roughness".
double LobeOfRoughness::below_coat(double r) const
{
    if (kind_of(kind) != kOpen)
        return r + (1.0 - r) * coat * coat_roughness * coat_roughens;
    const double c = coat_roughness, both = std::min(2.0 * c * c * c * c + r * r * r * r, 1.0);
    return r + (std::sqrt(std::sqrt(both)) - r) * coat;
}

Widths LobeOfRoughness::widths(double roughness) const
{
    return widths_of(kind, below_coat(roughness), anisotropy);
}

Parts parts_of(const SurfaceMaterial& surface, std::vector<std::string>& unknown)
{
    const Kind kind = kind_of(surface.kind);
    Parts parts;
    for (std::size_t i = 0; i < parts.size(); ++i)
        parts[i].name = kParts[i].names[kind], parts[i].value = glm::vec3(kParts[i].values[kind]);
    for (const Input& input : surface.inputs) {
        const auto part = std::find_if(parts.begin(), parts.end(), [&](const Input& p) { return p.name == input.name; });
        if (part != parts.end())
            *part = input;
        else if (says_something(input))
            unknown.push_back(input.name);
    }
    return parts;
}

Widths widths_of(const std::string& kind, double roughness, double anisotropy)
{
    const double r2 = roughness * roughness, a = std::clamp(anisotropy, 0.0, 1.0);
    if (kind == "gltf_pbr")
        return {r2 + (1.0 - r2) * a * a, r2};
    if (kind == "open_pbr_surface") {
        const double along = r2 * std::sqrt(2.0 / (1.0 + (1.0 - a) * (1.0 - a)));
        return {along, (1.0 - a) * along};
    }
    const double aspect = std::sqrt(1.0 - std::min(a, 0.98));
    return {std::min(r2 / aspect, 1.0), r2 * aspect};
}

void put_widths(const Widths& widths, double rotation_rad, Material& m)
{
    const double wide = std::min(std::max(widths.along, widths.across), 1.0), narrow = std::min(widths.along, widths.across);
    const double turn = rotation_rad + (widths.along < widths.across ? 0.5 * kPi : 0.0);
    m.roughness = static_cast<float>(std::sqrt(narrow));
    m.anisotropy_strength = narrow < 1.0 ? static_cast<float>(std::sqrt((wide - narrow) / (1.0 - narrow))) : 0.0f;
    m.anisotropy_rotation = static_cast<float>(std::fmod(turn, 2.0 * kPi));
}

Material material_of(const SurfaceMaterial& surface, const Parts& parts, std::vector<std::string>& wanting)
{
    const Kind kind = kind_of(surface.kind);
    Material m;
    m.name = surface.name;
    // Base
    m.base_color = glm::vec4(unit(at(parts, Part::base_color).value * number(parts, Part::base)), 1.0f);
    m.metallic = unit(number(parts, Part::metalness));
    const double turns = static_cast<double>(number(parts, Part::rotation)) * (kind == kGltf ? 1.0 : 2.0 * kPi);
    put_widths(lobe_of(surface, parts).widths(static_cast<double>(unit(number(parts, Part::roughness)))), turns, m);
    m.specular = unit(number(parts, Part::specular));
    m.specular_color = glm::max(at(parts, Part::specular_color).value, 0.0f);
    m.ior = std::max(number(parts, Part::ior), 0.0f);
    put_transmission(kind, parts, m);
    m.thickness = std::max(number(parts, Part::thickness), 0.0f);
    // Layers
    m.sheen_color = unit(at(parts, Part::sheen_color).value * number(parts, Part::sheen));
    m.sheen_roughness = unit(number(parts, Part::sheen_roughness));
    if (kind == kStandard) // the lobe's own width
        m.sheen_roughness = std::sqrt(m.sheen_roughness);
    m.clearcoat = unit(number(parts, Part::coat)), m.clearcoat_roughness = unit(number(parts, Part::coat_roughness));
    m.clearcoat_ior = std::clamp(number(parts, Part::coat_ior), 1.0f, 1e3f);
    put_film(kind, parts, m);
    // Emission and alpha
    put_emission(at(parts, Part::emission_color).value * number(parts, Part::emission), m);
    put_alpha(kind, parts, m);
    // Tell what is drawn otherwise
    if (!at(parts, Part::occlusion).picture && number(parts, Part::occlusion) != 1.0f)
        wanting.push_back(at(parts, Part::occlusion).name + " (none without a picture)");
    if (const glm::vec3 base = at(parts, Part::base_color).value * number(parts, Part::base); base != unit(base))
        wanting.push_back(at(parts, Part::base_color).name + " (drawn within 0 and 1)");
    if (m.clearcoat > 0.0f || at(parts, Part::coat).picture) {
        if (at(parts, Part::coat_color).value != glm::vec3(1.0f))
            wanting.push_back(at(parts, Part::coat_color).name + " (drawn white)");
    }
    if (m.metallic > 0.0f && kind != kGltf && at(parts, Part::specular_color).value != glm::vec3(1.0f))
        wanting.push_back(at(parts, Part::specular_color).name + " of metal (drawn white at its edges)");
    if (m.transmission > 0.0f && number(parts, Part::thin_walled) != 0.0f)
        wanting.push_back(at(parts, Part::thin_walled).name + " (open meshes are thin, closed ones are not)");
    return m;
}

} // namespace burnish::mtlx
