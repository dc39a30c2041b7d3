// The classical pipeline's vertices: one draw a primitive, attributes fetched by index.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/stages/interface.glsl"
#include "shading/stages/pass.glsl"

layout(location = 0) centroid out vec3 normal;
layout(location = 1) centroid out vec4 tangent;
layout(location = 2) centroid out vec4 uv;
layout(location = 3) centroid out vec4 color;
layout(location = 4) centroid out vec3 position;

void main()
{
    int v = gl_VertexIndex, at = frame.shading_base + 16 * v;
    position = vertex_position(v);
    normal = vec3(bn_reals[at], bn_reals[at + 1], bn_reals[at + 2]);
    tangent = vec4(bn_reals[at + 3], bn_reals[at + 4], bn_reals[at + 5], bn_reals[at + 6]);
    uv = vec4(bn_reals[at + 8], bn_reals[at + 9], bn_reals[at + 10], bn_reals[at + 11]);
    color = vec4(bn_reals[at + 12], bn_reals[at + 13], bn_reals[at + 14], bn_reals[at + 15]);
    real4 clip = clip_position(position, frame_view()); // x, y, w, z
    gl_Position = vec4(clip.x, -clip.y, clip.w, clip.z);
}
