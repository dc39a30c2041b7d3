// Prefiltered samples along the lobe's reflected major axis (major_axis.k.h): equally spaced, or where the lobe is dense, as many as asked
// for or as each fragment needs.
#ifndef BN_MAJOR_AXIS_T_H
#define BN_MAJOR_AXIS_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/techniques/major_axis.k.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

BN_FN real major_axis_lod(real radius, cube_desc cube)
{
    return min(sqrt(radius), lit(1.0)) * to_real(int_lit(cube.levels - 1));
}

BN_FN real3 major_axis_specular(frame_ref f, BN_IN(shaded_point) x)
{
    cube_desc cube = specular_cube(f);
    int n = the_frame(f).samples;
    int last = n > 1 ? n - 1 : 1;
    real inv = lit(1.0) / to_real(int_lit(n));
    real3 o = eye_in_lobe(x);
    major_axis_line line =
        major_axis_setup(o, x.lobe.sigma_u, x.lobe.sigma_v, splat(the_frame(f).major_axis_k), splat(the_frame(f).major_axis_beta), inv);
    real3 along = line.e1 - line.e0;
    real3 e0 = from_lobe(x.lobe, x.s.n, line.e0);
    real3 step_ws = from_lobe(x.lobe, x.s.n, along);
    major_axis_curve curve = major_axis_curve_of(e0, step_ws, from_lobe(x.lobe, x.s.n, o)); // world space
    cube_sum sum;
    cube_sum_begin(sum, cube);
    cube_sum_levels levels = cube_sum_levels_at(sum, major_axis_lod(line.radius, cube), inv);
    for (int j = 0; j < n; ++j) {
        uniform_real s = n == 1 ? 0.5f : float(j) / float(last);
        cube_sum_add(sum, major_axis_direction(curve, splat(s)), levels);
    }
    return cube_sum_value(sum) * x.albedo;
}

// Samples of a lobe along its grain, and the sum of their weights.
struct grain_sum {
    cube_sum light;
    real weights;
};

BN_FN void add_grain_sample(BN_IN(shaded_point) x, BN_IN(major_axis_grain) grain, cube_desc cube, real c, real root, real spacing,
                            real narrow, real weight, BN_INOUT(grain_sum) sum)
{
    grain_sample g = major_axis_grain_sample(grain, c, root, spacing);
    real w = g.weight * weight;
    real radius = g.radius * narrow;
    cube_sum_levels levels = cube_sum_levels_at(sum.light, major_axis_lod(radius, cube), w);
    cube_sum_add(sum.light, from_lobe(x.lobe, x.s.n, g.direction), levels);
    sum.weights = sum.weights + w;
}

BN_FN real3 grain_mean(BN_IN(shaded_point) x, BN_INOUT(grain_sum) sum)
{
    return cube_sum_value(sum.light) / max(sum.weights, lit(1e-20)) * x.albedo;
}

BN_FN major_axis_grain grain_of(frame_ref f, BN_IN(shaded_point) x)
{
    return major_axis_grain_of(to_lobe(x.lobe, x.s.n, x.s.v), x.lobe.sigma_u, x.lobe.sigma_v, splat(the_frame(f).major_axis_k));
}

// Samples where the lobe is dense, each with a level of its own and the weight that masking and the visible area leave it. Levels are
// narrower than the samples' share by what gave the least HDR-FLIP on spheres under builtin:studio, a workshop and a photographer's studio.
BN_FN real3 major_axis_weighted_specular(frame_ref f, BN_IN(shaded_point) x)
{
    cube_desc cube = specular_cube(f);
    int n = the_frame(f).samples;
    major_axis_grain grain = grain_of(f, x);
    uniform_real step_c = 2.0f / float(n);
    uniform_real spacing = the_frame(f).major_axis_beta * 0.48f * step_c;
    grain_sum sum;
    sum.weights = lit(0.0);
    cube_sum_begin(sum.light, cube);
    for (int j = 0; j < n; ++j) {
        uniform_real c = (float(j) + 0.5f) * step_c - 1.0f;
        uniform_real rest = 1.0f - c * c;
        add_grain_sample(x, grain, cube, splat(c), sqrt(splat(rest)), splat(spacing), lit(0.65), lit(1.0), sum);
    }
    return grain_mean(x, sum);
}

// Density-placed too, but with no more samples than each fragment needs, in cells around the middle that come and go without a step. One
// sample lies in the middle and the others in pairs, so an even --samples is taken as one less: never more than asked for.
BN_FN real3 major_axis_adaptive_specular(frame_ref f, BN_IN(shaded_point) x)
{
    cube_desc cube = specular_cube(f);
    major_axis_grain grain = grain_of(f, x);
    real beta = splat(the_frame(f).major_axis_beta);
    real one = lit(1.0);
    int limit = the_frame(f).samples - (the_frame(f).samples % 2 == 0 ? 1 : 0); // one in the middle and pairs
    real k = splat(the_frame(f).major_axis_k);
    real count = major_axis_grain_count(grain, beta, to_real(int_lit(limit)));
    if (any_lane(both(count > one, major_axis_count_unsure(grain, k))))
        count = major_axis_limited_count(grain, x.lobe.sigma_u, x.lobe.sigma_v, k, beta, count);
    real spacing = beta * lit(2.0) / count;
    grain_sum sum;
    sum.weights = lit(0.0);
    cube_sum_begin(sum.light, cube);
    add_grain_sample(x, grain, cube, lit(0.0), one, spacing, one, one, sum);
    uniform_real most = most_of_lanes(count);
    for (int i = 1; float(2 * i - 1) < most; ++i) {
        grain_cell cell = major_axis_grain_cell(count, i);
        real rest = one - cell.c * cell.c;
        real root = sqrt(rest);
        add_grain_sample(x, grain, cube, cell.c, root, spacing, one, cell.weight, sum);
        add_grain_sample(x, grain, cube, -cell.c, root, spacing, one, cell.weight, sum);
    }
    return grain_mean(x, sum);
}

BN_KERNELS_END

#endif
