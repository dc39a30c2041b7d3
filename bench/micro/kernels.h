// Each technique as a function over arrays of surfaces: timed for each instruction set, and counted.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"
#include "raster/tile/tile_types.h"

namespace burnish {

struct KernelSurfaces {              // count surfaces, a multiple of 16; unit vectors
    const float *n[3], *v[3], *t[3]; // normal, to the eye, tangent
    int count, samples;              // samples: of techniques that count them
    float sigma_u, sigma_v;          // for every lobe
};

struct KernelWork { // total over all surfaces so far; 0 outside the counting build
    std::uint64_t operations, bytes;
};

using KernelFn = void (*)(const FrameParams&, const KernelSurfaces&, float* rgb); // rgb: 3 count
struct KernelFns {
    const KernelFn* techniques; // in the order of shading/models.def
    KernelWork (*work)();
};
BN_DECLARE_FNS(KernelFns);

} // namespace burnish
