// The best lobe for one texel of a level at a time, as lane code: what level 0 reflects below it, and Adam on the difference to what a
// lobe reflects. Pairs of directions are in the lanes where light is gathered, texels where lobes are moved; sums have the order of
// pairs and texels, so the bits depend neither on the lane width nor on how work is shared out. Plain pointers only.
#pragma once
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish::mipnet {

inline constexpr int kLightRows = 13, kMostPairs = 256; // of a pair: what light of tensor.h holds

struct PairLights {
    Lobe lobe;
    int pairs;         // a multiple of kSlots, at most kMostPairs
    float f0, diffuse; // reflectances
    // [6][pairs]: unit directions to the light and to the eye; [pairs]
    const float *directions, *intensity;
    float* rows; // [kLightRows][pairs], written
};

struct GatherWork { // radiance of what lies below a texel
    Lobe lobe;
    int pairs;
    const float* rows;
    const float* planes[kChannels]; // of level 0
    std::size_t width;              // of its rows
    // texels of the footprint along an axis, and their shares, which sum to 1
    const int *columns, *lines;
    const float *across, *down;
    int column_count, line_count;
    float* out; // [pairs]
};

struct FitWork { // kSlots texels of a level
    Lobe lobe;
    int pairs;
    const float* rows;
    const float* radiance; // [pairs][kSlots]: wanted
    const float* starts;   // [start_count][kChannels][kSlots]
    int start_count, steps;
    int batch;                   // pairs a step, a divisor of `pairs`
    float* shown;                // [pairs][kSlots], memory
    float* out;                  // [kChannels][kSlots]: never worse than the best start, by the same pairs
    const float* rest = nullptr; // [pairs][kSlots]: radiance of what lies beside the lobe; null: nothing
    float share = 1.0f;          // of the lobe's own
    float* loss = nullptr;       // [kSlots]: mean difference of what is shown, by these pairs; null: nobody asks
};

struct TeacherFns {
    void (*light)(const PairLights& lights);
    void (*gather)(const GatherWork& work);
    void (*fit)(const FitWork& work);
};

} // namespace burnish::mipnet

namespace burnish {
BN_DECLARE_FNS(mipnet::TeacherFns);
} // namespace burnish
