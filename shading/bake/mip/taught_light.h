// The light that levels by search are searched under: pairs of directions to light and eye, and what texels reflect under them.
#pragma once
#include <vector>

#include "shading/bake/mip/shown.h"
#include "shading/bake/mipnet/teacher_fns.h"

namespace burnish {

inline constexpr int kTaughtPairs = 256, kTaughtBatch = 32;

struct TaughtLight {
    std::vector<float> directions, intensity, rows; // as PairLights and GatherWork have them
};
TaughtLight taught_light(const ShownSurface& surface); // drawn as those of training are, always the same

struct TaughtAxis { // what lies below texel i of `target` along an axis of `source` texels
    std::vector<int> at;
    std::vector<float> weight;
    TaughtAxis(int i, int source, int target);
};

// Mean radiance of the texels below one, by pair.
void gather_light(const mipnet::Texels& texels, const ShownSurface& surface, const TaughtLight& light, const TaughtAxis& across,
                  const TaughtAxis& down, float* to);

} // namespace burnish
