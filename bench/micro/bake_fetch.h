// Loops over the fetch kernels for benchmarks, one table for each instruction set.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"
#include "shading/lang/tables.h"

namespace burnish {

struct FetchInput { // n directions (any length) and levels of detail, n a multiple of 16
    const float *x, *y, *z, *lod;
    int n;
};

struct FetchFns {
    // Fetches once in each direction and writes the results to rgb (3n).
    void (*single)(const std::uint16_t* texels, int size, int levels, const FetchInput& in, float* rgb);
    // Accumulates sixteen fetches around each direction.
    void (*sixteen)(const std::uint16_t* texels, int size, int levels, const FetchInput& in, float* rgb);
    // Fetches a texture at u, v = x, y, seen at a slant: at most `taps` trilinear taps along the longer side of a 1 x 4
    // texel footprint.
    void (*texture)(const TextureParams& texture, int taps, const FetchInput& in, float* rgb);
};
BN_DECLARE_FNS(FetchFns);

} // namespace burnish
