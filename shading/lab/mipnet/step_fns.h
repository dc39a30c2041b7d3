// Lane code for a training step of mipmap nets: loss and gradient of one shard.
#pragma once
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish::mipnet {

enum class Loss : std::uint32_t { l1, l2, charbonnier }; // of differences e in tonemapped radiance: |e|, e^2, sqrt(e^2 + .01^2)
enum class Tone : std::uint32_t { display, log };        // tonemapped radiance x: x / (1 + x) encoded as sRGB, or log(1 + x)

struct StepWork { // one shard of a training step: loss and its gradient
    const Plan* plan;
    const void* weights;
    const void* turned; // the same numbers, but each layer's weights as [input][output]
    const void* texels; // level 0: kChannels planes of kTiles 32^2
    const void* tiles;  // [3][kTiles]: f0, diffuse reflectance, intensity
    const void* pairs;  // [pairs][6][kTiles]: unit directions to the light and to the eye
    int pair_count;
    const double* level_weight; // for levels 1 to kTrainedLevels
    void* gradient;             // [plan->count][kSlots], added to
    void* loss;                 // [kTrainedLevels][kSlots], output
    void* memory;               // step_bytes(), at a cache line
    Loss kind = Loss::l1;
    Tone tone = Tone::display;
    // Planes of levels 1 to kTrainedLevels whose light is the target; null: level 0's light.
    const void* const* target_levels = nullptr;
    float light = 0.0f; // weight of |mean radiance of a tile's level over the target's - 1|
};

struct StepFns {
    std::size_t (*bytes)(const Plan& plan, int pair_count);
    void (*step)(const StepWork& work);
};

} // namespace burnish::mipnet

namespace burnish {
BN_DECLARE_FNS(mipnet::StepFns);
} // namespace burnish
