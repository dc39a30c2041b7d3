// Lane code for normals' and lobes' mip levels. Texels are in the lanes and sums have a fixed order, so the bits depend neither on the
// lane width nor on the work's split. Rows are planes, one after another, `stride` floats apart. `count` texels in each plane are written
// in whole slots, and rows have room for that. Interfaces use plain pointers.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish::mip {

inline constexpr int kRowSlots = 16, kPointPlanes = 6, kMostStates = 9, kLobeChannels = 5;

constexpr float kMostSlope = 5.6712818f; // the tangent at 80 degrees, for mean slopes

// Indices for the means whose product forms a covariance: for slopes, and for normals in space.
struct MeanPair {
    std::size_t i, j;
};
constexpr MeanPair kFlatPairs[] = {{0, 0}, {1, 1}, {0, 1}};
constexpr MeanPair kSpacePairs[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

// Returns the distance between a row's planes, padded to whole slots.
inline std::size_t row_stride(std::size_t texels)
{
    return (texels + kRowSlots - 1) / kRowSlots * kRowSlots;
}

struct CodeWork { // converts 8-bit codes to numbers in [0,1]
    const std::uint8_t* codes;
    int channels;      // per texel: 3 or 4
    int first, planes; // the wanted channels
    std::size_t count, stride;
    float* to;
};

struct BlendWork {     // interpolates between two rows of a map, at the places of a wider or narrower row
    std::size_t count; // written in whole slots
    const float *low, *high;
    const std::int32_t *left, *right; // the columns beside each place, in whole slots
    const float* share;               // the right column's share
    float of_high;                    // the high row's share
    float* to;
};

struct NormalWork { // converts a normal map's red, green, blue in place to unit normals; any length
    std::size_t count, stride;
    float scale; // factor on x and y
    float* planes;
};

struct DirectionWork { // converts a direction map's red, green, blue to tensors; values that are not finite give none
    std::size_t count, stride;
    const float* codes; // 3 planes
    float* tensors;     // 6 planes: xx, yy, xy with powers 2 and 4 (anisotropy.h)
};

struct CovarianceWork {
    std::size_t count, stride;
    const float* roughness; // null: factor alone
    const float* tensors;   // 6 planes: xx, yy, xy with powers 2 and 4; null: along the tangent
    float factor, strength, cosine, sine;
    float* to; // 3 planes
};

// Averaged quantities. baseline: normal, a, b, c. covariance: normal, covariance. leadr: mean slope, slope covariance. ssgt and kappa:
// normal, squared widths in space.
enum class Mean : std::uint32_t { baseline, covariance, leadr, ssgt, kappa };

struct StateWork { // makes points' states: kPointPlanes planes, unit normal, covariance in its frame
    Mean mean;
    std::size_t count, stride;
    const float* points;
    float* states;
};

struct MergeWork { // merges squares with four texels: their mean, and their means' spread
    Mean mean;
    float spread; // factor on that spread, if the mean has any
    std::size_t count, stride;
    const float *top, *bottom; // two texel rows' states
    std::size_t from_stride;
    int across; // 2; 1: a level with unchanged width
    float* states;
};

struct TexelWork { // makes texels from states
    Mean mean;
    std::size_t count, stride;
    float* states; // normals are made unit again if a filter goes on from level to level
    float* texels; // kLobeChannels numbers per texel
};

struct TensorWork { // converts points to texels' planes
    std::size_t count, stride;
    const float* points;
    float* to; // kLobeChannels planes with the same stride: the normal's x and y, a, b, c
};

struct HashWork { // hashes a point row; numbers kRowSlots apart in a plane are mixed into one
    std::size_t stride;
    const float* points;
    std::uint32_t* mixed; // [kPointPlanes][kRowSlots], output
};

struct Fns {
    void (*codes)(const CodeWork& work);
    void (*blend)(const BlendWork& work);
    void (*normals)(const NormalWork& work);
    void (*directions)(const DirectionWork& work);
    void (*covariances)(const CovarianceWork& work);
    void (*states)(const StateWork& work);
    void (*merge)(const MergeWork& work);
    void (*texels)(const TexelWork& work);
    void (*tensors)(const TensorWork& work);
    void (*hash)(const HashWork& work);
};

} // namespace burnish::mip

namespace burnish {
BN_DECLARE_FNS(mip::Fns);
} // namespace burnish
