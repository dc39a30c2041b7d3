// Lane code for mipmap nets. Texels are in the lanes. Sums over inputs run in order, and sums over texels have sixteen parts, so the
// bits depend neither on the lane width nor on how work is split. Interfaces use plain pointers.
//
// Numbers are floats, or doubles in the tests' oracle. Texels have five channels, stored as planes: nx, ny (unit normal), a, b, c (tensor,
// see tensor.h). If a level has n texels, texel j n + i in the next finer level is the j-th among four under texel i: j = 0 to 3 advance
// along x first. kSlots divides every n.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish::mipnet {

enum class Lobe : std::uint32_t { ggx_aniso, beckmann, ashikhmin_shirley };
enum class Layout : std::uint32_t { paper, cov };

inline constexpr int kChannels = 5, kMostLayers = 8, kSlots = 16;
inline constexpr int kTrainedLevels = 5, kTileSide = 32, kTiles = kSlots; // in a shard: 16 tiles with 32 x 32 texels, one per lane
inline constexpr float kLeak = 0.01f;                                     // a hidden unit's slope below 0

struct Dense { // a net's layers; width[0] inputs, width[count] outputs
    int count = 0;
    int width[kMostLayers + 1] = {};
    std::size_t weights[kMostLayers] = {}, bias[kMostLayers] = {}; // first index; [output][input]
};

struct Plan { // the number list's layout
    Lobe lobe = Lobe::ggx_aniso;
    Layout layout = Layout::cov;
    Dense a, b; // a: from four texels; b: from sixteen, those four, and `a`'s result. b.count 0: `a` alone
    std::size_t kappa = 0, count = 0;
    bool far = false; // `b` also sees the sixty-four texels under those sixteen
};

struct ForwardWork { // one level
    const Plan* plan;
    const void* weights;       // plan->count numbers
    std::size_t texels;        // in the level, n
    const void* children;      // kChannels planes with 4 n
    const void* grandchildren; // with 16 n; null: none, net `a` makes the level alone
    const void* great;         // with 64 n, for nets that are `far`; null: each grandchild stands for its four
    void* out;                 // of n
    void* memory;              // forward_bytes(), at a cache line
};

struct RadianceWork { // texels' reflected radiance
    Lobe lobe;
    std::size_t texels;
    const float* planes;   // kChannels planes
    const float* to_light; // 3 planes, unit vectors
    const float* to_eye;
    const float* intensity; // a plane
    float f0, diffuse;      // reflectances
    float* out;
};

struct Fns {
    std::size_t number_bytes;
    std::size_t (*forward_bytes)(const Plan& plan, std::size_t texels);
    void (*forward)(const ForwardWork& work);
    void (*radiance)(const RadianceWork& work);
    void (*toned)(std::size_t count, const float* radiance, float* shown); // see tone() in tensor.h; count: a multiple of kSlots
};

} // namespace burnish::mipnet

namespace burnish {
BN_DECLARE_FNS(mipnet::Fns);
} // namespace burnish
