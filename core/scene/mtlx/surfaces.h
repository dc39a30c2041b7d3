// MaterialX surfaces as values in one part list.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/scene/mtlx/document.h"
#include "core/scene/scene.h"

namespace burnish::mtlx {

enum class Part {
#define BN_PART(part, text, standard, standard_value, open, open_value, gltf, gltf_value) part,
#include "core/scene/mtlx/parts.def"
    count
};

using Parts = std::array<Input, static_cast<std::size_t>(Part::count)>;

// Returns the surface's parts, with its kind's defaults. unknown: receives input names that are no part, where a picture or a
// number other than 0 stands.
Parts parts_of(const SurfaceMaterial& surface, std::vector<std::string>& unknown);

inline const Input& at(const Parts& parts, Part part)
{
    return parts[static_cast<std::size_t>(part)];
}
inline float number(const Parts& parts, Part part)
{
    return at(parts, part).value.x;
}

// A GGX lobe's widths along the tangent and across it.
struct Widths {
    double along, across;
};

// Returns the widths of a surface of this kind. roughness, anisotropy: the file's, [0,1]. standard_surface: MaterialX 1.38, node
// roughness_anisotropy. open_pbr_surface: OpenPBR 1.1, "Anisotropy". gltf_pbr: KHR_materials_anisotropy.
Widths widths_of(const std::string& kind, double roughness, double anisotropy);

// Sets roughness, anisotropy_strength and anisotropy_rotation so that the lobe has these widths, both at most 1.
void put_widths(const Widths& widths, double rotation_rad, Material& m);

// Sets the emission. light: cd/m^2, linear.
void put_emission(const glm::vec3& light, Material& m);

// A surface's lobe by its roughness.
struct LobeOfRoughness {
    std::string kind;
    double anisotropy, coat, coat_roughness, coat_roughens; // [0,1]
    double below_coat(double roughness) const;              // roughness below the coat
    Widths widths(double roughness) const;
};
LobeOfRoughness lobe_of(const SurfaceMaterial& surface, const Parts& parts);

// Returns the material without its textures. wanting: receives inputs that the material draws otherwise.
Material material_of(const SurfaceMaterial& surface, const Parts& parts, std::vector<std::string>& wanting);

} // namespace burnish::mtlx
