// Lane code of the two integrals over the sphere that dominate a bake. Each lane holds a texel and adds its terms in list order. So the
// bits depend neither on the lane width nor on the split of work. Interfaces use plain pointers, because instruction-set objects may not
// use containers.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish {

struct PrefilterTerm { // light from one place
    float x, y, z;     // unit direction
    float angle;       // sr
    float r, g, b;     // radiance times solid angle
};

struct PrefilterInput {
    const PrefilterTerm* terms;
    int count;
    float alpha; // GGX width, (0,1]
};

inline constexpr int kPrefilterBlock = 4; // texels along an edge of a block that shares its terms

struct IrradianceInput {
    const float *x, *y, *z; // integrals of the unit direction over source texels
    const float *r, *g, *b; // radiance
    int count, row;         // number of texels; texels per partial sum
};

struct BakeFns { // work on one face of size x size, a power of two
    // Writes RGB of the block whose first texel is (x, y), row by row. The block has kPrefilterBlock^2 texels, or the whole face if that
    // is smaller. Each texel is the mean of the terms under GGX with V = N = R, weighted by n.l.
    void (*prefilter)(const PrefilterInput& input, int face, int size, int x, int y, float* rgb);
    // Writes `count` RGB texels from `first` on (row-major): the cosine-weighted mean radiance.
    void (*irradiance)(const IrradianceInput& input, int face, int size, int first, int count, float* rgb);
};

BN_DECLARE_FNS(BakeFns);

} // namespace burnish
