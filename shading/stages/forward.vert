// Vertices of the forward pipeline: one draw per primitive, attributes fetched by index. With BN_STAGES the draw is not
// indexed, so that the vertex number gives the triangle.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/lang/interface.glsl"
#include "shading/kernels/camera.t.h"

layout(location = 0) out vec3 normal;
layout(location = 1) out vec4 tangent;
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 color;
layout(location = 4) out vec4 position; // and 1
#ifdef BN_STAGES
layout(location = 5) flat out int triangle;
#endif
invariant gl_Position;

void main()
{
#ifdef BN_STAGES
    triangle = gl_VertexIndex / 3;
    int v = bn_ints[places.index_base + gl_VertexIndex];
#else
    int v = gl_VertexIndex;
#endif
    int at = places.shading_base + 16 * v;
    real3 place = vertex_position(v);
    position = vec4(place, 1.0);
    normal = vec3(bn_reals[at], bn_reals[at + 1], bn_reals[at + 2]);
    tangent = vec4(bn_reals[at + 3], bn_reals[at + 4], bn_reals[at + 5], bn_reals[at + 6]);
    uv = vec4(bn_reals[at + 8], bn_reals[at + 9], bn_reals[at + 10], bn_reals[at + 11]);
    color = vec4(bn_reals[at + 12], bn_reals[at + 13], bn_reals[at + 14], bn_reals[at + 15]);
    view_params view = view_params_of(frame.view);
    real4 clip = clip_position(place, view); // x, y, w, z
    // Move the position onto the sub-pixel grid, so that the device interpolates attributes between the rasterized
    // positions.
    snapped_vertex s = snap_to_frame(0, clip, view, kWholeBand);
    if (s.valid) {
        real x = to_real(s.x + frame.center_x) * lit(0.00390625) / frame.half_width - lit(1.0);
        real y = lit(1.0) - to_real(s.y + frame.center_y) * lit(0.00390625) / frame.half_height;
        clip.x = x * clip.z;
        clip.y = y * clip.z;
    }
    gl_Position = vec4(clip.x, -clip.y, clip.w, clip.z);
}
