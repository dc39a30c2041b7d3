// Levels of base colours, metalness and heights, as files of `burnish bake mip` hold them and textures take them.
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/texture.h"

namespace burnish {

TextureEncoding encoding_of(MapPart part);

// Of a map's texels and of how its sampler goes on at the border; of heights, of the normal map that they are in.
std::uint64_t map_hash(const Image& image, const Texture& sampler, MapPart part);

// As textures have them (make_texture_pyramid()), or, where id.kernel is kaiser or there are weights, as each_colour_row() has.
// facing: weights by texel, one channel, or null.
MapLevels make_map_levels(const Image& image, const Texture& sampler, const MapId& id, const Image* facing, const Jobs& jobs);

// Whether they have the sides, channels and range of what make_map_levels() makes of the image: 0 to 1 unless it holds floats.
bool are_of(const MapLevels& levels, const Image& image);

// Level 0 of the image, of which the levels are, the others of `levels`. Heights are in alpha.
TexturePyramid pyramid_of_map(const Image& image, const Texture& sampler, const MapLevels& levels);

} // namespace burnish
