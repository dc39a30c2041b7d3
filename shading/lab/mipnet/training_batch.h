// Input for a training step: material tiles, mirrored at random, and direction pairs (to light, to eye).
#pragma once
#include <cstdint>
#include <vector>

#include "shading/bake/mipnet/batch.h"
#include "shading/lab/mipnet/families.h"

namespace burnish::mipnet {

struct Batch { // a shard, in the layout of StepWork
    std::vector<float> texels, tiles, pairs;
};

// Makes a batch. The result depends on the arguments alone. pairs: direction pairs per tile.
Batch make_batch(const TrainingSet& set, std::uint64_t seed, int pairs, double mirrored = kDefaultMirrored);

} // namespace burnish::mipnet
