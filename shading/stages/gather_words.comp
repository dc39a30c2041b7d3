// Copies four recorded words per sample, as the forward pipeline writes them, from an image to a buffer.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#include "shading/lang/interface.glsl"
#include "shading/stages/pass.glsl"

layout(std430, set = 0, binding = 14) writeonly buffer BnWords { vec4 words[]; }; // [pixel of the band][sample][group - 1]
#ifdef BN_MULTISAMPLED
layout(set = 0, binding = 18) uniform sampler2DMS image;
#else
layout(set = 0, binding = 18) uniform sampler2D image;
#endif

void main()
{
    int pixel = linear_invocation();
    if (pixel >= frame.width * pass.rows)
        return;
    ivec2 at = ivec2(pixel % frame.width, pixel / frame.width);
    for (int s = 0; s < frame.msaa; ++s)
        words[(pixel * frame.msaa + s) * kGpuForwardGroups + pass.group - 1] = texelFetch(image, at, s);
}
