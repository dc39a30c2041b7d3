// Copies the ids and depths of one pass from images to buffers, [pixel of the band][sample].
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#include "shading/lang/interface.glsl"
#include "shading/stages/pass.glsl"

layout(std430, set = 0, binding = 11) writeonly buffer BnIds { int ids[]; };
layout(std430, set = 0, binding = 12) writeonly buffer BnDepths { float depths[]; };
#ifdef BN_MULTISAMPLED
layout(set = 0, binding = 18) uniform sampler2DMS id_image;
layout(set = 0, binding = 19) uniform sampler2DMS depth_image;
#else
layout(set = 0, binding = 18) uniform sampler2D id_image;
layout(set = 0, binding = 19) uniform sampler2D depth_image;
#endif

void copy_sample(int pixel, ivec2 at, int from, int to)
{
    vec2 id = texelFetch(id_image, at, from).xy; // -1 where nothing was hit
    ids[pixel * frame.msaa + to] = id.x < 0.0 ? kGpuNoTriangle : int(id.x) | int(id.y) << 16;
    depths[pixel * frame.msaa + to] = texelFetch(depth_image, at, from).x;
}

void main()
{
    int pixel = linear_invocation();
    if (pixel >= frame.width * pass.rows)
        return;
    ivec2 at = ivec2(pixel % frame.width, pixel / frame.width);
#ifdef BN_MULTISAMPLED
    for (int s = 0; s < frame.msaa; ++s)
        copy_sample(pixel, at, s, s);
#else
    copy_sample(pixel, at, 0, pass.sample_number);
#endif
}
