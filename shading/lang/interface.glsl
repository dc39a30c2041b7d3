// Buffers that all stages read: the frame and the scene. Bindings 0 to 2 belong to the kernel language. Every stage
// includes this file first, because it selects how the kernel language finds texels.
#ifndef BN_INTERFACE_GLSL
#define BN_INTERFACE_GLSL

#define BN_TEXEL_PAGES
#include "shading/lang/lang.h"
#include "shading/lang/gpu_records.h"

#ifndef BN_VERTEX_ACCESS
#define BN_VERTEX_ACCESS readonly
#endif
#ifndef BN_SETUP_ACCESS
#define BN_SETUP_ACCESS readonly
#endif

layout(std430, set = 0, binding = 3) readonly buffer BnFrame { FrameRecord frame; GpuPlaces places; };
layout(std430, set = 0, binding = 4) readonly buffer BnMaterials { MaterialRecord materials[]; };
layout(std430, set = 0, binding = 5) readonly buffer BnTextures { GpuTexture textures[]; };
layout(std430, set = 0, binding = 6) readonly buffer BnLights { LightRecord lights[]; };
layout(std430, set = 0, binding = 16) readonly buffer BnAreaLights { AreaLightRecord area_lights[]; };
layout(std430, set = 0, binding = 7) BN_VERTEX_ACCESS buffer BnVertices { GpuVertex vertices[]; };
layout(std430, set = 0, binding = 8) BN_SETUP_ACCESS buffer BnSetups { GpuSetup setups[]; };

#ifdef BN_COMPUTE
int linear_invocation()
{
    return int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x);
}
#endif

real3 vertex_position(int v)
{
    return vec3(bn_reals[places.position_base[0] + v], bn_reals[places.position_base[1] + v], bn_reals[places.position_base[2] + v]);
}

#endif
