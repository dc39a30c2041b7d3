// Lane code that optimises lobes for a level's texels: gathers the light that level 0 reflects under a texel, and runs Adam on the
// difference to the lobe's reflection. Lanes are direction pairs during the gather, and texels during optimisation. Sums follow the pairs'
// and texels' order, so the bits depend neither on the lane width nor on the work's split. Interfaces use plain pointers.
#pragma once
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish::mipnet {

inline constexpr int kLightRows = 13, kMostPairs = 256; // for a pair: the light's fields in tensor.h

struct PairLights {
    Lobe lobe;
    int pairs;         // a multiple of kSlots, at most kMostPairs
    float f0, diffuse; // reflectances
    // [6][pairs]: unit directions to the light and to the eye; [pairs].
    const float *directions, *intensity;
    float* rows; // [kLightRows][pairs], output
};

struct GatherWork { // radiance from a texel's footprint
    Lobe lobe;
    int pairs;
    const float* rows;
    const float* planes[kChannels]; // of level 0
    std::size_t width;              // level 0's row length
    // The footprint's texels along each axis, and their shares, which sum to 1.
    const int *columns, *lines;
    const float *across, *down;
    int column_count, line_count;
    float* out; // [pairs]
};

struct FitWork { // kSlots texels in a level
    Lobe lobe;
    int pairs;
    const float* rows;
    const float* radiance; // [pairs][kSlots]: target
    const float* starts;   // [start_count][kChannels][kSlots]
    int start_count, steps;
    int batch;                   // pairs per step, divides `pairs`
    float* shown;                // [pairs][kSlots], scratch
    float* out;                  // [kChannels][kSlots]: never worse than the best start, under these pairs
    const float* rest = nullptr; // [pairs][kSlots]: other lobes' radiance; null: none
    float share = 1.0f;          // of the lobe itself
    float* loss = nullptr;       // [kSlots]: mean tonemapped difference, under these pairs; null: not needed
};

struct MipOptimiserFns {
    void (*light)(const PairLights& lights);
    void (*gather)(const GatherWork& work);
    void (*fit)(const FitWork& work);
};

} // namespace burnish::mipnet

namespace burnish {
BN_DECLARE_FNS(mipnet::MipOptimiserFns);
} // namespace burnish
