// Lane code for rows of textures: box filters, halves, and filtered textures, which hold normals and moments of slopes. Points are planes
// as in mean_fns.h. Rows do not depend on the lane width.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish::mip {

// Textures of a material whose levels a mip filter makes. A `rest` is the remainder after rounding to halves.
enum FilteredTexture { kFilteredNormals, kFilteredMoments2, kFilteredMoments4, kFilteredRest2, kFilteredRest4, kFilteredTextures };

struct PointWork { // converts a level's texels to points
    std::size_t count, stride;
    const float* texels; // kLobeChannels numbers per texel
    float* points;       // kPointPlanes planes, in whole slots
};

struct WidthWork { // squares mean widths of lobes, (alpha_u + alpha_v) / 2
    std::size_t count, stride;
    const float* points;
    float* to; // in whole slots
};

struct MomentWork { // writes a row of each texture
    std::size_t count, stride;
    const float* points;
    const float* width2;                  // mean squared width of the lobes below each texel, in whole slots; null: of the point's own lobe
    bool gained;                          // gains include the lobes' widths
    float gain;                           // gain_of_taps()
    float reflected;                      // the level's factor on reflectances
    float unscale;                        // half the inverse of the normal map's scale
    const float* alpha;                   // of normals, in whole slots; null: 1
    std::uint16_t* to[kFilteredTextures]; // 4 halves per texel; null: not wanted
};

struct HalveWork {             // averages squares of four texels, 4 floats each, in doubles: rows first, then columns
    const float *top, *bottom; // rows of 2 * count texels
    std::size_t count;
    float* to;
};

struct HalfWork { // rounds numbers to halves
    const float* from;
    std::size_t count;
    bool rest; // the remainder after rounding, in place of the number
    std::uint16_t* to;
};

struct TextureFns {
    void (*halve)(const HalveWork& work);
    void (*halves)(const HalfWork& work);
    void (*points)(const PointWork& work);
    void (*widths)(const WidthWork& work);
    void (*moments)(const MomentWork& work);
};

} // namespace burnish::mip

namespace burnish {
BN_DECLARE_FNS(mip::TextureFns);
} // namespace burnish
