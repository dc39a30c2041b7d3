// The classical pipeline's fragments: interpolated by the device, shaded once a fragment.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/stages/shade.glsl"
#include "shading/stages/pass.glsl"

layout(location = 0) centroid in vec3 normal;
layout(location = 1) centroid in vec4 tangent;
layout(location = 2) centroid in vec4 uv;
layout(location = 3) centroid in vec4 color;
layout(location = 4) centroid in vec3 position;
layout(location = 0) out vec4 radiance;

// A mask discards the fragment; a blend becomes coverage: sample s of n stays where alpha > (s + 1/2) / n.
int alive_samples(int m, real alpha)
{
    int all = (1 << frame.msaa) - 1;
    if (materials[m].alpha_mode == 0)
        return all;
    if (materials[m].alpha_mode != 2)
        return alpha >= materials[m].alpha_cutoff ? all : 0;
    int alive = 0;
    for (int s = 0; s < frame.msaa; ++s) {
        real threshold = (to_real(s) + lit(0.5)) / to_real(frame.msaa);
        alive |= alpha > threshold ? 1 << s : 0;
    }
    return alive;
}

void main()
{
    int m = pass.material;
    visible_point p;
    p.normal = normal;
    p.tangent = tangent.xyz;
    p.tangent_sign = tangent.w < 0.0 ? -1.0 : 1.0;
    p.color = color;
    p.uv[0] = uv.xy;
    p.uv[1] = uv.zw;
    p.uv_dx[0] = dFdx(uv.xy);
    p.uv_dx[1] = dFdx(uv.zw);
    p.uv_dy[0] = dFdy(uv.xy);
    p.uv_dy[1] = dFdy(uv.zw);
    p.front = gl_FrontFacing;
    p.position = position;
    real3 forward = vec3(frame.forward[0], frame.forward[1], frame.forward[2]);
    real3 eye = vec3(frame.eye[0], frame.eye[1], frame.eye[2]);
    real3 from_eye = position - eye;
    p.ray = frame.orthographic != 0 ? forward : from_eye;
    material_inputs at = fetch_material(m, p);
    int alive = alive_samples(m, at.alpha);
    if (alive == 0)
        discard;
    gl_SampleMask[0] = alive;
    radiance = vec4(shade_point(m, at, p, int(gl_FragCoord.y) * frame.width + int(gl_FragCoord.x)), 1.0);
}
