// The stage (stage.h) in lanes: the plain records of shading/lang as the kernels want them, broadcast or as the descriptions that the
// filter kernels take.
#pragma once
#include "core/simd/lanes.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/lang/cube_sum.h"
#include "shading/lang/frame.h"
#include "shading/lang/tables.h"
#include "shading/lang/texture_fetch.h"
#include "shading/surface/visible_point.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

BN_INLINE const LightRecord& the_light(frame_ref f, int i)
{
    return f.lights[i];
}

BN_INLINE const AreaLightRecord& the_area_light(frame_ref f, int i)
{
    return f.area_lights[i];
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

BN_INLINE texel_buffer ltc_texels(frame_ref f)
{
    return f.ltc_texels;
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

BN_INLINE constexpr bool area_way_used(int)
{
    return true;
}

// A fragment of which nothing changes but the geometry: neither textures, vertex colours, lights of either kind, energy compensation, exact
// reflectances, light that passes nor a lobe other than the usual one.
struct PlainFrame : ShadingFrame {
    static constexpr int light_count = 0, area_light_count = 0, key_light_count = 0, energy_compensation = 0, dfg_fit = 0, fresnel = 0;
    static constexpr int lobe = lobe_with(kLobeOfAll), lobe_traits = lobe_traits_of(lobe);
};
struct PlainMaterial : MaterialRecord {
    static constexpr int textured = 0, uses_color = 0, unlit = 0, refracts = 0;
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
