// FrameParams' view, broadcast to lanes; glue between the renderer's plain tables and the kernels.
#pragma once
#include "core/simd/lanes.h"
#include "raster/tile/tile_types.h"
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

BN_FN snapped_vertex snap_lanes(const FrameParams& f, const view_params& view, const real4& clip, int guard)
{
    return snap_vertex(clip, view, splat(f.half_width), splat(f.half_height), splat(static_cast<float>(f.center_x)),
                       splat(static_cast<float>(f.center_y)), int_lit(f.center_x), int_lit(f.center_y),
                       splat(static_cast<float>(guard)));
}

} // namespace BN_ISA_NS
} // namespace burnish
