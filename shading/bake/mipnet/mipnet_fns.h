// Lane code for mipmap nets. Texels are in the lanes. Sums over inputs run in order, and sums over texels have sixteen parts, so the
// bits depend neither on the lane width nor on how work is split. Interfaces use plain pointers.
//
// Numbers are floats, or doubles in the tests' oracle. Texels have five channels, stored as planes: nx, ny (unit normal), a, b, c (tensor,
// see tensor.h). If a level has n texels, texel j n + i in the next finer level is the j-th of four under texel i: j = 0 to 3 advance
// along x first. All n are multiples of kSlots.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish::mipnet {

enum class Lobe : std::uint32_t { ggx_aniso, beckmann, ashikhmin_shirley };
enum class Layout : std::uint32_t { paper, cov };
enum class Loss : std::uint32_t { l1, l2, charbonnier }; // of differences e in tonemapped radiance: |e|, e^2, sqrt(e^2 + .01^2)
enum class Tone : std::uint32_t { display, log };        // tonemapped radiance x: x / (1 + x) encoded as sRGB, or log(1 + x)

inline constexpr int kChannels = 5, kMostLayers = 8, kSlots = 16;
inline constexpr int kTrainedLevels = 5, kTileSide = 32, kTiles = kSlots; // of a shard: 16 tiles of 32 x 32, one per lane
inline constexpr float kLeak = 0.01f;                                     // slope of a hidden unit below 0

struct Dense { // layers of a net; width[0] inputs, width[count] outputs
    int count = 0;
    int width[kMostLayers + 1] = {};
    std::size_t weights[kMostLayers] = {}, bias[kMostLayers] = {}; // first index; [output][input]
};

struct Plan { // layout of the list of numbers
    Lobe lobe = Lobe::ggx_aniso;
    Layout layout = Layout::cov;
    Dense a, b; // a: from four texels; b: from sixteen, those four, and `a`'s result. b.count 0: `a` alone
    std::size_t kappa = 0, count = 0;
    bool far = false; // `b` also sees the sixty-four texels under those sixteen
};

struct ForwardWork { // one level
    const Plan* plan;
    const void* weights;       // plan->count numbers
    std::size_t texels;        // of the level, n
    const void* children;      // kChannels planes of 4 n
    const void* grandchildren; // of 16 n; null: none, net `a` makes the level alone
    const void* great;         // of 64 n, for nets that are `far`; null: each of the sixteen stands for its four
    void* out;                 // of n
    void* memory;              // forward_bytes(), at a cache line
};

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
    const void* const* taught = nullptr;
    float light = 0.0f; // weight of |mean radiance of a tile's level over the truth's - 1|
};

struct RadianceWork { // reflected radiance of texels
    Lobe lobe;
    std::size_t texels;
    const float* planes;   // kChannels planes
    const float* to_light; // 3 planes of unit vectors
    const float* to_eye;
    const float* intensity; // a plane
    float f0, diffuse;      // reflectances
    float* out;
};

struct Fns {
    std::size_t number_bytes;
    std::size_t (*forward_bytes)(const Plan& plan, std::size_t texels);
    void (*forward)(const ForwardWork& work);
    std::size_t (*step_bytes)(const Plan& plan, int pair_count);
    void (*step)(const StepWork& work);
    void (*radiance)(const RadianceWork& work);
    void (*toned)(std::size_t count, const float* radiance, float* shown); // see tone() in tensor.h; count: a multiple of kSlots
};

} // namespace burnish::mipnet

namespace burnish {
BN_DECLARE_FNS(mipnet::Fns);
} // namespace burnish
