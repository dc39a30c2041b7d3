// What the lean stages read of a frame and of the drawn material; raster/vulkan/lean.cpp fills it, in vec4s, which std140 and C++ lay out
// alike. The lean stages draw what forward.frag draws as an engine would write it: GLSL's own functions, native samplers, numbers of the
// material folded beforehand, no code for what a scene does not use. `burnish race` times them. They share no text with the kernels.
#ifndef BN_LEAN_FRAME_GLSL
#define BN_LEAN_FRAME_GLSL

layout(std140, set = 0, binding = 0) uniform LeanFrame
{
    mat4 clip_from_world; // of Vulkan, y down, depth reversed
    vec4 eye;             // w 1: perspective; w 0: direction to the eye, of all points
    vec4 sky_x, sky_y;    // the ray through (x, y) in [-1,1], y up, is x sky_x + y sky_y + sky_z
    vec4 sky_z;           // w: scale of the sky's texels; 0: black
    vec4 scale;           // of specular, irradiance and box texels; last level of the specular cube
    vec4 axis;            // of major axes: k, beta. Of a grid: half of log2 of the box cube's texels a sample's share of the sphere. Width, px
    vec4 tables;          // scale and offset to texel centres: of the table of round lobes, of the one of two widths
}
frame;

layout(push_constant) uniform LeanPass { int first_row; } pass; // of the band

#endif
