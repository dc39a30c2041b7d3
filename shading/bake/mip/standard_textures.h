// Levels of a material as textures that other programs read: glTF 2.0's normal and metallic-roughness textures and that of
// KHR_materials_anisotropy, which hold a lobe's widths and axis as numbers that are interpolated one by one.
#pragma once
#include <string>
#include <vector>

#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish {

// Level 0 first, as large as the maps' grid, of floats in [0,1], three channels each. Factors are in them: the material that wears them has
// roughness, strength of anisotropy and scale of normals 1 and no rotation.
struct StandardLevels {
    std::vector<Image> normal;     // (1 + n) / 2
    std::vector<Image> roughness;  // green and blue: roughness, metalness; red is 1
    std::vector<Image> anisotropy; // red and green: (1 + d) / 2, blue: strength, of alpha_u = mix(alpha_v, 1, strength^2)
};

// d lies along the tangent and bitangent that are projected into the normal's plane (--frame-map gram-schmidt), of its two signs the one
// nearer to those of the texels before it and of the coarser level. metallic: levels of metalness, channel 0, of the same sizes, or empty:
// the number.
StandardLevels standard_levels(const MipSource& source, const MipLevels& levels, const std::vector<Image>& metallic, float metalness);

// What a level's textures say, at their texels, or, `between`, where four meet: as interpolated there.
mipnet::Texels standard_texels(const StandardLevels& textures, std::size_t level, bool between);
// The same of the levels themselves, as frames interpolate them: normals, and the lobes' covariances with that of normals as the filter has
// it.
mipnet::Texels filtered_texels(const MipSource& source, const MipLevels& levels, std::size_t level, bool between);

Image rounded_to_codes(const Image& unit);  // to n / 255, as 8 bits hold it
Image rounded_to_halves(const Image& unit); // as half floats hold it

} // namespace burnish
