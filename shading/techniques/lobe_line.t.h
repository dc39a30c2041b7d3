// A line of isotropic lobes (lobe_line.k.h): prefiltered samples along the grain, as many as each fragment needs.
#ifndef BN_LOBE_LINE_T_H
#define BN_LOBE_LINE_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/techniques/lobe_line.k.h"
#include "shading/techniques/shared_samples.k.h"

BN_KERNELS_BEGIN

struct line_sum {
    cube_desc cube;
    cube_sum light;
    real weights;
};

// Adds the sample at t with its own level.
BN_FN void add_line_sample(BN_IN(shaded_point) x, BN_IN(lobe_line) line, real t, real weight, BN_INOUT(line_sum) sum)
{
    // Find the sample's direction and level
    lobe_line_sample at = lobe_line_at(line, t);
    real w = at.weight * weight;
    real lod = min(sqrt(at.radius), lit(1.0)) * to_real(int_lit(sum.cube.levels - 1));
    cube_sum_levels levels = cube_sum_levels_at(sum.light, lod, w);
    // Add the weighted fetch
    cube_sum_add(sum.light, from_lobe(x.lobe, x.s.n, at.direction), levels);
    sum.weights = sum.weights + w;
}

// Returns the line of a point's lobe, shortened where the lobe blends to a round one.
BN_FN lobe_line lobe_line_for(frame_ref f, BN_IN(shaded_point) x)
{
    real part = lit(1.0);
    if (the_frame(f).blends_to_isotropic != 0)
        part = x.anisotropy_blend;
    return lobe_line_of(to_lobe(x.lobe, x.s.n, x.s.v), x.lobe.sigma_u, x.lobe.sigma_v, part);
}

// Returns the mean radiance over the lobe; multiply by its albedo. offset: place of samples in their cells, (0,1). alike:
// similarity of the pixels around, [0,1]. A fragment whose neighbours are unlike it takes more samples, in the middle of
// their cells.
BN_FN real3 lobe_line_radiance(frame_ref f, BN_IN(shaded_point) x, BN_IN(lobe_line) line, real offset, real alike)
{
    // Find the number of samples
    real one = lit(1.0);
    int limit = the_frame(f).samples - (the_frame(f).samples % 2 == 0 ? 1 : 0); // one in the middle, and pairs
    real per_width = lit(kLineSamplesAlone) + lit(kLineSamplesShared - kLineSamplesAlone) * alike;
    real all = to_real(int_lit(limit));
    real some = all + (lobe_line_limit(line, all) - all) * alike;
    real count = lobe_line_count(line, per_width, max(some, min(all, lit(3.0))));
    offset = lit(0.5) + (offset - lit(0.5)) * alike;
    // Take the middle sample
    line_sum sum;
    sum.cube = prefiltered_env(f);
    sum.weights = lit(0.0);
    cube_sum_begin(sum.light, sum.cube);
    real middle = (offset - lit(0.5)) * lit(2.0) / count;
    add_line_sample(x, line, middle, one, sum);
    // Take pairs of samples outwards
    uniform_real most = most_of_lanes(count);
    for (int i = 1; float(2 * i - 1) < most; ++i) {
        lobe_line_cell cell = lobe_line_cell_of(count, i);
        real right = cell.begin + cell.size * offset;
        real left = cell.begin + cell.size * (one - offset);
        add_line_sample(x, line, right, cell.weight, sum);
        add_line_sample(x, line, -left, cell.weight, sum);
    }
    return cube_sum_value(sum.light) / max(sum.weights, lit(1e-20));
}

// Returns v mirrored at n, which need not be unit.
BN_FN real3 mirrored_at(real3 n, real3 v)
{
    return n * (lit(2.0) * k_dot3(n, v) / max(k_dot3(n, n), lit(1e-20))) - v;
}

// Estimates the similarity of the pixel beside, [0,1], from the change of the surface's normal. r: the fragment's own
// record without light.
BN_FN real similarity_beside(BN_IN(shaded_point) x, BN_IN(shared_sample_record) r, real3 normal_step)
{
    shared_sample_record beside = r;
    beside.mirror = mirrored_at(x.s.n + normal_step, x.s.v);
    real alike = record_similarity(r, beside);
    return select(alike >= lit(0.0), alike, lit(0.0)); // NaN where the pixel beside lies behind the eye
}

// Returns the shared record except `factor`.
BN_FN shared_sample_record lobe_line_shared(frame_ref f, BN_IN(shaded_point) x, real offset)
{
    lobe_line line = lobe_line_for(f, x);
    shared_sample_record r = unshared_record(vec3_all(lit(0.0)));
    r.width = line.width * line.part; // round lobes share nothing
    r.mirror = mirrored_at(x.s.n, x.s.v);
    r.along = x.lobe.u_axis * line.along.x + x.lobe.v_axis * line.along.y;
    real alike = (similarity_beside(x, r, x.normal_dx) + similarity_beside(x, r, x.normal_dy)) * lit(0.5);
    r.light = lobe_line_radiance(f, x, line, offset, alike);
    return r;
}

// Samples alone, for fragments that cannot read their neighbours.
BN_FN real3 lobe_line_specular(frame_ref f, BN_IN(shaded_point) x)
{
    return lobe_line_radiance(f, x, lobe_line_for(f, x), lit(0.5), lit(0.0)) * x.energy.albedo;
}

BN_KERNELS_END

#endif
