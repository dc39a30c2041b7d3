// What levels of normals and lobes are made with, as lane code: texels are in the lanes, sums have one order, so the bits depend neither on
// the lane width nor on how work is shared out. Rows are planes, one after another, `stride` floats apart; `count` texels of each are made
// in whole slots, and rows have room for that. Plain pointers only.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish::mip {

inline constexpr int kRowSlots = 16, kPointPlanes = 6, kMostStates = 9, kLobeChannels = 5;

constexpr float kMostSlope = 5.6712818f; // of 80 degrees, of mean slopes

// Pairs of means whose product a place of the numbers after them is of, where these are covariances: of slopes, of normals in space.
struct MeanPair {
    std::size_t i, j;
};
constexpr MeanPair kFlatPairs[] = {{0, 0}, {1, 1}, {0, 1}};
constexpr MeanPair kSpacePairs[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

inline std::size_t row_stride(std::size_t texels)
{
    return (texels + kRowSlots - 1) / kRowSlots * kRowSlots;
}

struct CodeWork { // codes of 8 bits as numbers in [0,1]
    const std::uint8_t* codes;
    int channels;      // of a texel: 3 or 4
    int first, planes; // of them, those that are wanted
    std::size_t count, stride;
    float* to;
};

struct NormalWork { // red, green, blue of a normal map in place to unit normals, whatever their length
    std::size_t count, stride;
    float scale; // of x and y
    float* planes;
};

struct CovarianceWork {
    std::size_t count, stride;
    const float* roughness; // null: factor alone
    const float* tensors;   // 6 planes: xx, yy, xy of powers 2 and 4; null: along the tangent
    float factor, strength, cosine, sine;
    float* to; // 3 planes
};

// What is averaged. baseline: normal, a, b, c; covariance: normal, covariance; leadr: mean slope, covariance of slopes; ssgt and kappa:
// normal, squared widths in space.
enum class Mean : std::uint32_t { baseline, covariance, leadr, ssgt, kappa };

struct StateWork { // points, kPointPlanes planes: unit normal, covariance in its frame
    Mean mean;
    std::size_t count, stride;
    const float* points;
    float* states;
};

struct MergeWork { // squares of four texels: their mean, and what their means differ by
    Mean mean;
    float spread; // times that difference, where the mean has any
    std::size_t count, stride;
    const float *top, *bottom; // states of rows of texels
    std::size_t from_stride;
    int across; // 2; 1: a level that is no less wide
    float* states;
};

struct TexelWork { // what states make
    Mean mean;
    std::size_t count, stride;
    float* states; // normals are made unit again where a filter goes on from level to level
    float* texels; // kLobeChannels numbers each
};

struct TensorWork { // of points
    std::size_t count, stride;
    const float* points;
    float* to; // kLobeChannels planes of the same stride: x and y of the normal, a, b, c
};

struct HashWork { // a row of points; numbers of a plane that are kRowSlots apart are mixed into one
    std::size_t stride;
    const float* points;
    std::uint32_t* mixed; // [kPointPlanes][kRowSlots], written
};

struct Fns {
    void (*codes)(const CodeWork& work);
    void (*normals)(const NormalWork& work);
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
