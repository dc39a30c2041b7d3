#version 460
#extension GL_GOOGLE_include_directive : require
#include "shading/lab/lean/frame.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_color;
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec4 uv;
layout(location = 4) out vec4 color;

void main()
{
    position = in_position;
    normal = in_normal;
    tangent = in_tangent;
    uv = in_uv;
    color = in_color;
    gl_Position = frame.clip_from_world * vec4(in_position, 1.0);
}
