// Transforms vertices to clip space and to the sub-pixel grid.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#define BN_VERTEX_ACCESS writeonly
#include "shading/lang/interface.glsl"
#include "shading/kernels/camera.t.h"

void main()
{
    int v = linear_invocation();
    if (v >= places.vertex_count)
        return;
    view_params view = view_params_of(frame.view);
    real4 clip = clip_position(vertex_position(v), view);
    snapped_vertex s = snap_to_frame(0, clip, view, kWholeBand);
    vertices[v].clip = float[4](clip.x, clip.y, clip.z, clip.w);
    vertices[v].x = s.valid ? s.x : kNeedsClip;
    vertices[v].y = s.y;
    vertices[v].inv_w = s.inv_w;
    vertices[v].z = s.z;
}
