#version 460
#extension GL_GOOGLE_include_directive : require
#include "shading/lab/lean/frame.glsl"

layout(location = 0) out vec3 ray;

void main()
{
    vec2 at = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
    ray = frame.sky_x.xyz * at.x - frame.sky_y.xyz * at.y + frame.sky_z.xyz;
    gl_Position = vec4(at, 0.0, 1.0);
}
