// The two integrals over the sphere that a bake spends its time in, as lane code. Texels are in the lanes and
// every lane adds its terms in the order of the list, so the bits depend neither on the lane width nor on how
// texels are shared out. Plain pointers only: the instruction-set objects see no containers.
#pragma once
#include <cstdint>

namespace burnish {

struct PrefilterInput {
    const std::uint16_t* texels; // of the box chain, a CubeMap's
    int size, levels;
    float scale;
    const float *x, *y, *z;    // sample directions in the frame of the reflected direction (z), unit
    const float* weight;       // sum 1
    const std::int32_t* level; // of the chain, the finer of two
    const float* fraction;     // how far to the next level, [0,1]
    int count;
};

struct IrradianceInput {
    const float *x, *y, *z; // integrals of the unit direction over the source texels
    const float *r, *g, *b; // radiance
    int count, row;         // texels, and texels a partial sum
};

struct BakeFns { // both write `count` RGB texels of one face of size x size, from `first` on (row-major);
                 // size: power of two
    void (*prefilter)(const PrefilterInput& input, int face, int size, int first, int count, float* rgb);
    void (*irradiance)(const IrradianceInput& input, int face, int size, int first, int count, float* rgb);
};

// One copy an instruction set; calls are qualified.
inline namespace bn_scalar {
const BakeFns& bake_lanes();
}
inline namespace bn_avx2 {
const BakeFns& bake_lanes();
}
inline namespace bn_avx512 {
const BakeFns& bake_lanes();
}

// isa: 0 scalar, 1 AVX2, 2 AVX-512
bool bake_isa_available(int isa);
const BakeFns& bake_fns_of(int isa);
const BakeFns& bake_fns(); // the widest that the processor can run

} // namespace burnish
