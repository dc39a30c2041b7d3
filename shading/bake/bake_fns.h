// The two integrals over the sphere that a bake spends its time in, as lane code. Texels are in the lanes and
// every lane adds its terms in the order of the list, so the bits depend neither on the lane width nor on how
// texels are shared out. Plain pointers only: the instruction-set objects see no containers.
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
    const float *x, *y, *z; // integrals of the unit direction over the source texels
    const float *r, *g, *b; // radiance
    int count, row;         // texels, and texels a partial sum
};

struct BakeFns { // of one face of size x size, a power of two
    // Writes the RGB texels of the block whose first texel is (x, y), kPrefilterBlock^2 of them or the face where that is smaller, row by
    // row: the mean of the terms under GGX with V = N = R, weighted by n.l.
    void (*prefilter)(const PrefilterInput& input, int face, int size, int x, int y, float* rgb);
    // Writes `count` RGB texels from `first` on (row-major).
    void (*irradiance)(const IrradianceInput& input, int face, int size, int first, int count, float* rgb);
};

BN_DECLARE_FNS(BakeFns);

} // namespace burnish
