// Uniforms of the lean stages: the frame and the drawn material. raster/vulkan/lab/lean.cpp fills them, in vec4s, which std140
// and C++ lay out alike. The lean stages draw the same picture as forward.frag, written as in an engine: GLSL's own
// functions, native samplers, folded material constants, no code for unused features. `burnish race` times them. They share
// no text with the kernels.
#ifndef BN_LEAN_FRAME_GLSL
#define BN_LEAN_FRAME_GLSL

layout(std140, set = 0, binding = 0) uniform LeanFrame
{
    mat4 clip_from_world; // Vulkan clip space: y down, reversed depth
    vec4 eye; // w 1: perspective, position; w 0: direction to the eye, the same everywhere
    vec4 sky_x, sky_y; // the ray through (x, y) in [-1,1], y up, is x sky_x + y sky_y + sky_z
    vec4 sky_z; // w: scale of the sky's texels; 0: black
    vec4 scale; // scales of specular, irradiance and box texels; last level of the specular cube
    vec4 axis; // major_axis: k, beta; grid: half of log2 of the box texels per sample's share of the sphere; picture width, px
    vec4 tables; // scale and offset to texel centres: table for round lobes, table for two widths
}
frame;

layout(push_constant) uniform LeanPass { int first_row; } pass; // of the band

#endif
