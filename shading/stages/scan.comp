// Computes the exclusive prefix sum of setups by triangle, and the draw command for all setups. One workgroup.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#include "shading/lang/interface.glsl"

layout(std430, set = 0, binding = 9) buffer BnCounts { int counts[]; };
layout(std430, set = 0, binding = 10) writeonly buffer BnDraw { GpuDraw draw; };

shared int sums[kGpuGroup];

void main()
{
    // Sum this invocation's range of triangles
    int me = int(gl_LocalInvocationID.x), each = (places.triangle_count + kGpuGroup - 1) / kGpuGroup;
    int begin = min(me * each, places.triangle_count), end = min(begin + each, places.triangle_count);
    int sum = 0;
    for (int i = begin; i < end; ++i)
        sum += counts[i];
    sums[me] = sum;
    barrier();
    // Add the sums of all ranges before this one
    int before = 0;
    for (int i = 0; i < me; ++i)
        before += sums[i];
    // Replace the counts by prefix sums
    for (int i = begin; i < end; ++i) {
        int count = counts[i];
        counts[i] = before;
        before += count;
    }
    if (me == kGpuGroup - 1)
        draw = GpuDraw(3 * min(before, places.setup_capacity), 1, 0, 0, before, 0, 0);
}
