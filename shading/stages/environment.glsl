// The environment as the stages fetch it: by the filter kernel from buffers, or with BN_NATIVE_SAMPLER by the device's samplers.
#ifndef BN_ENVIRONMENT_GLSL
#define BN_ENVIRONMENT_GLSL

#include "shading/stages/interface.glsl"
#include "shading/kernels/cube_filter.k.h"

cube_desc cube_of(GpuCube c) { return cube_desc(c.page, c.size, c.levels); }

#ifdef BN_NATIVE_SAMPLER
layout(set = 0, binding = 17) uniform samplerCube native_cubes[3]; // specular, irradiance, box; the page is the index

texel_acc native_texel_add(texel_acc acc, cube_desc cube, real3 d, real lod, real weight)
{
    vec4 value = textureLod(native_cubes[cube.texels], d, lod) * weight;
    return texel_acc(acc.left + value, acc.right);
}
real3 native_sample(cube_desc cube, real3 d, real lod) { return textureLod(native_cubes[cube.texels], d, lod).xyz; }
real3 native_sample_level(cube_desc cube, real3 d, int level) { return textureLod(native_cubes[cube.texels], d, float(level)).xyz; }
// What follows, kernels included, fetches natively.
#define cube_texel_add native_texel_add
#define cube_sample native_sample
#define cube_sample_level native_sample_level
#endif

#endif
