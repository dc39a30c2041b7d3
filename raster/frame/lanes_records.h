// The plain records of records.h as the kernels want them: broadcast to lanes, or as the descriptions that the filter kernels take.
#pragma once
#include "core/simd/lanes.h"
#include "raster/frame/records.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/texture_filter.k.h"
#include "shading/kernels/vertex.k.h"

// A stage that several techniques share: compiled once, called once a batch.
#define BN_STAGE static __attribute__((noinline))

namespace burnish {
inline namespace BN_ISA_NS {

BN_FN real3 splat3(const float* v) { return vec3_of(splat(v[0]), splat(v[1]), splat(v[2])); }

BN_FN view_params lanes_view(const ViewParams& v)
{
    view_params r;
    r.eye = splat3(v.eye);
    r.right = splat3(v.right);
    r.up = splat3(v.up);
    r.forward = splat3(v.forward);
    r.inv_tan_x = splat(v.inv_tan_x);
    r.inv_tan_y = splat(v.inv_tan_y);
    r.znear = splat(v.znear);
    r.zfar = splat(v.zfar);
    r.inv_depth = splat(v.inv_depth);
    r.orthographic = int_lit(v.orthographic) != int_lit(0);
    return r;
}

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
