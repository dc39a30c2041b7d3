// What one step of training looks at: tiles of materials, mirrored at random, and pairs of directions to light and eye.
#pragma once
#include <cstdint>
#include <vector>

#include "shading/bake/mipnet/families.h"

namespace burnish::mipnet {

class Random;

struct Batch { // a shard, as StepWork wants it
    std::vector<float> texels, tiles, pairs;
};

// Where texel (x, y) of tile `tile` lies in a plane of level 0.
std::size_t place_in_shard(int x, int y, int tile);

inline constexpr double kUsualMirrored = 0.6;

// Unit directions to a light and to an eye, six numbers so far apart. The share `mirrored` of them mirror directions of normals near +z, of
// lobes cos^10 and cos^80, half each, where highlights are; the others are from anywhere.
void put_pair(Random& random, float* pair, std::size_t apart, double mirrored = kUsualMirrored);

// Nothing but the numbers given decides what is in it. pairs: directions a tile.
Batch make_batch(const TrainingSet& set, std::uint64_t seed, int pairs, double mirrored = kUsualMirrored);

} // namespace burnish::mipnet
