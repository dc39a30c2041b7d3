// Training light for the optimiser: direction pairs (to light, to eye), and the texels' reflection under them.
#pragma once
#include <vector>

#include "shading/bake/mip/shown.h"
#include "shading/bake/mipnet/teacher_fns.h"

namespace burnish {

inline constexpr int kTaughtPairs = 256, kTaughtBatch = 32;

struct TaughtLight {
    std::vector<float> directions, intensity, rows; // in the layout of PairLights and GatherWork
};
TaughtLight taught_light(const ShownSurface& surface); // drawn from the distribution of training, with a fixed seed

struct TaughtAxis { // footprint of texel i of `target` along an axis with `source` texels
    std::vector<int> at;
    std::vector<float> weight;
    TaughtAxis(int i, int source, int target);
};

// Writes the mean radiance of a texel's footprint, by pair.
void gather_light(const mipnet::Texels& texels, const ShownSurface& surface, const TaughtLight& light, const TaughtAxis& across,
                  const TaughtAxis& down, float* to);

} // namespace burnish
