// The stage (stage.h) in lanes: the plain records of shading/lang as the kernels want them, broadcast or as the descriptions that the
// filter kernels take.
#pragma once
#include "core/simd/lanes.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/vertex.k.h"
#include "shading/lang/cube_sum.h"
#include "shading/lang/tables.h"
#include "shading/lang/texture_fetch.h"
#include "shading/surface/surface.k.h"

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

// Whatever has the members of a ShadingFrame, a MaterialRecord: a type derived of it may give some of them values that the compiler knows.
#define frame_ref const auto&
#define material_ref const auto&

BN_INLINE const auto& the_frame(frame_ref f)
{
    return f;
}
BN_INLINE const auto& the_material(material_ref m)
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
BN_INLINE cube_desc whole_cube(frame_ref f)
{
    return {f.whole_texels, f.whole.size, f.whole.levels};
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

BN_INLINE constexpr bool lobe_used(int)
{
    return true;
}

// A fragment of which nothing changes but the geometry: neither textures, vertex colours, lights of either kind, energy compensation nor a
// lobe other than the usual one.
struct PlainFrame : ShadingFrame {
    static constexpr int light_count = 0, key_light_count = 0, energy_compensation = 0, dfg_fit = 0;
    static constexpr int lobe = lobe_with(kLobeOfAll), lobe_traits = lobe_traits_of(lobe);
};
struct PlainMaterial : MaterialRecord {
    static constexpr int textured = 0, uses_color = 0, unlit = 0;
};
struct RoundMaterial : PlainMaterial {
    static constexpr int anisotropic = 0;
};

BN_INLINE bool texture_used(const MaterialRecord& m, int slot)
{
    return m.textures[slot].texture >= 0;
}
BN_INLINE constexpr bool texture_used(const PlainMaterial&, int)
{
    return false;
}

BN_INLINE texture_fetches textures_at(frame_ref f, material_ref m, const visible_point& p)
{
    return {f, m, p};
}

} // namespace BN_ISA_NS
} // namespace burnish
