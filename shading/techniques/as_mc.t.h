// Samples of an Ashikhmin-Shirley lobe (shading/models/ashikhmin_shirley.k.h), from the box-filtered environment. Each
// fetch reads the one level whose texels are nearest in size to the sample's share of the sphere; more samples pay better
// than fetches between two levels.
//
// Frames bring a lattice (phong_point) in blocks of kPhongBlock: cosine and sine of an isotropic lobe's azimuth, and the
// logarithm of 1 - xi. The remaining steps are the same for each width, so roughness may vary by fragment. For a lobe with
// constant widths, frames bring its own half vectors (MaterialRecord::phong_set): the vector, and half the base-2 logarithm
// of its density. The albedo of such a lobe is known, too (phong_slice), and scales the samples: the main error of few
// samples is how many of them lie below the horizon. One sample is a mirror.
//
// There are four sets, which together form one set with four times the samples. Each pixel of a 2x2 quad has its own set,
// and neighbours with similar lobes average their results (shared_samples.k.h). The level offsets minimise FLIP errors: shared sets read a
// quarter level finer than all their samples ask for, a single set half a level finer than its own.
#ifndef BN_AS_MC_T_H
#define BN_AS_MC_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/models/ashikhmin_shirley.k.h"
#include "shading/surface/energy.k.h"
#include "shading/techniques/shared_samples.k.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

struct as_half_vector {
    real3 h;           // unit
    real half_density; // half the base-2 logarithm of the density, 1/sr
};

struct as_lobe {
    ashikhmin_shirley_params p;
    real2 wide;        // square roots of 1 + nv and 1 + nu
    real half_density; // at the normal, as above
};

BN_FN as_lobe as_lobe_of(BN_IN(shaded_point) x)
{
    // Find the exponents
    real root2 = lit(1.4142135623730951);
    as_lobe r;
    real alpha_u = x.lobe.sigma_u * root2;
    real alpha_v = x.lobe.sigma_v * root2;
    r.p = ashikhmin_shirley_params_of_alpha(alpha_u, alpha_v);
    // Find the density at the normal
    r.wide = vec2_of(sqrt(r.p.nv + lit(1.0)), sqrt(r.p.nu + lit(1.0)));
    real peak = r.wide.x * r.wide.y * lit(0.15915494309189534);
    r.half_density = lit(0.5) * k_log2(peak);
    return r;
}

// Returns the half vector of a lattice point. g: from grid_of_four().
BN_FN as_half_vector as_half_vector_of(as_lobe lobe, real4 g)
{
    // Stretch the azimuth, and find the exponent along it
    real2 d = k_normalize2(vec2_of(lobe.wide.x * g.x, lobe.wide.y * g.y));
    real e = lobe.p.nu * d.x * d.x + lobe.p.nv * d.y * d.y;
    // Find the cosine and the sine of the polar angle
    real lg = g.z / (e + lit(1.0));
    real less = k_expm1(lg); // cosine - 1, with its digits near the normal
    real q = sqrt(max(-(less * (less + lit(2.0))), lit(0.0)));
    as_half_vector r;
    real z = less + lit(1.0);
    r.h = vec3_of(d.x * q, d.y * q, z);
    r.half_density = lobe.half_density + e * lg * lit(0.72134752044448170);
    return r;
}

// Returns the rotation of a pixel's samples, before they are stretched to the lobe.
BN_FN k_sin_cos_pair turn_of_pixel(frame_ref f, BN_IN(shaded_point) x)
{
    real part = k_unit_from_bits(k_hash_u32(x.pixel_id ^ int_lit(the_frame(f).seed)));
    real angle = lit(6.2831853071795865) * part;
    return k_sin_cos(angle);
}

// Returns the reflected light, unless the lobe is a mirror. set: the pixel's, 0 to 3, where sets are shared.
BN_FN real3 as_mc_of_set(frame_ref f, BN_IN(shaded_point) x, integer set, bool shared_sets)
{
    cube_desc cube = mip_env(f);
    real3 o = eye_in_lobe(x);
    // Find the texels per sample
    real size = to_real(int_lit(cube.size));
    int samples = the_frame(f).grid_count;
    real count = to_real(int_lit(samples));
    real finer = lit(shared_sets ? 0.7 : 2.0);
    real texels = size * size * lit(0.47746482927568601) * finer / count; // 6 / (4 pi); finer: 4 is exact for one set, 1 for four
    real texel_term = lit(0.5) * k_log2(texels) - lit(63.0); // half of the exponent's 127, and half a level to round to the nearest
    // Take half vectors from the table or from the lobe
    bool by_table = x.energy.phong_set >= 0;
    as_lobe lobe;
    if (!by_table)
        lobe = as_lobe_of(x);
    int first = by_table ? x.energy.phong_set : 0;
    cube_desc same = cube;
    // Visit the samples
    real last = to_real(int_lit(cube.levels - 1));
    real per_cosine = lit(1.0) / max(o.z, lit(1e-4));
    cube_terms sum;
    cube_terms_begin(sum, cube, false);
    real weights = lit(0.0);
    real kept = lit(0.0);
    k_sin_cos_pair turn = turn_of_pixel(f, x);
    for (int i = 0; i < samples; ++i) {
        real4 g = grid_of_four(f, first + kPhongBlock * i, set);
        as_half_vector s;
        // Find the half vector
        if (by_table) {
            s.h = vec3_of(g.x, g.y, g.z);
            s.half_density = g.w;
        } else {
            if (the_frame(f).seed != 0)
                g = vec4_of(g.x * turn.cosine - g.y * turn.sine, g.x * turn.sine + g.y * turn.cosine, g.z, g.w);
            s = as_half_vector_of(lobe, g);
        }
        // Mirror the eye
        real o_dot_h = k_dot3(o, s.h);
        real3 i_lobe = mirror_direction(o, s.h);
        // Compute i.z / max(o.z, i.z), which is 0 below the horizon: o.h <= 0 implies i.z <= 0
        real own = max(min(i_lobe.z * per_cosine, lit(1.0)), lit(0.0));
        // A float's bits are its logarithm times 2^23, at most .086 octaves off, halved here. Negative values give level 0.
        real half_log = to_real(bits_of(o_dot_h)) * lit(5.9604644775390625e-8);
        real lod = half_log + (texel_term - s.half_density);
        integer level = to_int(min(max(lod, lit(0.0)), last));
        // Add radiance times weight and Fresnel
        real3 wi = from_lobe(x.lobe, x.s.n, i_lobe);
        real3 fresnel = reflectance_of(x.s, k_saturate(o_dot_h));
        real weight = above_horizon(x, wi, own);
        cube_terms_add_level(sum, same, wi, level, fresnel, weight);
        weights = weights + own;
        kept = kept + weight;
    }
    // Find the samples' own albedo
    real3 total = cube_terms_value(sum);
    real of_samples = weights / count;
    real albedo = of_samples;
    if (the_frame(f).as_tables == 0)
        albedo = select(x.energy.phong_albedo > lit(0.0), x.energy.phong_albedo, albedo);
    real mean_weight = kept / count;
    // Correct for tilt and for the known albedo
    if (x.has_surface_horizon && lies_in_surface(f)) // as if the lobe were untilted, as in filtered_is
        total = total * albedo / max(mean_weight, lit(1e-4));
    else if (the_frame(f).as_tables == 0)
        total = total * (albedo / max(of_samples, lit(1e-4)));
    if (the_frame(f).energy_compensation != 0) { // for this lobe, not for the default one
        if (uses_substitute_lobe(f))
            albedo = albedo * x.energy.albedo_ratio;
        total = total * energy_compensation_of_albedo(x.s.f0, albedo) / x.energy.compensation;
    }
    // Take the mean, in units of the prefiltered environment
    uniform_real scale = the_frame(f).box.scale / the_frame(f).specular.scale;
    return total / count * splat(scale);
}

// Samples one set alone, for fragments that cannot read their neighbours.
BN_FN real3 as_mc_specular(frame_ref f, BN_IN(shaded_point) x)
{
    if (the_frame(f).grid_count == 1)
        return mirrored(f, x, lit(1.0));
    return mirrors_apart(f, x, as_mc_of_set(f, x, int_lit(0), false), lit(1.0));
}

// Returns the shared record: light over the default lobe's albedo, so that each fragment applies its own f0. A mirror puts
// everything in `rest`. More samples resolve finer detail, so the more samples, the more similar lobes must be. With few
// samples, even lobes 3.5 widths apart share: single pixels would show as dots where surfaces turn fast.
BN_FN shared_sample_record as_mc_shared(frame_ref f, BN_IN(shaded_point) x, real offset)
{
    if (the_frame(f).grid_count == 1)
        return unshared_record(mirrored(f, x, lit(1.0)));
    // Sample this pixel's set
    real3 nothing = vec3_all(lit(0.0));
    real3 found = as_mc_of_set(f, x, to_int(offset * lit(4.0)), true);
    mask mirror = x.lobe.sigma_u + x.lobe.sigma_v <= lit(1e-6);
    // Fill light and rest
    shared_sample_record r;
    r.light = select(mirror, nothing, found / max(x.energy.albedo, vec3_all(lit(1e-6))));
    r.rest = select(mirror, mirrors_apart(f, x, nothing, lit(1.0)), nothing);
    // Describe the lobe for its similarity to others
    real along2 = max((x.lobe.sigma_u - x.lobe.sigma_v) * (x.lobe.sigma_u + x.lobe.sigma_v), lit(0.0));
    real nearer = min(lit(56.0) / to_real(int_lit(the_frame(f).grid_count)), lit(3.5));
    r.width = select(mirror, lit(-1.0), x.lobe.sigma_v * nearer);
    r.mirror = x.s.n * (lit(2.0) * k_dot3(x.s.n, x.s.v)) - x.s.v;
    r.along = x.lobe.u_axis * (sqrt(along2) * nearer);
    r.factor = nothing;
    return r;
}

BN_KERNELS_END

#endif
