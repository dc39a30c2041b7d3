// The source of `burnish export`: all techniques, with a stage (shading/inputs/stage.h) that has no buffers, only user-supplied
// fetches. The C preprocessor flattens this file at build time, and apps/export keeps the parts of one technique.
#define BN_FRAME_H
#define BN_STAGE_GLSL
#define BN_CUBE_FILTER_K_H
#define BN_OWN_TEXELS
#define BN_LTC_CORNERS 4

// You provide this function: texel (at % 192, at / 192) of the texture ltc of `burnish bake environment --format`, without filtering.
vec4 ltc_texel(int at);

vec4 bn_texel(int texels, int at)
{
    return ltc_texel(at);
}

#include "shading/lang/lang.h"
#include "shading/lang/records.h"
#include "shading/kernels/math.k.h"
#include "shading/surface/dfg.k.h"
#include "shading/lights/ltc_polygon.k.h"
#include "shading/lights/ltc_table.k.h"
#include "shading/surface/energy.k.h"

#define frame_ref settings
#define any_frame settings
#define material_ref int
#define the_frame(f) f
#define the_material(m) materials[m]
#define lobe_used(at) true
#define film_used() false
#define any_material int

// Settings of a technique, common to all shading points. specular, box, whole: size (texels along a face's side) and level count of the
// environment maps; scale: factor for fetched values, usually 1. samples, grid_count: sample counts. lobe: the model;
// lobe_traits: 1 for GGX, the default. The others are options of `burnish render`.
struct settings {
    CubeRecord specular, whole, box;
    int grid_count, samples;
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_RECORD_##kind(id)
#include "shading/models.def"
    int lobe, lobe_traits;
};

// Returns the default settings.
settings usual_settings(int specular_size, int specular_levels, int sample_count)
{
    settings f;
    f.specular = CubeRecord(specular_size, specular_levels, 1.0);
    f.whole = f.specular;
    f.box = f.specular;
    f.grid_count = kGridCount;
    f.samples = sample_count;
#define BN_DEFAULT_number(id, fallback) f.id = fallback;
#define BN_DEFAULT_whole(id, fallback) f.id = fallback;
#define BN_DEFAULT_flag(id, fallback) f.id = fallback;
#define BN_DEFAULT_choice(id, fallback) f.id = fallback;
#define BN_DEFAULT_lobe(id, fallback) f.id = fallback;
#define BN_DEFAULT_way(id, fallback) f.id = 0;
#define BN_DEFAULT_angles(id, fallback) // of materials
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_DEFAULT_##kind(id, fallback)
#include "shading/models.def"
    f.lobe = 0;
    f.lobe_traits = 1;
    return f;
}

// [fetches
// You provide this function: environment radiance towards `direction` (any length), at a fractional level of detail. cube 0: prefiltered
// by GGX lobes, level l of N for alpha = (l / (N - 1))^2, as textureLod() on a cube map. cube 1: the box-filtered mip chain. cube 2: the
// environment itself, level 0, with the suns and lamps that the other two leave out.
vec4 radiance(int cube, vec3 direction, float lod);

struct cube_desc {
    int which;
    int size, levels;
};
struct cube_sum {
    cube_desc cube;
    real3 value;
};
struct cube_sum_levels {
    real lod, weight;
};
struct cube_terms {
    cube_desc cube;
    real3 value;
    bool trilinear;
};

real3 fetched(cube_desc cube, real3 direction, real lod)
{
    real4 value = radiance(cube.which, direction, lod);
    return vec3(value.x, value.y, value.z);
}
real3 fetched_level(cube_desc cube, real3 direction, int level)
{
    return fetched(cube, direction, float(level));
}

cube_desc prefiltered_env(settings f)
{
    return cube_desc(0, f.specular.size, f.specular.levels);
}
cube_desc mip_env(settings f)
{
    return cube_desc(1, f.box.size, f.box.levels);
}
cube_desc full_env(settings f)
{
    return cube_desc(2, f.whole.size, f.whole.levels);
}

void cube_sum_begin(inout cube_sum s, cube_desc cube)
{
    s.cube = cube;
    s.value = vec3(0.0);
}
cube_sum_levels cube_sum_levels_at(cube_sum s, real lod, real weight)
{
    return cube_sum_levels(lod, weight);
}
void cube_sum_add(inout cube_sum s, real3 direction, cube_sum_levels levels)
{
    real3 value = fetched(s.cube, direction, levels.lod) * levels.weight;
    s.value = s.value + value;
}
real3 cube_sum_value(cube_sum s)
{
    return s.value;
}

void cube_terms_begin(inout cube_terms s, cube_desc cube, bool trilinear)
{
    s.cube = cube;
    s.value = vec3(0.0);
    s.trilinear = trilinear;
}
void cube_terms_add(inout cube_terms s, real3 direction, real lod, real3 colour, real weight)
{
    real3 value = fetched(s.cube, direction, s.trilinear ? lod : 0.0);
    s.value = s.value + value * colour * weight;
}
void cube_terms_add_level(inout cube_terms s, cube_desc cube, real3 direction, integer level, real3 colour, real weight)
{
    real3 value = fetched(cube, direction, float(level));
    s.value = s.value + value * colour * weight;
}
real3 cube_terms_value(cube_terms s)
{
    return s.value;
}

real3 grid_sample(settings f, int i)
{
    return kGrid[i];
}
real4 grid_of_four(settings f, int first, integer set)
{
    return kGrid[first / kPhongBlock * 4 + set];
}
// fetches]

#define cube_sample fetched
#define cube_sample_level fetched_level
#define BN_TECHNIQUE_TEXTS
#include "shading/models.def"

// Returns the lobe of point_of()'s arguments.
aniso_lobe lobe_of_widths(vec3 n, vec3 tangent, float roughness, float anisotropy)
{
    real alpha = roughness * roughness;
    real root = lit(0.70710678118654752);
    real along = alpha * (1.0 + anisotropy) * root;
    real across = alpha * (1.0 - anisotropy) * root;
    surface_frame axes = frame_of(n, tangent, 1.0);
    aniso_lobe lobe;
    lobe.u_axis = select(along >= across, axes.t, axes.b);
    lobe.v_axis = select(along >= across, axes.b, -axes.t);
    lobe.sigma_u = max(along, across);
    lobe.sigma_v = min(along, across);
    return lobe;
}

// Returns the place of a lobe's directional albedo in the texture lobe_albedo of `burnish bake environment --format`. xy: coordinates of
// a bilinear fetch; z, w: weights of the tiles to the right and below, 0.1 further. With t() for the fetch, the argument dfg of point_of()
// is
//     mix(mix(t(x, y), t(x + 0.1, y), z), mix(t(x, y + 0.1), t(x + 0.1, y + 0.1), z), w)
vec4 albedo_place(vec3 n, vec3 v, vec3 tangent, float roughness, float anisotropy)
{
    lobe_albedo_place at = lobe_albedo_place_of(20, lobe_of_widths(n, tangent, roughness, anisotropy), n, v);
    real column = min(floor(at.z), lit(8.0));
    real row = min(floor(at.w), lit(8.0));
    return vec4((20.0 * column + at.x + 0.5) * 0.005, (20.0 * row + at.y + 0.5) * 0.005, at.z - column, at.w - row);
}

// Makes the point that a technique shades. f: the settings. n: shading normal; v: direction to the eye; tangent: the grain,
// perpendicular to n; all unit, world space. f0, f90: reflectance at normal and at grazing incidence. roughness: perceptual,
// alpha = roughness^2. anisotropy: in [-1,1], lobe widths are alpha (1 + anisotropy) along the grain and alpha (1 - anisotropy)
// across. dfg: directional albedo of the lobe as f0 x + f90 y, by albedo_place() or, for round lobes, dfg_fit(). pixel: y * width + x, seed
// of random numbers. For lobe_line_shared(), set normal_dx and normal_dy of the point to dFdx(n) and dFdy(n). With 0, all pixels
// around count as alike.
shaded_point point_of(settings f, vec3 n, vec3 v, vec3 tangent, vec3 f0, vec3 f90, float roughness, float anisotropy, vec2 dfg, int pixel)
{
    surface_frame axes = frame_of(n, tangent, 1.0);
    shaded_point x;
    x.geometric_axes = axes;
    x.has_surface_horizon = false;
    x.diffuse = false;
    x.dielectric_f0 = f0;
    x.dielectric_f90 = lit(1.0);
    x.transmission.refracts = false;
    x.transmission.disperses = false;
    x.transmission.samples_interface = false;
    x.transmission.body = false;
    x.lobe = lobe_of_widths(n, tangent, roughness, anisotropy);
    x.s.n = n;
    x.s.v = v;
    x.s.n_dot_v = clamp(k_dot3(n, v), lit(1e-4), lit(1.0));
    x.s.f0 = f0;
    x.s.f90 = f90;
    x.s.roughness = roughness;
    x.s.diffuse = vec3(0.0);
    x.s.occlusion = lit(1.0);
    x.s.exact = 0;
    x.energy.albedo = f0 * dfg.x + f90 * dfg.y;
    x.energy.phong_albedo = lit(-1.0);
    x.energy.phong_set = -1;
    x.energy.dfg = dfg_value(dfg.x, dfg.y);
    x.energy.own_dfg = x.energy.dfg;
    x.energy.whole = x.energy.dfg;
    x.energy.albedo_ratio = lit(1.0);
    x.energy.gain = vec3(1.0);
    x.energy.compensation = vec3(1.0);
    x.pixel_id = pixel;
    x.samples = f.samples;
    x.normal_dx = vec3(0.0);
    x.normal_dy = vec3(0.0);
    return x;
}

// Returns the specular light from a quad of even radiance, by transformed cosines: without shadows, and without the diffuse part. a, b, c,
// d: its corners, relative to the shaded point, in the same space as the point's normal. It shines to the side from which they run
// counter-clockwise, or to both.
vec3 quad_light(shaded_point x, vec3 a, vec3 b, vec3 c, vec3 d, vec3 radiance, bool two_sided)
{
    ltc_table table;
    table.texels = 0;
    table.root_alpha = 1;
    table.basis = 1;
    table.over_alpha = 1;
    table.inverse = 0;
    table.alphas = 11;
    real root2 = lit(1.4142135623730951);
    ltc_lobe lobe = ltc_lookup(table, to_lobe(x.lobe, x.s.n, x.s.v), x.lobe.sigma_u * root2, x.lobe.sigma_v * root2);
    ltc_polygon quad;
    quad.corner[0] = to_lobe(x.lobe, x.s.n, a);
    quad.corner[1] = to_lobe(x.lobe, x.s.n, b);
    quad.corner[2] = to_lobe(x.lobe, x.s.n, c);
    quad.corner[3] = to_lobe(x.lobe, x.s.n, d);
    ltc_light light = ltc_polygon_light(lobe, quad, 4);
    real part = ltc_sided(light.part, a, k_cross(b - a, d - a), two_sided ? 1 : 0);
    return radiance * (x.s.f0 * (lobe.all - lobe.grazing) + x.s.f90 * lobe.grazing) * part;
}
