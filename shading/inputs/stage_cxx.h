// The stage (stage.h) in lanes. Converts the plain records of shading/lang to kernel arguments: broadcast values, and
// descriptions for the filter kernels.
#pragma once
#include "core/simd/lanes.h"
#include "shading/inputs/cube_sum.h"
#include "shading/inputs/texture_fetch.h"
#include "shading/kernels/camera.t.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/visible_point.k.h"
#include "shading/lang/frame.h"
#include "shading/lang/tables.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Looks up the place for a piece of a pixel block, the common case, which saves four divisions. Computes other places.
BN_INLINE real2 place_of_center(frame_ref f, const view_params& view, integer px, integer py)
{
    if constexpr (kLanes > 1) {
        constexpr int kRow = 8; // pixels side by side in a block
        std::int32_t column[kLanes], row[kLanes];
        store_int(column, px), store_int(row, py);
        const integer across = iota() & int_lit(kRow - 1), down = shr(iota(), 3);
        if (all(both(px == int_lit(column[0]) + across, py == int_lit(row[0]) + down)))
            return vec2_of(kLanes > kRow ? table_value(f.screen_x + column[0], across) : load(f.screen_x + column[0]),
                           kLanes > kRow ? table_value(f.screen_y + row[0], down) : splat(f.screen_y[row[0]]));
    }
    const integer x = px + int_lit(f.left), y = py + int_lit(f.top);
    return place_on_screen(f, view, to_real(x) + lit(0.5), to_real(y) + lit(0.5));
}

BN_INLINE const LightRecord& the_light(frame_ref f, int i)
{
    return f.lights[i];
}

// The frame's lights that may reach some of kLanes places: lights nearer to the places' bounding box than their range. A
// light's distance to the box never exceeds its distance to a place, with the same roundings. So no light that shines is
// left out.
struct light_reach {
    real3 least, most;  // the bounding box
    std::uint32_t bits; // lights that may reach, among the kLanes from `first` on
    int first;
};

// Returns the bits of the kLanes lights at r.first whose range reaches the box.
BN_INLINE std::uint32_t lights_near(frame_ref f, const light_reach& r)
{
    const float* const columns = f.light_columns + r.first;
    const int stride = f.light_stride;
    const real3 position = vec3_of(load(columns), load(columns + stride), load(columns + 2 * stride));
    const real3 d = max(max(r.least - position, position - r.most), vec3_all(lit(0.0)));
    const real d2 = max(k_dot3(d, d), lit(1e-12));
    const int left = f.light_count - r.first;
    return to_bits(both(iota() < int_lit(left), not_(d2 * load(columns + 3 * stride) >= lit(1.0))));
}
BN_INLINE light_reach lights_reaching(frame_ref f, const real3& p)
{
    light_reach r;
    r.least = vec3_of(reduce_min(p.x), reduce_min(p.y), reduce_min(p.z));
    r.most = vec3_of(reduce_max(p.x), reduce_max(p.y), reduce_max(p.z));
    if (!all(k_dot3(p, p) < lit(1e30))) { // some place is not finite: test each light by itself
        r.least = vec3_all(lit(-1e30));
        r.most = vec3_all(lit(1e30));
    }
    r.first = 0;
    r.bits = lights_near(f, r);
    return r;
}
// Returns the next light's index; light_count or more after the last. Gives each light once.
BN_INLINE int next_light(frame_ref f, light_reach& r)
{
    while (!r.bits && r.first + kLanes < f.light_count) {
        r.first += kLanes;
        r.bits = lights_near(f, r);
    }
    if (!r.bits)
        return f.light_count;
    const int i = r.first + __builtin_ctz(r.bits);
    r.bits &= r.bits - 1;
    return i;
}

BN_INLINE const AreaLightRecord& the_area_light(frame_ref f, int i)
{
    return f.area_lights[i];
}

BN_INLINE cube_desc prefiltered_env(frame_ref f)
{
    return {f.specular_texels, f.specular.size, f.specular.levels};
}
BN_INLINE cube_desc full_env(frame_ref f)
{
    return {f.whole_texels, f.whole.size, f.whole.levels};
}
BN_INLINE cube_desc irradiance_cube(frame_ref f)
{
    return {f.irradiance_texels, f.irradiance.size, f.irradiance.levels};
}
BN_INLINE cube_desc mip_env(frame_ref f)
{
    return {f.box_texels, f.box.size, f.box.levels};
}

BN_INLINE pair_table dfg_pairs(frame_ref f)
{
    return f.dfg_pairs;
}
BN_INLINE pair_table lobe_albedo_pairs(frame_ref f)
{
    return f.lobe_albedo_pairs;
}
BN_INLINE pair_table lobe_slice_pairs(frame_ref f)
{
    return f.lobe_slice_pairs;
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

BN_INLINE real4 grid_of_four(frame_ref f, int first, integer set)
{
    const float* const four = &f.grid[first].slope_x;
    return vec4_of(table_value(four, set), table_value(four, set + int_lit(4)), table_value(four, set + int_lit(8)),
                   table_value(four, set + int_lit(12)));
}

BN_INLINE constexpr bool transmission_used()
{
    return true;
}
BN_INLINE constexpr bool lobe_used(int)
{
    return true;
}

BN_INLINE constexpr bool area_way_used(int)
{
    return true;
}

BN_INLINE constexpr bool quads_apart()
{
    return true;
}

BN_INLINE constexpr bool film_used()
{
    return true;
}

BN_INLINE constexpr bool coating_used(int)
{
    return true;
}

// Constants of records: lists of a member and its value. Only geometry and vertex colours vary with such records: they have no
// textures and no lights but the environment, and the default lobe in its plainest form.
#define BN_PLAIN_FRAME(constant)                                                                                                           \
    constant(light_count, 0);                                                                                                              \
    constant(area_light_count, 0);                                                                                                         \
    constant(extracted_light_count, 0);                                                                                                    \
    constant(energy_compensation, 0);                                                                                                      \
    constant(dfg_fit, 0);                                                                                                                  \
    constant(fresnel, 0);                                                                                                                  \
    constant(diffuse_model, 0);                                                                                                            \
    constant(specular_aa, 0);                                                                                                              \
    constant(lobe, lobe_with(kDefaultLobe));                                                                                               \
    constant(lobe_traits, lobe_traits_of(lobe));
#define BN_PLAIN_MATERIAL(constant)                                                                                                        \
    constant(textured, 0);                                                                                                                 \
    constant(unlit, 0);                                                                                                                    \
    constant(refracts, 0);                                                                                                                 \
    constant(film, 0);                                                                                                                     \
    constant(coatings, 0);                                                                                                                 \
    constant(parallax, 0);
#define BN_UNTABLED_MATERIAL(constant) /* for techniques that do not sample an Ashikhmin-Shirley lobe */                                   \
    BN_PLAIN_MATERIAL(constant)                                                                                                            \
    constant(phong_slice, -1);                                                                                                             \
    constant(phong_set, -1);
#define BN_ROUND_MATERIAL(constant)                                                                                                        \
    BN_UNTABLED_MATERIAL(constant)                                                                                                         \
    constant(anisotropic, 0);

#define BN_CONSTANT(member, value) static constexpr int member = value
#define BN_CONDITION(member, value)                                                                                                        \
    if (record.member != member)                                                                                                           \
    return false
// Defines a copy of a record with a list's members as constants. fits() returns true for records with these values. Both come
// from one list, so that no constant lacks its condition.
#define BN_RECORD_WITH(constants, Name, Base, Record)                                                                                      \
    struct Name : Base {                                                                                                                   \
        constants(BN_CONSTANT) static bool fits(const Record& record) { constants(BN_CONDITION) return true; }                             \
    }
BN_RECORD_WITH(BN_PLAIN_FRAME, PlainFrame, ShadingFrame, ShadingFrame);
BN_RECORD_WITH(BN_PLAIN_MATERIAL, PlainMaterial, MaterialRecord, MaterialRecord);
BN_RECORD_WITH(BN_UNTABLED_MATERIAL, UntabledMaterial, PlainMaterial, MaterialRecord);
BN_RECORD_WITH(BN_ROUND_MATERIAL, RoundMaterial, UntabledMaterial, MaterialRecord);
#undef BN_RECORD_WITH
#undef BN_CONDITION
#undef BN_CONSTANT

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

BN_STAGE real4 texel_beside(const ShadingFrame& f, const MaterialRecord& m, int slot, const visible_point& p)
{
    const texture_fetches t(f, m, p);
    return texel_of(t, slot);
}

} // namespace BN_ISA_NS
} // namespace burnish
