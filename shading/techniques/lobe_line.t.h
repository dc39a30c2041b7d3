// A line of isotropic lobes (lobe_line.k.h): prefiltered samples along the grain, as many as each fragment needs.
#ifndef BN_LOBE_LINE_T_H
#define BN_LOBE_LINE_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/techniques/lobe_line.k.h"
#include "shading/techniques/shared_samples.k.h"

BN_KERNELS_BEGIN

struct line_sum {
    cube_desc cube;
    cube_terms light;
    real3 rise;    // of reflectance, from normal to grazing incidence
    real3 weights; // by channel
};

// Adds the sample at t with its own level, weighted by Schlick's reflectance at its half vector.
BN_FN void add_line_sample(BN_IN(shaded_point) x, BN_IN(lobe_line) line, real t, real weight, BN_INOUT(line_sum) sum)
{
    // Find the sample's direction, level and reflectance
    lobe_line_sample at = lobe_line_at(line, t);
    real w = at.weight * weight;
    real lod = min(sqrt(at.radius), lit(1.0)) * to_real(int_lit(sum.cube.levels - 1));
    real away = lit(1.0) - at.v_dot_h;
    real away2 = away * away;
    real3 schlick = x.s.f0 + sum.rise * (away2 * away2 * away);
    real3 reflectance = max(schlick, vec3_all(lit(1e-4))); // a channel without reflectance keeps its mean
    // Add the weighted fetch
    cube_terms_add(sum.light, from_lobe(x.lobe, x.s.n, at.direction), lod, reflectance, w);
    sum.weights = sum.weights + reflectance * w;
}

// Returns the line of a point's lobe.
BN_FN lobe_line lobe_line_for(BN_IN(shaded_point) x)
{
    return lobe_line_of(to_lobe(x.lobe, x.s.n, x.s.v), x.lobe.sigma_u, x.lobe.sigma_v);
}

// Returns the mean radiance over the lobe; multiply by its albedo. offset: place of samples in their cells, (0,1). alike:
// similarity of the pixels around, [0,1]. alone: samples for each width of the line's length where alike is 0. A fragment whose
// neighbours are unlike it takes more samples, in the middle of their cells.
BN_FN real3 lobe_line_radiance(frame_ref f, BN_IN(shaded_point) x, BN_IN(lobe_line) own, real offset, real alike, real alone)
{
    // Find the number of samples
    real one = lit(1.0);
    int limit = x.samples - (x.samples % 2 == 0 ? 1 : 0); // one in the middle, and pairs
    real per_width = alone + (lit(kLineSamplesShared) - alone) * alike;
    real all = to_real(int_lit(limit));
    real some = all + (lobe_line_limit(own, all) - all) * alike;
    real count = lobe_line_count(own, per_width, max(some, min(all, lit(3.0))));
    offset = lit(0.5) + (offset - lit(0.5)) * alike;
    // Widen levels where few samples stand for the whole line
    lobe_line line = own;
    line.level = line.level * (one + lit(kLineWidening) / count * (one - alike));
    // Take the middle sample
    line_sum sum;
    sum.cube = prefiltered_env(f);
    sum.rise = x.s.f90 - x.s.f0;
    sum.weights = vec3_all(lit(0.0));
    cube_terms_begin(sum.light, sum.cube, true);
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
    return cube_terms_value(sum.light) / max(sum.weights, vec3_all(lit(1e-20)));
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
    lobe_line line = lobe_line_for(x);
    shared_sample_record r = unshared_record(vec3_all(lit(0.0)));
    // Share nothing where the lobe is round, and sample as alone
    real part = anisotropy_blend_of(x.lobe.sigma_u, x.lobe.sigma_v);
    r.width = line.width * part;
    r.mirror = mirrored_at(x.s.n, x.s.v);
    r.along = (x.lobe.u_axis * line.along.x + x.lobe.v_axis * line.along.y) * part;
    real alike = (similarity_beside(x, r, x.normal_dx) + similarity_beside(x, r, x.normal_dy)) * (lit(0.5) * part);
    real alone = lit(kLineSamplesUnlike) + lit(kLineSamplesAlone - kLineSamplesUnlike) * (lit(1.0) - part);
    r.light = lobe_line_radiance(f, x, line, offset, alike, alone);
    return r;
}

// Samples alone, for fragments that cannot read their neighbours.
BN_FN real3 lobe_line_specular(frame_ref f, BN_IN(shaded_point) x)
{
    return lobe_line_radiance(f, x, lobe_line_for(x), lit(0.5), lit(0.0), lit(kLineSamplesAlone)) * x.energy.albedo;
}

BN_KERNELS_END

#endif
