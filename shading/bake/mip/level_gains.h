// A factor per level for its reflectances, so that the level reflects as much light as level 0. Facets of level 0 that turn away from
// light or eye reflect nothing. One lobe about a mean normal cannot show this, however wide the lobe is.
#pragma once
#include <functional>
#include <vector>

#include "shading/bake/mip/mip_error.h"

namespace burnish {

inline constexpr float kLeastGain = 0.5f, kMostGain = 2.0f;

// Reads texels (x, y) in a level (0: level 0), as kChannels planes with `count` numbers. count: a multiple of kSlots.
using LevelTexels = std::function<void(int level, std::size_t count, const int* x, const int* y, float* planes)>;

struct LevelSize {
    int width, height;
};

// Returns the gains of the levels after level 0, in [kLeastGain, kMostGain]. sizes: level 0 and all levels after it. The gain makes a
// level's mean radiance equal to level 0's. Light has radiance 1 from within 84 degrees of +z; eyes are on all sides. The estimate
// uses 2048 or 4096 points of the map that never change. The gain scales f0 and the diffuse part; grazing reflection stays. The bits
// depend neither on threads nor on the instruction set. rule: the lighting that the gains are made for.
std::vector<float> level_gains(const std::vector<LevelSize>& sizes, const LevelTexels& texels, const MipErrorSurface& surface, Gains rule);

// Returns the gains of texels' levels for the lighting that levels are judged by. levels: level 0 and all levels after it.
std::vector<float> level_gains(const std::vector<mipnet::Texels>& levels, const MipErrorSurface& surface);

// Returns the surface with reflectances times a gain, at most 1.
MipErrorSurface gained(const MipErrorSurface& surface, float gain);

} // namespace burnish
