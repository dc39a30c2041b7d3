// The stage (shading/inputs/stage.h) in GLSL. Fetches with the filter kernels from buffers, or with BN_NATIVE_SAMPLER through
// the device's samplers.
#ifndef BN_STAGE_GLSL
#define BN_STAGE_GLSL

#include "shading/lang/frame.h"
#include "shading/inputs/material.glsl"
#include "shading/kernels/camera.t.h"
#include "shading/kernels/cube_filter.k.h"

real2 place_of_center(frame_ref f, view_params view, integer px, integer py)
{
    integer x = px + int_lit(the_frame(f).left);
    integer y = py + int_lit(the_frame(f).top);
    return place_on_screen(f, view, to_real(x) + lit(0.5), to_real(y) + lit(0.5));
}
#define the_light(f, i) lights[i]
#define light_reach int // index of the next light
#define lights_reaching(f, position) 0
#define next_light(f, reach) reach++
#define the_area_light(f, i) area_lights[i]
#define picture_of(f, i) desc_of_texture(area_lights[i].picture)
#define texture_of_frame(f, i) desc_of_texture(i)
#define dfg_pairs(f) kGpuDfgPage
#define lobe_albedo_pairs(f) kGpuLobeAlbedoPage
#define lobe_slice_pairs(f) kGpuLobeSlicePage
#define ltc_texels(f) kGpuLtcPage

cube_desc prefiltered_env(frame_ref f) { return cube_desc(kGpuSpecularPage, frame.specular.size, frame.specular.levels); }
cube_desc full_env(frame_ref f) { return cube_desc(kGpuWholePage, frame.whole.size, frame.whole.levels); }
cube_desc irradiance_cube(frame_ref f) { return cube_desc(kGpuIrradiancePage, frame.irradiance.size, frame.irradiance.levels); }
cube_desc mip_env(frame_ref f) { return cube_desc(kGpuBoxPage, frame.box.size, frame.box.levels); }
real4 grid_of_four(frame_ref f, int first, integer set)
{
    int at = 3 * first + set;
    return vec4(bn_reals[at], bn_reals[at + 4], bn_reals[at + 8], bn_reals[at + 12]);
}
real3 grid_sample(frame_ref f, int i) { return vec3(bn_reals[3 * i], bn_reals[3 * i + 1], bn_reals[3 * i + 2]); }

// One bit per lobe that materials and the frame use, by index in models.def. Higher bits hold the frame's method for area
// lights, if any, and coatings.
layout(constant_id = 1) const int kLobes = -1;
bool lobe_used(int at) { return (kLobes >> at & 1) != 0; }
bool transmission_used() { return (kLobes >> kGpuTransmits & 1) != 0; }
bool area_way_used(int at) { return (kLobes >> (kGpuFirstAreaWay + at) & 1) != 0; }
bool quads_apart() { return false; }
bool film_used() { return (kLobes >> kGpuFilms & 1) != 0; }
bool coating_used(int at) { return (kLobes >> (kGpuFirstCoating + at) & 1) != 0; }

struct cube_sum {
    cube_desc cube;
    texel_acc acc;
};
struct cube_terms {
    cube_desc cube;
    real3 sum;
    bool trilinear;
};

#ifdef BN_NATIVE_SAMPLER
layout(set = 1, binding = 0) uniform samplerCube native_cubes[kGpuCubes]; // specular, irradiance, box, whole

// Selects the sampler by constant index: not every device indexes samplers by a variable.
vec4 native_fetch(cube_desc cube, vec3 d, float lod)
{
    if (cube.texels == kGpuSpecularPage)
        return textureLod(native_cubes[0], d, lod);
    if (cube.texels == kGpuIrradiancePage)
        return textureLod(native_cubes[1], d, lod);
    if (cube.texels == kGpuWholePage)
        return textureLod(native_cubes[3], d, lod);
    return textureLod(native_cubes[2], d, lod);
}
real3 native_sample(cube_desc cube, real3 d, real lod) { return native_fetch(cube, d, lod).xyz; }
real3 native_sample_level(cube_desc cube, real3 d, int level) { return native_fetch(cube, d, float(level)).xyz; }
// From here on cube fetches are native, in kernels too.
#define cube_sample native_sample
#define cube_sample_level native_sample_level
real3 native_sample_own_level(cube_desc cube, real3 d, integer level) { return native_fetch(cube, d, float(level)).xyz; }
#define cube_sample_own_level native_sample_own_level

struct cube_sum_levels {
    real lod, weight;
};
cube_sum_levels cube_sum_levels_at(cube_sum s, real lod, real weight) { return cube_sum_levels(lod, weight); }
void cube_sum_add(inout cube_sum s, real3 direction, cube_sum_levels levels)
{
    real4 value = native_fetch(s.cube, direction, levels.lod) * levels.weight;
    s.acc.left = s.acc.left + value;
}
#else
#define cube_sum_levels cube_levels

cube_levels cube_sum_levels_at(cube_sum s, real lod, real weight)
{
    if (s.cube.levels > 1)
        return cube_levels_at(s.cube, lod, weight);
    cube_levels only;
    only.fine = weight;
    return only;
}
void cube_sum_add(inout cube_sum s, real3 direction, cube_levels levels)
{
    cube_place place = cube_face_uv(direction);
    if (s.cube.levels > 1) {
        s.acc = texel_rows_add(s.acc, s.cube.texels, cube_fine_rows(place, levels));
        s.acc = texel_rows_add(s.acc, s.cube.texels, cube_coarse_rows(place, levels));
    } else
        s.acc = cube_level_add(s.acc, s.cube, place, 0, levels.fine);
}
#endif

void cube_sum_begin(inout cube_sum s, cube_desc cube)
{
    s.cube = cube;
    s.acc = texel_zero();
}
real3 cube_sum_value(cube_sum s)
{
    real4 v = texel_value(s.acc);
    return v.xyz;
}

void cube_terms_begin(inout cube_terms s, cube_desc cube, bool trilinear)
{
    s.cube = cube;
    s.sum = vec3(0.0);
    s.trilinear = trilinear;
}
void cube_terms_add(inout cube_terms s, real3 direction, real lod, real3 colour, real weight)
{
    real3 value;
    if (s.trilinear)
        value = cube_sample(s.cube, direction, lod);
    else
        value = cube_sample_level(s.cube, direction, 0);
    s.sum = s.sum + value * colour * weight;
}
void cube_terms_add_level(inout cube_terms s, cube_desc cube, real3 direction, integer level, real3 colour, real weight)
{
    s.sum = s.sum + cube_sample_own_level(cube, direction, level) * colour * weight;
}
real3 cube_terms_value(cube_terms s) { return s.sum; }

#endif
