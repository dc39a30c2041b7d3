// Mip levels for base colours, metalness and heights, in files of levels and in textures.
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/texture.h"

namespace burnish {

TextureEncoding encoding_of(MapPart part);

// Returns the hash of a map's texels and its sampler's border mode. Heights: the normal map that holds them.
std::uint64_t map_hash(const Image& image, const Texture& sampler, MapPart part);

// Makes the levels. Without weights and with a box kernel they equal make_texture_pyramid()'s, else each_colour_row()'s. facing: weight
// per texel, one channel, or null.
MapLevels make_map_levels(const Image& image, const Texture& sampler, const MapId& id, const Image* facing, const Jobs& jobs);

// Returns true if sides, channels and range match the output of make_map_levels() for the image. The range is 0 to 1 unless the image
// holds floats.
bool are_of(const MapLevels& levels, const Image& image);

// Returns the pyramid with the image as level 0 and the other levels from `levels`. Heights are in alpha.
TexturePyramid pyramid_of_map(const Image& image, const Texture& sampler, const MapLevels& levels);

} // namespace burnish
