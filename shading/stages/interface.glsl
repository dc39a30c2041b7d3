// What all stages read: the frame and the scene. Bindings 0 to 2 belong to the kernel language.
#ifndef BN_INTERFACE_GLSL
#define BN_INTERFACE_GLSL

#define BN_TEXEL_PAGES
#include "shading/lang/lang.h"
#include "shading/lang/gpu_records.h"
#include "shading/kernels/vertex.k.h"

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
layout(std430, set = 0, binding = 7) BN_VERTEX_ACCESS buffer BnVertices { GpuVertex vertices[]; };
layout(std430, set = 0, binding = 8) BN_SETUP_ACCESS buffer BnSetups { GpuSetup setups[]; };

#ifdef BN_COMPUTE
int linear_invocation()
{
    return int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x);
}
#endif

view_params frame_view()
{
    view_params v;
    v.eye = vec3(frame.view.eye[0], frame.view.eye[1], frame.view.eye[2]);
    v.right = vec3(frame.view.right[0], frame.view.right[1], frame.view.right[2]);
    v.up = vec3(frame.view.up[0], frame.view.up[1], frame.view.up[2]);
    v.forward = vec3(frame.view.forward[0], frame.view.forward[1], frame.view.forward[2]);
    v.inv_tan_x = frame.view.inv_tan_x;
    v.inv_tan_y = frame.view.inv_tan_y;
    v.znear = frame.view.znear;
    v.zfar = frame.view.zfar;
    v.inv_depth = frame.view.inv_depth;
    v.orthographic = frame.view.orthographic != 0;
    return v;
}

real3 vertex_position(int v)
{
    return vec3(bn_reals[places.position_base[0] + v], bn_reals[places.position_base[1] + v], bn_reals[places.position_base[2] + v]);
}

snapped_vertex snap_to_frame(real4 clip, int guard)
{
    return snap_vertex(clip, frame_view(), frame.half_width, frame.half_height, to_real(frame.center_x), to_real(frame.center_y),
                       frame.center_x, frame.center_y, to_real(guard));
}

#endif
