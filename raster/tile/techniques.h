// The techniques for environment light, in lanes: what each registered kernel does with one batch of surfaces. A technique is one
// function here (<id>_specular), its kernel file, and its line in shading/models.def.
#pragma once
#include "raster/frame/lanes_records.h"
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

BN_INLINE real3 texel_rgb(texel_acc acc)
{
    const real4 v = texel_value(acc);
    return vec3_of(v.x, v.y, v.z);
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

struct LaneLine { // the major axis in world space
    real3 e0, step, o;
    major_axis_line line;
};

BN_INLINE LaneLine major_axis_in_world(const TechniqueInput& in, real inv_count)
{
    real3 o = to_lobe(in.lobe, in.s.n, in.s.v);
    o.z = max(o.z, lit(1e-4));
    o = k_normalize3(o);
    LaneLine r;
    r.line = major_axis_setup(o, in.lobe.sigma_u, in.lobe.sigma_v, splat(in.f.major_axis_k), splat(in.f.major_axis_beta), inv_count);
    r.e0 = from_lobe(in.lobe, in.s.n, r.line.e0);
    r.step = from_lobe(in.lobe, in.s.n, r.line.e1 - r.line.e0);
    r.o = from_lobe(in.lobe, in.s.n, o);
    return r;
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
    const LaneLine line = major_axis_in_world(in, inv);
    const real lod = major_axis_lod(line.line.radius, cube);
    texel_acc acc = texel_zero();
    for (int j = 0; j < n; ++j) {
        const float s = n == 1 ? 0.5f : static_cast<float>(j) / static_cast<float>(n - 1);
        acc = cube_texel_add(acc, cube, major_axis_direction(line.e0, line.step, line.o, splat(s)), lod, inv);
    }
    return texel_rgb(acc) * in.albedo;
}

// One sample of a lobe along its grain, added to a sum and its weights.
BN_INLINE void add_grain_sample(const TechniqueInput& in, const cube_desc& cube, const major_axis_grain& grain, real c, real root,
                                real spacing, real weight, texel_acc& acc, real& sum)
{
    const grain_sample g = major_axis_grain_sample(grain, c, root, spacing);
    const real w = g.weight * weight;
    acc = cube_texel_add(acc, cube, from_lobe(in.lobe, in.s.n, g.direction), major_axis_lod(g.radius, cube), w);
    sum = sum + w;
}

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
    texel_acc acc = texel_zero();
    real sum = lit(0.0);
    for (int j = 0; j < n; ++j) {
        const float c = (static_cast<float>(j) + 0.5f) * step - 1.0f;
        add_grain_sample(in, cube, grain, splat(c), sqrt(splat(1.0f - c * c)), spacing, lit(1.0), acc, sum);
    }
    return texel_rgb(acc) / max(sum, lit(1e-20)) * in.albedo;
}

// Density-placed too, but with no more samples than each fragment needs, in cells around the middle that come and go without a step. One
// sample lies in the middle and the others in pairs, so an even --samples is taken as one less: never more than asked for.
BN_INLINE real3 major_axis_adaptive_specular(const TechniqueInput& in)
{
    const cube_desc cube = lanes_cube(in.f.specular_cube);
    const major_axis_grain grain = grain_of(in);
    const real beta = splat(in.f.major_axis_beta), one = lit(1.0);
    const int limit = in.f.samples - (in.f.samples % 2 == 0); // one in the middle and pairs
    const real count = major_axis_grain_count(grain, beta, to_real(int_lit(limit)));
    const real spacing = beta * lit(2.0) / count;
    texel_acc acc = texel_zero();
    real sum = lit(0.0);
    add_grain_sample(in, cube, grain, lit(0.0), one, spacing, one, acc, sum);
    float most[kLanes];
    store(most, reduce_max(count));
    for (int i = 1; static_cast<float>(2 * i - 1) < most[0]; ++i) {
        const grain_cell cell = major_axis_grain_cell(count, i);
        const real root = sqrt(one - cell.c * cell.c);
        add_grain_sample(in, cube, grain, cell.c, root, spacing, cell.weight, acc, sum);
        add_grain_sample(in, cube, grain, -cell.c, root, spacing, cell.weight, acc, sum);
    }
    return texel_rgb(acc) / max(sum, lit(1e-20)) * in.albedo;
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
    real3 sum = vec3_all(lit(0.0));
    real weights = lit(0.0);
    for (int i = 0; i < in.f.grid_count; ++i) {
        const filtered_sample s = place(o, in.f.grid[i], texel_term);
        const real3 wi = from_lobe(in.lobe, in.s.n, s.wi);
        const real3 fresnel = fresnel_schlick(in.s.f0, in.s.f90, k_saturate(s.o_dot_h));
        sum = sum + cube_sample(cube, wi, s.lod) * fresnel * above_horizon(in, wi, s.weight);
        weights = weights + s.weight;
    }
    if (in.f.energy_compensation) // these few samples, and a Beckmann lobe, have an albedo of their own
        sum = sum * energy_compensation_of_albedo(in.s.f0, weights / count) / in.gain;
    return mirrors_apart(in, sum / count * splat(in.f.box_cube.scale / in.f.specular_cube.scale), lit(1.0));
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
    real3 sum = vec3_all(lit(0.0));
    for (int i = 0; i < n; ++i) {
        const real x = splat((static_cast<float>(i) + 0.5f) * inv) + shift_x, y = k_radical_inverse2(int_lit(i)) + shift_y;
        const bsdf_sample b = sample_at(vec2_of(x - floor(x), y - floor(y)));
        const real3 fresnel = fresnel_schlick(in.s.f0, in.s.f90, b.o_dot_h);
        sum = sum + cube_sample_level(cube, b.wi, 0) * fresnel * above_horizon(in, b.wi, b.weight);
    }
    return sum * splat(inv);
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
        return mirrors_apart(in, sum, ellipsoid_tilt_albedo(e.p, e.o));
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
