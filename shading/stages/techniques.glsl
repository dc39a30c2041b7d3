// The techniques for environment light: what each registered kernel does with one surface. As raster/tile/techniques.h, whose functions
// <id>_specular have their twins here; shading/models.def makes the switch.
#ifndef BN_TECHNIQUES_GLSL
#define BN_TECHNIQUES_GLSL

#include "shading/stages/environment.glsl"
#include "shading/kernels/bent_normal.k.h"
#include "shading/kernels/ellipsoid.k.h"
#include "shading/kernels/energy.k.h"
#include "shading/kernels/filtered_is.k.h"
#include "shading/kernels/fresnel.k.h"
#include "shading/kernels/ggx_aniso.k.h"
#include "shading/kernels/lobe.k.h"
#include "shading/kernels/major_axis.k.h"
#include "shading/kernels/split_isotropic.k.h"
#include "shading/kernels/surface.k.h"

layout(constant_id = 0) const int kTechnique = 0; // its place in models.def

struct technique_input {
    surface s;
    aniso_lobe lobe;
    real3 albedo;               // directional albedo of the lobe, for techniques of a split integral
    int pixel_id;               // y * width + x, for random numbers
    surface_frame surface_axes; // of the geometry
    bool turned;                // the lobe's normal is not the geometry's: light from below its horizon does not arrive
    real3 gain;                 // energy compensation, by which the result will be multiplied; 1 without
};

real above_horizon(technique_input ti, real3 wi, real weight)
{
    return ti.turned ? select(k_dot3(ti.surface_axes.n, wi) > lit(0.0), weight, lit(0.0)) : weight;
}

real3 texel_rgb(texel_acc acc)
{
    real4 v = texel_value(acc);
    return v.xyz;
}

real3 eye_in_lobe(technique_input ti)
{
    real3 o = to_lobe(ti.lobe, ti.s.n, ti.s.v);
    o.z = max(o.z, lit(1e-4));
    return k_normalize3(o);
}

real3 split_isotropic_specular(technique_input ti) { return split_isotropic_radiance(ti.s, specular_cube()) * ti.albedo; }

real3 bent_normal_specular(technique_input ti)
{
    bent_ray ray = bent_normal_ray(ti.s.n, ti.s.v, ti.lobe);
    real lod = ray.lod * to_real(frame.specular.levels - 1);
    return cube_sample(specular_cube(), ray.direction, lod) * ti.albedo;
}

real major_axis_lod(real radius) { return min(sqrt(radius), lit(1.0)) * to_real(frame.specular.levels - 1); }

real3 major_axis_specular(technique_input ti)
{
    cube_desc cube = specular_cube();
    int n = frame.samples;
    real inv = lit(1.0) / to_real(n);
    real3 o = eye_in_lobe(ti);
    major_axis_line line = major_axis_setup(o, ti.lobe.sigma_u, ti.lobe.sigma_v, frame.major_axis_k, frame.major_axis_beta, inv);
    real3 e0 = from_lobe(ti.lobe, ti.s.n, line.e0);
    real3 along = line.e1 - line.e0;
    real3 step_ws = from_lobe(ti.lobe, ti.s.n, along);
    real3 o_ws = from_lobe(ti.lobe, ti.s.n, o);
    major_axis_curve curve = major_axis_curve_of(e0, step_ws, o_ws);
    real lod = major_axis_lod(line.radius);
    texel_acc acc = texel_zero();
    for (int j = 0; j < n; ++j) {
        real s = to_real(j) / to_real(max(n - 1, 1));
        s = n == 1 ? 0.5 : s;
        acc = cube_texel_add(acc, cube, major_axis_direction(curve, s), lod, inv);
    }
    return texel_rgb(acc) * ti.albedo;
}

struct grain_sum {
    texel_acc acc;
    real sum;
};

grain_sum add_grain_sample(technique_input ti, major_axis_grain grain, real c, real root, real spacing, real weight, grain_sum to)
{
    grain_sample g = major_axis_grain_sample(grain, c, root, spacing);
    real w = g.weight * weight;
    to.acc = cube_texel_add(to.acc, specular_cube(), from_lobe(ti.lobe, ti.s.n, g.direction), major_axis_lod(g.radius), w);
    to.sum = to.sum + w;
    return to;
}

major_axis_grain grain_of(technique_input ti)
{
    return major_axis_grain_of(to_lobe(ti.lobe, ti.s.n, ti.s.v), ti.lobe.sigma_u, ti.lobe.sigma_v, frame.major_axis_k);
}

real3 grain_mean(technique_input ti, grain_sum total) { return texel_rgb(total.acc) / max(total.sum, lit(1e-20)) * ti.albedo; }

real3 major_axis_weighted_specular(technique_input ti)
{
    int n = frame.samples;
    major_axis_grain grain = grain_of(ti);
    real step_c = lit(2.0) / to_real(n);
    real spacing = frame.major_axis_beta * step_c;
    grain_sum total = grain_sum(texel_zero(), 0.0);
    for (int j = 0; j < n; ++j) {
        real c = (to_real(j) + lit(0.5)) * step_c - lit(1.0);
        real root2 = lit(1.0) - c * c;
        total = add_grain_sample(ti, grain, c, sqrt(root2), spacing, lit(1.0), total);
    }
    return grain_mean(ti, total);
}

real3 major_axis_adaptive_specular(technique_input ti)
{
    major_axis_grain grain = grain_of(ti);
    int limit = frame.samples - (frame.samples % 2 == 0 ? 1 : 0); // one in the middle and pairs
    real beta = frame.major_axis_beta;
    real k = frame.major_axis_k;
    real count = major_axis_grain_count(grain, beta, to_real(limit));
    if (count > 1.0 && major_axis_count_unsure(grain, k))
        count = major_axis_limited_count(grain, ti.lobe.sigma_u, ti.lobe.sigma_v, k, beta, count);
    real spacing = beta * lit(2.0) / count;
    grain_sum total = grain_sum(texel_zero(), 0.0);
    total = add_grain_sample(ti, grain, lit(0.0), lit(1.0), spacing, lit(1.0), total);
    for (int i = 1; to_real(2 * i - 1) < count; ++i) {
        grain_cell cell = major_axis_grain_cell(count, i);
        real root2 = lit(1.0) - cell.c * cell.c;
        real root = sqrt(root2);
        total = add_grain_sample(ti, grain, cell.c, root, spacing, cell.weight, total);
        total = add_grain_sample(ti, grain, -cell.c, root, spacing, cell.weight, total);
    }
    return grain_mean(ti, total);
}

// Sampled lobes have a least width; what has none is a mirror: the environment itself in the mirror direction.
// dim: what masking leaves of a mirror.
real3 mirrors_apart(technique_input ti, real3 value, real dim)
{
    real width = ti.lobe.sigma_u + ti.lobe.sigma_v;
    if (!(width <= lit(1e-6)))
        return value;
    real3 r = ti.s.n * (lit(2.0) * k_dot3(ti.s.n, ti.s.v)) - ti.s.v;
    real seen = above_horizon(ti, r, dim);
    return cube_sample_level(specular_cube(), r, 0) * ti.albedo * seen;
}

real3 filtered_is_sum(technique_input ti, bool ggx)
{
    cube_desc cube = box_cube();
    real3 o = eye_in_lobe(ti);
    real size = to_real(cube.size);
    real count = to_real(frame.grid_count);
    real texels = size * size * lit(0.47746482927568601) / count; // 6 / (4 pi)
    real texel_term = lit(0.5) * k_log2(texels);
    real root2 = lit(1.4142135623730951);
    real alpha_u = ti.lobe.sigma_u * root2;
    real alpha_v = ti.lobe.sigma_v * root2;
    ggx_aniso_params of_ggx = ggx_aniso_params_of(alpha_u, alpha_v);
    beckmann_params of_beckmann = beckmann_params_of(alpha_u, alpha_v);
    real3 sum = vec3_all(lit(0.0));
    real weights = lit(0.0);
    real kept = lit(0.0);
    for (int i = 0; i < frame.grid_count; ++i) {
        int g = frame.grid_base + 3 * i;
        filtered_sample s;
        if (ggx)
            s = filtered_is_ggx(o, of_ggx, bn_reals[g], bn_reals[g + 1], bn_reals[g + 2], texel_term);
        else
            s = filtered_is_beckmann(o, of_beckmann, bn_reals[g], bn_reals[g + 1], bn_reals[g + 2], texel_term);
        real3 wi = from_lobe(ti.lobe, ti.s.n, s.wi);
        real3 fresnel = fresnel_schlick(ti.s.f0, ti.s.f90, k_saturate(s.o_dot_h));
        real weight = above_horizon(ti, wi, s.weight);
        sum = sum + cube_sample(cube, wi, s.lod) * fresnel * weight;
        weights = weights + s.weight;
        kept = kept + weight;
    }
    if (frame.tilted != 0) { // a mean, to be scaled by the tilted lobe's albedo
        real mean_weight = kept / count;
        sum = sum / max(mean_weight, lit(1e-4));
    } else if (frame.energy_compensation != 0) { // these few samples, and a Beckmann lobe, have an albedo of their own
        real own = weights / count;
        sum = sum * energy_compensation_of_albedo(ti.s.f0, own) / ti.gain;
    }
    real3 mean = sum / count * (frame.box.scale / frame.specular.scale);
    return mirrors_apart(ti, mean, lit(1.0));
}

real3 filtered_is_specular(technique_input ti) { return filtered_is_sum(ti, false); }
real3 filtered_is_ggx_specular(technique_input ti) { return filtered_is_sum(ti, true); }

// The lobe as an ellipsoid in the surface's own frame, and what is seen of it.
struct placed_ellipsoid {
    ellipsoid_params p;
    real3 o; // to the eye
};

real3 in_surface_frame(surface_frame g, real3 w) { return vec3(k_dot3(g.t, w), k_dot3(g.b, w), k_dot3(g.n, w)); }

placed_ellipsoid lobe_on_surface(aniso_lobe lobe, surface s, surface_frame g)
{
    real root2 = lit(1.4142135623730951);
    real alpha_u = lobe.sigma_u * root2;
    real alpha_v = lobe.sigma_v * root2;
    placed_ellipsoid r;
    r.p = ellipsoid_params_of_rows(alpha_u, alpha_v, in_surface_frame(g, lobe.u_axis), in_surface_frame(g, lobe.v_axis),
                                   in_surface_frame(g, s.n));
    r.o = in_surface_frame(g, s.v);
    r.o.z = max(r.o.z, lit(1e-4));
    r.o = k_normalize3(r.o);
    return r;
}

// GGX visible normals, height-correlated masking, Fresnel by sample: a Hammersley set rotated by a hash of the pixel. A tilted lobe is an
// ellipsoid's, whose masking knows the surface.
real3 mc_specular(technique_input ti)
{
    cube_desc cube = specular_cube();
    int seed = k_hash_u32(ti.pixel_id ^ frame.seed);
    real shift_x = k_unit_from_bits(seed);
    real shift_y = k_unit_from_bits(k_hash_u32(seed));
    real inv = lit(1.0) / to_real(frame.samples);
    real root2 = lit(1.4142135623730951);
    real alpha_u = ti.lobe.sigma_u * root2;
    real alpha_v = ti.lobe.sigma_v * root2;
    bool tilted = frame.tilted != 0;
    placed_ellipsoid e = lobe_on_surface(ti.lobe, ti.s, ti.surface_axes);
    ggx_aniso_params p = ggx_aniso_params_of(alpha_u, alpha_v);
    real3 o = eye_in_lobe(ti);
    real3 sum = vec3_all(lit(0.0));
    for (int i = 0; i < frame.samples; ++i) {
        real x = (to_real(i) + lit(0.5)) * inv + shift_x;
        real y = k_radical_inverse2(i) + shift_y;
        real2 xi = vec2(x - floor(x), y - floor(y));
        bsdf_sample b;
        if (tilted) {
            b = ellipsoid_sample(e.p, e.o, xi);
            b.wi = ti.surface_axes.t * b.wi.x + ti.surface_axes.b * b.wi.y + ti.surface_axes.n * b.wi.z;
        } else {
            b = ggx_aniso_sample(p, o, xi);
            b.wi = from_lobe(ti.lobe, ti.s.n, b.wi);
        }
        real3 fresnel = fresnel_schlick(ti.s.f0, ti.s.f90, b.o_dot_h);
        sum = sum + cube_sample_level(cube, b.wi, 0) * fresnel * above_horizon(ti, b.wi, b.weight);
    }
    real dim = tilted ? ellipsoid_mirror_albedo(e.p, e.o) : 1.0;
    return mirrors_apart(ti, sum * inv, dim);
}

real3 technique_specular(technique_input ti)
{
    int at = 0;
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, summary) \
    if (kTechnique == at++)                                                                                                                \
        return id##_specular(ti);
#include "shading/models.def"
    return vec3_all(lit(0.0));
}

#endif
