// Passes the snapped corners of setups to the rasterizer. Every operation here and in the viewport transform is exact.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/lang/interface.glsl"
#include "shading/stages/pass.glsl"

layout(location = 0) flat out int slot;

void main()
{
    slot = gl_VertexIndex / 3;
    int corner = gl_VertexIndex % 3;
    real x = to_real(setups[slot].x[corner] + pass.shift_x) * places.clip_unit;
    real y = to_real(setups[slot].y[corner] + pass.shift_y) * places.clip_unit;
    gl_Position = vec4(x, y, setups[slot].z[corner], 1.0);
}
