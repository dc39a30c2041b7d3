// The filter kernels as plain functions, one table an instruction set.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish {

struct TextureView { // TexturePyramid in plain pointers
    const std::uint16_t* texels;
    const std::int32_t* offset;
    const float *level_width, *level_height;
    std::int32_t levels, wrap_s, wrap_t, nearest;
};

struct FilterOps { // n is a multiple of 16; results are interleaved
    int lanes;
    void (*cube_place)(const float* x, const float* y, const float* z, int n, float* face_u_v);
    void (*cube)(const std::uint16_t* texels, int size, int levels, const float* x, const float* y, const float* z, const float* lod, int n,
                 float* rgb);
    void (*cube_level)(const std::uint16_t* texels, int size, int levels, int level, const float* x, const float* y, const float* z, int n,
                       float* rgb);
    // uv, d: u, v, du/dx, dv/dx, du/dy, dv/dy, n of each, one array after the other; exact_bound: the loop
    // ends at the largest tap count
    void (*texture)(const TextureView& texture, const float* uv, int max_taps, bool exact_bound, int n, float* rgba);
    void (*footprint)(const TextureView& texture, const float* uv, int max_taps, int n, float* lod_taps);
    void (*dfg_lookup)(const std::uint16_t* table, int size, const float* n_dot_v, const float* roughness, int n, float* scale_bias);
    // lobes: sigma_u, sigma_v, and the direction to the eye in the lobe's frame, n of each, one array after the other
    void (*lobe_slice)(const std::uint16_t* slice, int size, const float* lobes, int n, float* scale_bias); // as lobe_albedo
    void (*lobe_albedo)(const std::uint16_t* table, int size, const float* lobes, int n, float* scale_bias);
    void (*dfg_fit)(const float* n_dot_v, const float* roughness, int n, float* scale_bias);
};

BN_DECLARE_FNS(FilterOps);

} // namespace burnish
