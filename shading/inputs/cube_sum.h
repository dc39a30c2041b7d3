// Sums of cube-map fetches in batches: first compute some fetch addresses, then load them. One fetch is a chain (direction,
// face, address, memory, load) longer than the processor's look-ahead. Split in two, both halves run full. The bits equal
// one fetch after the other.
#pragma once
#include "core/simd/lanes.h"
#include "shading/kernels/cube_filter.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

// A sum of weighted trilinear fetches, as by cube_texel_add().
struct cube_sum {
    static constexpr int kPlans = 16; // more do not help, and would crowd the first-level cache

    const cube_desc* cube;
    texel_acc acc;
    int count; // plans not loaded yet
    texel_plan plans[kPlans];
};

BN_INLINE void cube_sum_begin(cube_sum& s, const cube_desc& cube)
{
    s.cube = &cube;
    s.acc = texel_zero();
    s.count = 0;
}

void cube_sum_begin(cube_sum& s, const cube_desc&& cube) = delete; // the cube must outlive the sum

// Loads and adds all planned fetches.
BN_INLINE void load_planned(cube_sum& s)
{
    texel_acc acc = s.acc;
    for (int i = 0; i < s.count; ++i)
        acc = texel_add(acc, s.cube->texels, s.plans[i]);
    s.acc = acc;
    s.count = 0;
}

BN_INLINE void plan(texel_plan& p, const texel_rows& r)
{
    plan_texels(p, r.row0, r.row1, r.w00, r.w10, r.w01, r.w11);
}

using cube_sum_levels = cube_levels;

// Returns levels and weight as for cube_texel_add(), for samples to share. A cube with one level keeps the weight alone.
BN_INLINE cube_sum_levels cube_sum_levels_at(const cube_sum& s, real lod, real weight)
{
    if (s.cube->levels > 1)
        return cube_levels_at(*s.cube, lod, weight);
    cube_levels only;
    only.fine = weight;
    return only;
}

BN_INLINE void cube_sum_add(cube_sum& s, real3 direction, const cube_sum_levels& levels)
{
    const cube_place place = cube_face_uv(direction);
    int count = s.count; // a local copy: plans are written to memory
    if (s.cube->levels > 1) {
        plan(s.plans[count++], cube_fine_rows(place, levels));
        plan(s.plans[count++], cube_coarse_rows(place, levels));
    } else {
        plan(s.plans[count++], cube_level_rows(*s.cube, place, 0, levels.fine));
    }
    s.count = count;
    if (count + 2 > cube_sum::kPlans)
        load_planned(s);
}

BN_INLINE real3 cube_sum_value(cube_sum& s)
{
    load_planned(s);
    const real4 v = texel_value(s.acc);
    return vec3_of(v.x, v.y, v.z);
}

// A sum of fetches, each multiplied by a colour and then by a weight.
struct cube_terms {
    static constexpr int kTerms = 8;

    const cube_desc* cube;
    real3 sum;
    int count;      // terms not loaded yet
    bool trilinear; // two levels per term
    texel_plan plans[kTerms][2];
    struct {
        real3 colour;
        real weight;
    } factors[kTerms];
};

// Starts a sum. Without `trilinear`, cube_terms_add() reads level 0.
BN_INLINE void cube_terms_begin(cube_terms& s, const cube_desc& cube, bool trilinear)
{
    s.cube = &cube;
    s.sum = vec3_all(lit(0.0));
    s.count = 0;
    s.trilinear = trilinear && cube.levels > 1;
}

void cube_terms_begin(cube_terms& s, const cube_desc&& cube, bool trilinear) = delete;

// Loads and adds all planned terms.
BN_INLINE void load_planned(cube_terms& s)
{
    real3 sum = s.sum;
    for (int i = 0; i < s.count; ++i) {
        texel_acc acc = texel_add(texel_zero(), s.cube->texels, s.plans[i][0]);
        if (s.trilinear)
            acc = texel_add(acc, s.cube->texels, s.plans[i][1]);
        const real4 v = texel_value(acc);
        sum = sum + vec3_of(v.x, v.y, v.z) * s.factors[i].colour * s.factors[i].weight;
    }
    s.sum = sum;
    s.count = 0;
}

// Plans one fetch. lod: for trilinear sums only.
BN_INLINE void cube_terms_add(cube_terms& s, real3 direction, real lod, real3 colour, real weight)
{
    const cube_place place = cube_face_uv(direction);
    const int at = s.count;
    texel_plan* const p = s.plans[at];
    if (s.trilinear) {
        const cube_levels levels = cube_levels_at(*s.cube, lod, lit(1.0));
        plan(p[0], cube_fine_rows(place, levels));
        plan(p[1], cube_coarse_rows(place, levels));
    } else {
        plan(p[0], cube_level_rows(*s.cube, place, 0, lit(1.0)));
    }
    s.factors[at].colour = colour;
    s.factors[at].weight = weight;
    s.count = at + 1;
    if (s.count == cube_terms::kTerms)
        load_planned(s);
}

// Plans a bilinear fetch from an integer level in [0, levels - 1], for a sum without `trilinear`. cube: the sum's own,
// passed by value so that a loop reads it once.
BN_INLINE void cube_terms_add_level(cube_terms& s, cube_desc cube, real3 direction, integer level, real3 colour, real weight)
{
    const int at = s.count;
    plan(s.plans[at][0], cube_own_level_rows(cube, cube_face_uv(direction), level, lit(1.0)));
    s.factors[at].colour = colour;
    s.factors[at].weight = weight;
    s.count = at + 1;
    if (s.count == cube_terms::kTerms)
        load_planned(s);
}

BN_INLINE real3 cube_terms_value(cube_terms& s)
{
    load_planned(s);
    return s.sum;
}

} // namespace BN_ISA_NS
} // namespace burnish
