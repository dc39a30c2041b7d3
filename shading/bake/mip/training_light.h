// Training light for the optimiser: direction pairs (to light, to eye), and the texels' reflection under them.
#pragma once
#include <vector>

#include "shading/bake/mip/mip_error.h"
#include "shading/bake/mipnet/mip_optimiser_fns.h"

namespace burnish {

inline constexpr int kTrainingPairs = 256, kTrainingBatch = 32;

struct TrainingLight {
    std::vector<float> directions, intensity, rows; // in the layout of PairLights and GatherWork
};
TrainingLight training_light(const MipErrorSurface& surface); // drawn from the distribution of training, with a fixed seed

struct FootprintAxis { // footprint of texel i of `target` along an axis with `source` texels
    std::vector<int> at;
    std::vector<float> weight;
    FootprintAxis(int i, int source, int target);
};

// Writes the mean radiance of a texel's footprint, by pair.
void gather_light(const mipnet::Texels& texels, const MipErrorSurface& surface, const TrainingLight& light, const FootprintAxis& across,
                  const FootprintAxis& down, float* to);

} // namespace burnish
