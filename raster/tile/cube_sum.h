// Sums of fetches from a cube map, many at a time: first the addresses of some fetches, then their loads. One fetch after the other is a chain
// (direction, face, address, memory, loads) that is longer than what the processor looks ahead: apart, both halves run full. The bits are those
// of one fetch after the other.
#pragma once
#include "raster/frame/lanes_records.h"
#include "shading/kernels/cube_filter.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

// A sum of weighted trilinear fetches, as by cube_texel_add().
struct CubeSum {
    static constexpr int kPlans = 16; // more gain nothing, and would crowd the first-level cache

    const cube_desc* cube;
    texel_acc acc;
    int count;                // plans not loaded yet
    texel_plan plans[kPlans];
};

BN_INLINE void begin(CubeSum& s, const cube_desc& cube)
{
    s.cube = &cube;
    s.acc = texel_zero();
    s.count = 0;
}

BN_INLINE void load_planned(CubeSum& s)
{
    texel_acc acc = s.acc;
    for (int i = 0; i < s.count; ++i)
        acc = texel_add(acc, s.cube->texels, s.plans[i]);
    s.acc = acc;
    s.count = 0;
}

BN_INLINE void plan(texel_plan& p, const texel_rows& r) { plan_texels(p, r.row0, r.row1, r.w00, r.w10, r.w01, r.w11); }

// Levels and weight as for cube_texel_add(), found once where samples share them. A cube of one level knows the weight alone.
BN_INLINE cube_levels levels_at(const CubeSum& s, real lod, real weight)
{
    if (s.cube->levels > 1)
        return cube_levels_at(*s.cube, lod, weight);
    cube_levels only;
    only.fine = weight;
    return only;
}

BN_INLINE void add_sample(CubeSum& s, real3 direction, const cube_levels& levels)
{
    const cube_place place = cube_face_uv(direction);
    if (s.cube->levels > 1) {
        plan(s.plans[s.count++], cube_fine_rows(place, levels));
        plan(s.plans[s.count++], cube_coarse_rows(place, levels));
    } else {
        plan(s.plans[s.count++], cube_level_rows(*s.cube, place, 0, levels.fine));
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

// A sum of fetches that are each multiplied by a colour and then by a weight.
struct CubeTerms {
    static constexpr int kTerms = 8;

    const cube_desc* cube;
    real3 sum;
    int count;                    // terms not loaded yet
    int plans_a_term;             // levels that a fetch takes: 1 or 2
    texel_plan plans[2 * kTerms];
    real3 colour[kTerms];
    real weight[kTerms];
};

// trilinear: else all fetches are of level 0.
BN_INLINE void begin(CubeTerms& s, const cube_desc& cube, bool trilinear)
{
    s.cube = &cube;
    s.sum = vec3_all(lit(0.0));
    s.count = 0;
    s.plans_a_term = trilinear && cube.levels > 1 ? 2 : 1;
}

BN_INLINE void load_planned(CubeTerms& s)
{
    real3 sum = s.sum;
    const texel_plan* p = s.plans;
    for (int i = 0; i < s.count; ++i) {
        texel_acc acc = texel_add(texel_zero(), s.cube->texels, *p++);
        if (s.plans_a_term == 2)
            acc = texel_add(acc, s.cube->texels, *p++);
        const real4 v = texel_value(acc);
        sum = sum + vec3_of(v.x, v.y, v.z) * s.colour[i] * s.weight[i];
    }
    s.sum = sum;
    s.count = 0;
}

// lod: of trilinear fetches.
BN_INLINE void add_term(CubeTerms& s, real3 direction, real lod, real3 colour, real weight)
{
    const cube_place place = cube_face_uv(direction);
    texel_plan* p = s.plans + s.count * s.plans_a_term;
    if (s.plans_a_term == 2) {
        const cube_levels levels = cube_levels_at(*s.cube, lod, lit(1.0));
        plan(p[0], cube_fine_rows(place, levels));
        plan(p[1], cube_coarse_rows(place, levels));
    } else {
        plan(p[0], cube_level_rows(*s.cube, place, 0, lit(1.0)));
    }
    s.colour[s.count] = colour;
    s.weight[s.count] = weight;
    if (++s.count == CubeTerms::kTerms)
        load_planned(s);
}

BN_INLINE real3 sum_of(CubeTerms& s)
{
    load_planned(s);
    return s.sum;
}

} // namespace BN_ISA_NS
} // namespace burnish
