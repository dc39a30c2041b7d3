// The environment behind the scene.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/lang/interface.glsl"
#include "shading/lights/background.t.h"
#include "shading/stages/pass.glsl"

layout(location = 0) out vec4 radiance;

void main()
{
    radiance = vec4(background_color(0, view_params_of(frame.view), int(gl_FragCoord.x), int(gl_FragCoord.y) + pass.first_row), 1.0);
}
