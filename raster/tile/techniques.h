// The techniques for environment light, in lanes: what each registered kernel does with one batch of surfaces. A technique is one
// function here (<id>_specular), its kernel file, and its line in shading/models.def.
#pragma once
#include "raster/frame/lanes_records.h"
#include "raster/tile/cube_sum.h"
#include "raster/tile/tile_types.h"
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

namespace burnish {
inline namespace BN_ISA_NS {

enum class Technique : std::int32_t {
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, summary) id,
#include "shading/models.def"
};

struct TechniqueInput {
    const FrameParams& f;
    const surface& s;
    const aniso_lobe& lobe;
    real3 albedo;      // directional albedo of the lobe, for techniques of a split integral
    integer pixel_id;  // y * width + x, for random numbers
    const surface_frame& surface_axes; // of the geometry
    bool turned;       // the lobe's normal is not the geometry's: light from below its horizon does not arrive
    real3 gain;        // energy compensation, by which the result will be multiplied; 1 without
};

// Whether a technique asks of every sample if it lies above the horizon; the others fade.
constexpr bool tests_horizon(Technique t)
{
    return t == Technique::filtered_is || t == Technique::filtered_is_ggx || t == Technique::mc;
}

BN_INLINE real above_horizon(const TechniqueInput& in, real3 wi, real weight)
{
    return in.turned ? select(k_dot3(in.surface_axes.n, wi) > lit(0.0), weight, lit(0.0)) : weight;
}

BN_INLINE real3 split_isotropic_specular(const TechniqueInput& in)
{
    return split_isotropic_radiance(in.s, lanes_cube(in.f.specular_cube)) * in.albedo;
}

BN_INLINE real3 bent_normal_specular(const TechniqueInput& in)
{
    const cube_desc cube = lanes_cube(in.f.specular_cube);
    const bent_ray ray = bent_normal_ray(in.s.n, in.s.v, in.lobe);
    return cube_sample(cube, ray.direction, ray.lod * to_real(int_lit(cube.levels - 1))) * in.albedo;
}

struct LaneCurve {
    major_axis_curve directions; // world space
    real radius;
};

BN_INLINE LaneCurve major_axis_in_world(const TechniqueInput& in, real inv_count)
{
    real3 o = to_lobe(in.lobe, in.s.n, in.s.v);
    o.z = max(o.z, lit(1e-4));
    o = k_normalize3(o);
    const major_axis_line line =
        major_axis_setup(o, in.lobe.sigma_u, in.lobe.sigma_v, splat(in.f.major_axis_k), splat(in.f.major_axis_beta), inv_count);
    const real3 e0 = from_lobe(in.lobe, in.s.n, line.e0), step = from_lobe(in.lobe, in.s.n, line.e1 - line.e0);
    return {major_axis_curve_of(e0, step, from_lobe(in.lobe, in.s.n, o)), line.radius};
}

BN_INLINE real major_axis_lod(real radius, const cube_desc& cube)
{
    return min(sqrt(radius), lit(1.0)) * to_real(int_lit(cube.levels - 1));
}

BN_INLINE real3 major_axis_specular(const TechniqueInput& in)
{
    const cube_desc cube = lanes_cube(in.f.specular_cube);
    const int n = in.f.samples;
    const real inv = lit(1.0) / to_real(int_lit(n));
    const LaneCurve curve = major_axis_in_world(in, inv);
    CubeSum sum;
    begin(sum, cube);
    const cube_levels levels = levels_at(sum, major_axis_lod(curve.radius, cube), inv);
    for (int j = 0; j < n; ++j) {
        const float s = n == 1 ? 0.5f : static_cast<float>(j) / static_cast<float>(n - 1);
        add_sample(sum, major_axis_direction(curve.directions, splat(s)), levels);
    }
    return sum_of(sum) * in.albedo;
}

// Samples of a lobe along its grain, and the sum of their weights.
struct GrainSum {
    CubeSum light;
    real weights;
};

BN_INLINE void begin(GrainSum& sum, const cube_desc& cube)
{
    begin(sum.light, cube);
    sum.weights = lit(0.0);
}

BN_INLINE void add_grain_sample(const TechniqueInput& in, const major_axis_grain& grain, real c, real root, real spacing, real weight, GrainSum& sum)
{
    const grain_sample g = major_axis_grain_sample(grain, c, root, spacing);
    const real w = g.weight * weight;
    add_sample(sum.light, from_lobe(in.lobe, in.s.n, g.direction), levels_at(sum.light, major_axis_lod(g.radius, *sum.light.cube), w));
    sum.weights = sum.weights + w;
}

BN_INLINE real3 mean_of(GrainSum& sum) { return sum_of(sum.light) / max(sum.weights, lit(1e-20)); }

BN_INLINE major_axis_grain grain_of(const TechniqueInput& in)
{
    return major_axis_grain_of(to_lobe(in.lobe, in.s.n, in.s.v), in.lobe.sigma_u, in.lobe.sigma_v, splat(in.f.major_axis_k));
}

// Samples where the lobe is dense, each with a level of its own and the weight that masking and the visible area leave it.
BN_INLINE real3 major_axis_weighted_specular(const TechniqueInput& in)
{
    const cube_desc cube = lanes_cube(in.f.specular_cube);
    const int n = in.f.samples;
    const major_axis_grain grain = grain_of(in);
    const float step = 2.0f / static_cast<float>(n);
    const real spacing = splat(in.f.major_axis_beta * step);
    GrainSum sum;
    begin(sum, cube);
    for (int j = 0; j < n; ++j) {
        const float c = (static_cast<float>(j) + 0.5f) * step - 1.0f;
        add_grain_sample(in, grain, splat(c), sqrt(splat(1.0f - c * c)), spacing, lit(1.0), sum);
    }
    return mean_of(sum) * in.albedo;
}

// Density-placed too, but with no more samples than each fragment needs, in cells around the middle that come and go without a step. One
// sample lies in the middle and the others in pairs, so an even --samples is taken as one less: never more than asked for.
BN_INLINE real3 major_axis_adaptive_specular(const TechniqueInput& in)
{
    const cube_desc cube = lanes_cube(in.f.specular_cube);
    const major_axis_grain grain = grain_of(in);
    const real beta = splat(in.f.major_axis_beta), one = lit(1.0);
    const int limit = in.f.samples - (in.f.samples % 2 == 0); // one in the middle and pairs
    const real k = splat(in.f.major_axis_k);
    real count = major_axis_grain_count(grain, beta, to_real(int_lit(limit)));
    if (any(both(count > one, major_axis_count_unsure(grain, k))))
        count = major_axis_limited_count(grain, in.lobe.sigma_u, in.lobe.sigma_v, k, beta, count);
    const real spacing = beta * lit(2.0) / count;
    GrainSum sum;
    begin(sum, cube);
    add_grain_sample(in, grain, lit(0.0), one, spacing, one, sum);
    float most[kLanes];
    store(most, reduce_max(count));
    for (int i = 1; static_cast<float>(2 * i - 1) < most[0]; ++i) {
        const grain_cell cell = major_axis_grain_cell(count, i);
        const real root = sqrt(one - cell.c * cell.c);
        add_grain_sample(in, grain, cell.c, root, spacing, cell.weight, sum);
        add_grain_sample(in, grain, -cell.c, root, spacing, cell.weight, sum);
    }
    return mean_of(sum) * in.albedo;
}

// Sampled lobes have a least width; what has none is a mirror: the environment itself in the mirror direction.
// dim: what masking leaves of a mirror.
BN_INLINE real3 mirrors_apart(const TechniqueInput& in, real3 value, real dim)
{
    const real width = in.lobe.sigma_u + in.lobe.sigma_v;
    const mask mirror = width <= lit(1e-6);
    if (none(mirror))
        return value;
    const real3 r = in.s.n * (lit(2.0) * k_dot3(in.s.n, in.s.v)) - in.s.v;
    const real seen = above_horizon(in, r, dim);
    return select(mirror, cube_sample_level(lanes_cube(in.f.specular_cube), r, 0) * in.albedo * seen, value);
}

// `place` gives the sample of a grid point.
template <class Place> BN_INLINE real3 filtered_is_sum(const TechniqueInput& in, const Place& place)
{
    const cube_desc cube = lanes_cube(in.f.box_cube);
    real3 o = to_lobe(in.lobe, in.s.n, in.s.v);
    o.z = max(o.z, lit(1e-4));
    o = k_normalize3(o);
    const real size = to_real(int_lit(cube.size));
    const real count = to_real(int_lit(in.f.grid_count));
    const real texel_term = lit(0.5) * k_log2(size * size * lit(0.47746482927568601) / count); // 6 / (4 pi)
    CubeTerms sum;
    begin(sum, cube, true);
    real weights = lit(0.0), kept = lit(0.0);
    for (int i = 0; i < in.f.grid_count; ++i) {
        const filtered_sample s = place(o, in.f.grid[i], texel_term);
        const real3 wi = from_lobe(in.lobe, in.s.n, s.wi);
        const real3 fresnel = fresnel_schlick(in.s.f0, in.s.f90, k_saturate(s.o_dot_h));
        const real weight = above_horizon(in, wi, s.weight);
        add_term(sum, wi, s.lod, fresnel, weight);
        weights = weights + s.weight, kept = kept + weight;
    }
    real3 total = sum_of(sum);
    if (in.f.tilted) // a mean, to be scaled by the tilted lobe's albedo
        total = total / max(kept / count, lit(1e-4));
    else if (in.f.energy_compensation) // these few samples, and a Beckmann lobe, have an albedo of their own
        total = total * energy_compensation_of_albedo(in.s.f0, weights / count) / in.gain;
    return mirrors_apart(in, total / count * splat(in.f.box_cube.scale / in.f.specular_cube.scale), lit(1.0));
}

BN_INLINE real3 filtered_is_specular(const TechniqueInput& in)
{
    const real root2 = lit(1.4142135623730951);
    const beckmann_params p = beckmann_params_of(in.lobe.sigma_u * root2, in.lobe.sigma_v * root2);
    return filtered_is_sum(in, [&](real3 o, const GridSample& g, real term) {
        return filtered_is_beckmann(o, p, splat(g.slope_x), splat(g.slope_y), splat(g.density), term);
    });
}

BN_INLINE real3 filtered_is_ggx_specular(const TechniqueInput& in)
{
    const real root2 = lit(1.4142135623730951);
    const ggx_aniso_params p = ggx_aniso_params_of(in.lobe.sigma_u * root2, in.lobe.sigma_v * root2);
    return filtered_is_sum(in, [&](real3 o, const GridSample& g, real term) {
        return filtered_is_ggx(o, p, splat(g.slope_x), splat(g.slope_y), splat(g.density), term);
    });
}

// `sample_at` gives a bsdf_sample in world space for a point of the unit square: a Hammersley set rotated by a hash of the pixel.
template <class SampleAt> BN_INLINE real3 mc_sum(const TechniqueInput& in, const SampleAt& sample_at)
{
    const cube_desc cube = lanes_cube(in.f.specular_cube);
    const integer seed = k_hash_u32(in.pixel_id ^ int_lit(in.f.seed));
    const real shift_x = k_unit_from_bits(seed), shift_y = k_unit_from_bits(k_hash_u32(seed));
    const int n = in.f.samples;
    const float inv = 1.0f / static_cast<float>(n);
    CubeTerms sum;
    begin(sum, cube, false);
    for (int i = 0; i < n; ++i) {
        const real x = splat((static_cast<float>(i) + 0.5f) * inv) + shift_x, y = k_radical_inverse2(int_lit(i)) + shift_y;
        const bsdf_sample b = sample_at(vec2_of(x - floor(x), y - floor(y)));
        const real3 fresnel = fresnel_schlick(in.s.f0, in.s.f90, b.o_dot_h);
        add_term(sum, b.wi, lit(0.0), fresnel, above_horizon(in, b.wi, b.weight));
    }
    return sum_of(sum) * splat(inv);
}

// The lobe as an ellipsoid in the surface's own frame, and what is seen of it.
struct LaneEllipsoid {
    ellipsoid_params p;
    real3 o; // to the eye
};

BN_INLINE real3 in_frame(const surface_frame& g, real3 w) { return vec3_of(k_dot3(g.t, w), k_dot3(g.b, w), k_dot3(g.n, w)); }

BN_INLINE LaneEllipsoid lobe_on_surface(const aniso_lobe& lobe, const surface& s, const surface_frame& g)
{
    const real root2 = lit(1.4142135623730951);
    LaneEllipsoid r;
    r.p = ellipsoid_params_of_rows(lobe.sigma_u * root2, lobe.sigma_v * root2, in_frame(g, lobe.u_axis), in_frame(g, lobe.v_axis),
                                   in_frame(g, s.n));
    r.o = in_frame(g, s.v);
    r.o.z = max(r.o.z, lit(1e-4));
    r.o = k_normalize3(r.o);
    return r;
}

// GGX visible normals, height-correlated masking, Fresnel by sample. A tilted lobe is an ellipsoid's, whose masking knows the surface.
BN_INLINE real3 mc_specular(const TechniqueInput& in)
{
    const aniso_lobe& lobe = in.lobe;
    if (in.f.tilted) {
        const LaneEllipsoid e = lobe_on_surface(lobe, in.s, in.surface_axes);
        const real3 sum = mc_sum(in, [&](real2 xi) {
            bsdf_sample b = ellipsoid_sample(e.p, e.o, xi);
            b.wi = in.surface_axes.t * b.wi.x + in.surface_axes.b * b.wi.y + in.surface_axes.n * b.wi.z;
            return b;
        });
        return mirrors_apart(in, sum, ellipsoid_mirror_albedo(e.p, e.o));
    }
    const real root2 = lit(1.4142135623730951);
    const ggx_aniso_params p = ggx_aniso_params_of(lobe.sigma_u * root2, lobe.sigma_v * root2);
    real3 o = to_lobe(lobe, in.s.n, in.s.v);
    o.z = max(o.z, lit(1e-4));
    o = k_normalize3(o);
    const real3 sum = mc_sum(in, [&](real2 xi) {
        bsdf_sample b = ggx_aniso_sample(p, o, xi);
        b.wi = from_lobe(lobe, in.s.n, b.wi);
        return b;
    });
    return mirrors_apart(in, sum, lit(1.0));
}

template <Technique kTechnique> BN_INLINE real3 technique_specular(const TechniqueInput& in)
{
#define BN_TECHNIQUE(id, sampling, default_samples, most_samples, summary) \
    if constexpr (kTechnique == Technique::id)                                                                         \
        return id##_specular(in);
#include "shading/models.def"
}

} // namespace BN_ISA_NS
} // namespace burnish
