// Prefiltered samples along the lobe's reflected major axis (major_axis.k.h): equally spaced, or placed by the lobe's
// density, either in a fixed number or as many as each fragment needs.
#ifndef BN_MAJOR_AXIS_T_H
#define BN_MAJOR_AXIS_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/techniques/major_axis.k.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

// Returns the mip level for a lobe of width alpha = radius.
BN_FN real major_axis_lod(real radius, cube_desc cube)
{
    return min(sqrt(radius), lit(1.0)) * to_real(int_lit(cube.levels - 1));
}

// Takes equally spaced samples (Cocco et al. 2024).
BN_FN real3 major_axis_specular(frame_ref f, BN_IN(shaded_point) x)
{
    // Set up the line in the lobe's frame
    cube_desc cube = prefiltered_env(f);
    int n = x.samples;
    int last = n > 1 ? n - 1 : 1;
    real inv = lit(1.0) / to_real(int_lit(n));
    real3 o = eye_in_lobe(x);
    major_axis_line line =
        major_axis_setup(o, x.lobe.sigma_u, x.lobe.sigma_v, splat(the_frame(f).major_axis_k), splat(the_frame(f).major_axis_beta), inv);
    // Transform the line to world space
    real3 along = line.e1 - line.e0;
    real3 e0 = from_lobe(x.lobe, x.s.n, line.e0);
    real3 step_ws = from_lobe(x.lobe, x.s.n, along);
    major_axis_curve curve = major_axis_curve_of(e0, step_ws, from_lobe(x.lobe, x.s.n, o)); // world space
    // Sum the samples at one level
    cube_sum sum;
    cube_sum_begin(sum, cube);
    cube_sum_levels levels = cube_sum_levels_at(sum, major_axis_lod(line.radius, cube), inv);
    for (int j = 0; j < n; ++j) {
        uniform_real s = n == 1 ? 0.5f : float(j) / float(last);
        cube_sum_add(sum, major_axis_direction(curve, splat(s)), levels);
    }
    return cube_sum_value(sum) * x.energy.albedo;
}

// Samples of a lobe along its grain, and the sum of their weights.
struct grain_sum {
    cube_sum light;
    real weights;
};

// Adds a sample at place c of the line, with its own level.
BN_FN void add_grain_sample(BN_IN(shaded_point) x, BN_IN(major_axis_grain) grain, cube_desc cube, real c, real root, real spacing,
                            real narrow, real weight, BN_INOUT(grain_sum) sum)
{
    // Find the sample, its weight and its level
    grain_sample g = major_axis_grain_sample(grain, c, root, spacing);
    real w = g.weight * weight;
    real radius = g.radius * narrow;
    cube_sum_levels levels = cube_sum_levels_at(sum.light, major_axis_lod(radius, cube), w);
    // Add the weighted fetch
    cube_sum_add(sum.light, from_lobe(x.lobe, x.s.n, g.direction), levels);
    sum.weights = sum.weights + w;
}

BN_FN real3 grain_mean(BN_IN(shaded_point) x, BN_INOUT(grain_sum) sum)
{
    return cube_sum_value(sum.light) / max(sum.weights, lit(1e-20)) * x.energy.albedo;
}

// Returns the lobe along its major axis.
BN_FN major_axis_grain grain_of(frame_ref f, BN_IN(shaded_point) x)
{
    return major_axis_grain_of(to_lobe(x.lobe, x.s.n, x.s.v), x.lobe.sigma_u, x.lobe.sigma_v, splat(the_frame(f).major_axis_k));
}

// Places samples where the lobe is dense. Each has its own level, and a weight by masking and visible area. Levels are
// narrower than the samples' spacing; the factor minimises HDR-FLIP errors, see the notebook.
BN_FN real3 major_axis_weighted_specular(frame_ref f, BN_IN(shaded_point) x)
{
    cube_desc cube = prefiltered_env(f);
    int n = x.samples;
    // Set up the lobe and the spacing
    major_axis_grain grain = grain_of(f, x);
    uniform_real step_c = 2.0f / float(n);
    uniform_real spacing = the_frame(f).major_axis_beta * 0.48f * step_c;
    // Sum the samples at uniform steps of c
    grain_sum sum;
    sum.weights = lit(0.0);
    cube_sum_begin(sum.light, cube);
    for (int j = 0; j < n; ++j) {
        // Place the sample uniformly in c
        uniform_real c = (float(j) + 0.5f) * step_c - 1.0f;
        uniform_real rest = 1.0f - c * c;
        add_grain_sample(x, grain, cube, splat(c), sqrt(splat(rest)), splat(spacing), lit(0.65), lit(1.0), sum);
    }
    return grain_mean(x, sum);
}

// Places samples by density, too, but only as many as each fragment needs, in cells around the middle that appear and
// vanish without a step. One sample lies in the middle and the others in pairs. So an even sample count is one less.
BN_FN real3 major_axis_adaptive_specular(frame_ref f, BN_IN(shaded_point) x)
{
    cube_desc cube = prefiltered_env(f);
    // Set up the lobe
    major_axis_grain grain = grain_of(f, x);
    real beta = splat(the_frame(f).major_axis_beta);
    real one = lit(1.0);
    int limit = x.samples - (x.samples % 2 == 0 ? 1 : 0); // one in the middle, and pairs
    // Find the number of samples
    real k = splat(the_frame(f).major_axis_k);
    real count = major_axis_grain_count(grain, beta, to_real(int_lit(limit)));
    if (any_lane(both(count > one, major_axis_count_unsure(grain, k))))
        count = major_axis_limited_count(grain, x.lobe.sigma_u, x.lobe.sigma_v, k, beta, count);
    // Take the middle sample
    real spacing = beta * lit(2.0) / count;
    grain_sum sum;
    sum.weights = lit(0.0);
    cube_sum_begin(sum.light, cube);
    add_grain_sample(x, grain, cube, lit(0.0), one, spacing, one, one, sum);
    // Take pairs of samples outwards
    uniform_real most = most_of_lanes(count);
    for (int i = 1; float(2 * i - 1) < most; ++i) {
        // Add the cell's samples on both sides
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
