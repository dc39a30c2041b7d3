// Baked maps as the kernels want them: glue between the renderer's plain tables and the filter kernels.
#pragma once
#include "raster/tile/lanes_view.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/texture_filter.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

BN_INLINE cube_desc lanes_cube(const CubeParams& p) { return {p.texels, p.size, p.levels}; }

// uv and its change by one pixel, in texture space; the lanes with the longest footprint decide how often the loop runs.
BN_INLINE real4 sample_binding(const TextureBinding& b, real2 uv, real2 uv_dx, real2 uv_dy, int max_taps)
{
    const TextureParams& t = *b.texture;
    const texture_desc desc = {t.texels, t.offset, t.level_width, t.level_height, t.levels, t.wrap_s, t.wrap_t, t.nearest};
    const texture_footprint footprint = texture_footprint_of(desc, uv_dx, uv_dy, max_taps);
    float most[kLanes];
    store(most, reduce_max(footprint.taps));
    return texture_sample_footprint(desc, uv, footprint, static_cast<int>(most[0]));
}

} // namespace BN_ISA_NS
} // namespace burnish
