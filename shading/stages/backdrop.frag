// The environment behind the scene.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/stages/backdrop.glsl"
#include "shading/stages/pass.glsl"

layout(location = 0) out vec4 radiance;

void main() { radiance = vec4(shade_background(int(gl_FragCoord.x), int(gl_FragCoord.y) + pass.first_row), 1.0); }
