#version 460
#extension GL_GOOGLE_include_directive : require
#include "shading/lab/lean/frame.glsl"

layout(set = 1, binding = 0) uniform samplerCube cubes[4]; // specular, irradiance, box, the whole sky
layout(location = 0) in vec3 ray;
layout(location = 0) out vec4 radiance;

void main() { radiance = vec4(textureLod(cubes[3], ray, 0.0).rgb * frame.sky_z.w, 1.0); }
