// The environment as the stages fetch it: by the filter kernel from buffers, or with BN_NATIVE_SAMPLER by the device's samplers.
#ifndef BN_ENVIRONMENT_GLSL
#define BN_ENVIRONMENT_GLSL

#include "shading/stages/interface.glsl"
#include "shading/kernels/cube_filter.k.h"


#ifdef BN_NATIVE_SAMPLER
layout(set = 1, binding = 0) uniform samplerCube native_cubes[kGpuCubes]; // specular, irradiance, box; the page is the index

cube_desc specular_cube() { return cube_desc(0, frame.specular.size, frame.specular.levels); }
cube_desc irradiance_cube() { return cube_desc(1, frame.irradiance.size, frame.irradiance.levels); }
cube_desc box_cube() { return cube_desc(2, frame.box.size, frame.box.levels); }

// Not every device indexes samplers by a variable.
vec4 native_fetch(cube_desc cube, vec3 d, float lod)
{
    if (cube.texels == 0)
        return textureLod(native_cubes[0], d, lod);
    if (cube.texels == 1)
        return textureLod(native_cubes[1], d, lod);
    return textureLod(native_cubes[2], d, lod);
}
texel_acc native_texel_add(texel_acc acc, cube_desc cube, real3 d, real lod, real weight)
{
    real4 value = native_fetch(cube, d, lod) * weight;
    real4 left = acc.left + value;
    return texel_acc(left, acc.right);
}
real3 native_sample(cube_desc cube, real3 d, real lod) { return native_fetch(cube, d, lod).xyz; }
real3 native_sample_level(cube_desc cube, real3 d, int level) { return native_fetch(cube, d, float(level)).xyz; }
// What follows, kernels included, fetches natively.
#define cube_texel_add native_texel_add
#define cube_sample native_sample
#define cube_sample_level native_sample_level
#else
cube_desc cube_of(GpuCube c) { return cube_desc(c.page, c.size, c.levels); }
cube_desc specular_cube() { return cube_of(frame.specular); }
cube_desc irradiance_cube() { return cube_of(frame.irradiance); }
cube_desc box_cube() { return cube_of(frame.box); }
#endif

#endif
