// Mip levels as textures for other programs: glTF 2.0's normal and metallic-roughness textures and the KHR_materials_anisotropy texture.
// These hold a lobe's widths and axis as numbers that are interpolated one by one.
#pragma once
#include <string>
#include <vector>

#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish {

// Levels from 0 on, as large as the maps' grid: floats in [0,1], three channels each. Factors are included: a material that uses these
// textures has roughness, anisotropy strength and normal scale 1, and no rotation.
struct StandardLevels {
    std::vector<Image> normal;     // (1 + n) / 2
    std::vector<Image> roughness;  // green and blue: roughness, metalness; red is 1
    std::vector<Image> anisotropy; // red and green: (1 + d) / 2; blue: strength, for alpha_u = mix(alpha_v, 1, strength^2)
};

// Makes the textures. d refers to tangent and bitangent projected into the normal's plane. Its sign is the one
// nearer to the directions at earlier texels and in the coarser level. metallic: metalness levels, channel 0, with the same sizes; empty:
// use `metalness`.
StandardLevels standard_levels(const MipSource& source, const MipLevels& levels, const std::vector<Image>& metallic, float metalness);

// Decodes a level's textures at their texels, or, if `between`, interpolated where four texels meet.
mipnet::Texels standard_texels(const StandardLevels& textures, std::size_t level, bool between);
// Returns the levels themselves in the same way. Frames interpolate normals and the lobes' covariances, plus the covariance of normals
// that the filter adds.
mipnet::Texels filtered_texels(const MipSource& source, const MipLevels& levels, std::size_t level, bool between);

Image rounded_to_codes(const Image& unit);  // to n / 255, as 8 bits store it
Image rounded_to_halves(const Image& unit); // as half floats store it

} // namespace burnish
