// Tiles of texels in the order of levels, and direction pairs (to light, to eye).
#pragma once
#include <cstddef>

namespace burnish::mipnet {

class Random;

// Returns texel (x, y)'s index in a plane of level 0, for tile `tile`.
std::size_t place_in_shard(int x, int y, int tile);

inline constexpr double kDefaultMirrored = 0.6;

// Draws unit directions to a light and to an eye: six numbers, `apart` floats apart. The share `mirrored` of lights mirrors the eye at
// normals near +z, drawn from lobes cos^10 and cos^80, half each, where highlights are. Other lights are uniform.
void put_pair(Random& random, float* pair, std::size_t apart, double mirrored = kDefaultMirrored);

} // namespace burnish::mipnet
