// The stage (stage.h) in lanes: the plain records of shading/lang as the kernels want them, broadcast or as the descriptions that the
// filter kernels take.
#pragma once
#include "core/simd/lanes.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/texture_filter.k.h"
#include "shading/kernels/vertex.k.h"
#include "shading/lang/cube_sum.h"
#include "shading/lang/tables.h"
#include "shading/surface/surface.k.h"

// A stage that several techniques share: compiled once, called once a batch.
#define BN_STAGE static __attribute__((noinline))

namespace burnish {
inline namespace BN_ISA_NS {

BN_FN real3 splat3(const float* v)
{
    return vec3_of(splat(v[0]), splat(v[1]), splat(v[2]));
}

BN_FN view_params lanes_view(const ViewRecord& v)
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

using frame_ref = const ShadingFrame&;
using material_ref = const MaterialRecord&;

BN_INLINE const FrameRecord& the_frame(frame_ref f)
{
    return f;
}
BN_INLINE const MaterialRecord& the_material(material_ref m)
{
    return m;
}
BN_INLINE const LightRecord& the_light(frame_ref f, int i)
{
    return f.lights[i];
}

BN_INLINE cube_desc specular_cube(frame_ref f)
{
    return {f.specular_texels, f.specular.size, f.specular.levels};
}
BN_INLINE cube_desc irradiance_cube(frame_ref f)
{
    return {f.irradiance_texels, f.irradiance.size, f.irradiance.levels};
}
BN_INLINE cube_desc box_cube(frame_ref f)
{
    return {f.box_texels, f.box.size, f.box.levels};
}

BN_INLINE texel_buffer dfg_texels(frame_ref f)
{
    return f.dfg_texels;
}
BN_INLINE texel_buffer lobe_albedo_texels(frame_ref f)
{
    return f.lobe_albedo_texels;
}
BN_INLINE texel_buffer lobe_slice_texels(frame_ref f)
{
    return f.lobe_slice_texels;
}

BN_INLINE real3 grid_sample(frame_ref f, int i)
{
    const GridSample& g = f.grid[i];
    return vec3_of(splat(g.slope_x), splat(g.slope_y), splat(g.density));
}

// uv and its change by one pixel, in texture space; the lanes with the longest footprint decide how often the loop runs.
BN_INLINE real4 sample_texture(const TextureParams& t, real2 uv, real2 uv_dx, real2 uv_dy, int max_taps)
{
    const texture_desc desc = {t.texels, t.offset, t.level_width, t.level_height, t.levels, t.wrap_s, t.wrap_t, t.nearest};
    const texture_footprint footprint = texture_footprint_of(desc, uv_dx, uv_dy, max_taps);
    float most[kLanes];
    store(most, reduce_max(footprint.taps));
    return texture_sample_footprint(desc, uv, footprint, static_cast<int>(most[0]));
}

BN_INLINE bool texture_used(material_ref m, int slot)
{
    return m.textures[slot].texture >= 0;
}

BN_INLINE real4 fetch_texture(frame_ref f, const TextureBinding& b, const visible_point& p)
{
    const int set = b.uv_set != 0;
    const real m0 = splat(b.transform[0]), m1 = splat(b.transform[1]), m2 = splat(b.transform[2]), m3 = splat(b.transform[3]);
    const real2 uv = p.uv[set], dx = p.uv_dx[set], dy = p.uv_dy[set];
    const real2 at = vec2_of(m0 * uv.x + m2 * uv.y + splat(b.transform[4]), m1 * uv.x + m3 * uv.y + splat(b.transform[5]));
    const real2 at_dx = vec2_of(m0 * dx.x + m2 * dx.y, m1 * dx.x + m3 * dx.y);
    const real2 at_dy = vec2_of(m0 * dy.x + m2 * dy.y, m1 * dy.x + m3 * dy.y);
    return sample_texture(f.textures[b.texture], at, at_dx, at_dy, f.texture_taps);
}

struct texture_fetches { // each when it is asked for
    frame_ref f;
    material_ref m;
    const visible_point& p;
};

BN_INLINE texture_fetches textures_at(frame_ref f, material_ref m, const visible_point& p)
{
    return {f, m, p};
}
BN_INLINE real4 texel_of(const texture_fetches& t, int slot)
{
    return fetch_texture(t.f, t.m.textures[slot], t.p);
}

} // namespace BN_ISA_NS
} // namespace burnish
