// Vertices to the sub-pixel grid of a frame.
#pragma once
#include "raster/tile/tile_types.h"
#include "shading/lang/stage_cxx.h"

namespace burnish {
inline namespace BN_ISA_NS {

BN_FN snapped_vertex snap_lanes(const FrameParams& f, const view_params& view, const real4& clip, int guard)
{
    return snap_vertex(clip, view, splat(f.half_width), splat(f.half_height), splat(static_cast<float>(f.center_x)),
                       splat(static_cast<float>(f.center_y)), int_lit(f.center_x), int_lit(f.center_y), splat(static_cast<float>(guard)));
}

} // namespace BN_ISA_NS
} // namespace burnish
