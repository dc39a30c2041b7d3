// Weighted sums of trilinear fetches from a cube map, many at a time: first the addresses of some fetches, then their loads. One fetch after the
// other is a chain (direction, face, address, memory, loads) that is longer than what the processor looks ahead: apart, both halves run full.
// The bits are those of cube_texel_add(), fetch by fetch.
#pragma once
#include "raster/frame/lanes_records.h"
#include "shading/kernels/cube_filter.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct CubeSum {
    static constexpr int kPlans = 16; // more gain nothing, and would crowd the first-level cache

    const cube_desc& cube;
    texel_acc acc;
    int count;                // plans not loaded yet
    texel_plan plans[kPlans];
};

BN_INLINE void begin(CubeSum& s)
{
    s.acc = texel_zero();
    s.count = 0;
}

BN_INLINE void load_planned(CubeSum& s)
{
    texel_acc acc = s.acc;
    for (int i = 0; i < s.count; ++i)
        acc = texel_add(acc, s.cube.texels, s.plans[i]);
    s.acc = acc;
    s.count = 0;
}

BN_INLINE void plan(CubeSum& s, const texel_rows& r) { plan_texels(s.plans[s.count++], r.row0, r.row1, r.w00, r.w10, r.w01, r.w11); }

// Levels and weight as for cube_texel_add(), found once where samples share them. A cube of one level knows the weight alone.
BN_INLINE cube_levels levels_at(const CubeSum& s, real lod, real weight)
{
    if (s.cube.levels > 1)
        return cube_levels_at(s.cube, lod, weight);
    cube_levels only;
    only.fine = weight;
    return only;
}

BN_INLINE void add_sample(CubeSum& s, real3 direction, const cube_levels& levels)
{
    const cube_place place = cube_face_uv(direction);
    if (s.cube.levels > 1) {
        plan(s, cube_fine_rows(place, levels));
        plan(s, cube_coarse_rows(place, levels));
    } else {
        plan(s, cube_level_rows(s.cube, place, 0, levels.fine));
    }
    if (s.count + 2 > CubeSum::kPlans)
        load_planned(s);
}

BN_INLINE real3 sum_of(CubeSum& s)
{
    load_planned(s);
    const real4 v = texel_value(s.acc);
    return vec3_of(v.x, v.y, v.z);
}

} // namespace BN_ISA_NS
} // namespace burnish
