// The classical pipeline's fragments: interpolated by the device, shaded once a fragment. With BN_STAGES four of a fragment's words, in
// place of its colour (kGpuForwardGroups).
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/stages/shade.glsl"
#include "shading/stages/pass.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) in vec4 tangent;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 color;
layout(location = 4) in vec3 position;
layout(location = 0) out vec4 radiance;
layout(constant_id = 6) const int kMsaa = 1;

#ifdef BN_STAGES
layout(constant_id = 7) const int kGroup = 0;
layout(location = 5) flat in int triangle;
int record_at = 4; // group 0 is the triangle

void put_real(real x)
{
    if (record_at / 4 == kGroup)
        radiance[record_at % 4] = x;
    ++record_at;
}
void put_int(int word) { put_real(to_real(word)); }
#include "shading/stages/record.glsl"
#endif

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

// Where the tile renderer shades, from the pixel's centre, pixels: there, or where the triangle covers only some of the pixel's samples, at
// their mean.
vec2 shaded_offset()
{
    if (kMsaa == 1 || gl_SampleMaskIn[0] == (1 << kMsaa) - 1)
        return vec2(0.0);
    ivec2 mean = mean_of_samples(gl_SampleMaskIn[0]) - 128;
    return vec2(mean) * 0.00390625;
}

#define BN_AT_POINT(v) (kMsaa == 1 ? v : interpolateAtOffset(v, offset))

visible_point point_of_fragment(int px, int py)
{
    vec2 offset = shaded_offset();
    visible_point p;
    p.normal = BN_AT_POINT(normal);
    vec4 t = BN_AT_POINT(tangent);
    p.tangent = t.xyz;
    p.tangent_sign = t.w < 0.0 ? -1.0 : 1.0;
    p.color = BN_AT_POINT(color);
    vec4 uv_at = BN_AT_POINT(uv);
    p.uv[0] = uv_at.xy;
    p.uv[1] = uv_at.zw;
    p.uv_dx[0] = dFdx(uv.xy);
    p.uv_dx[1] = dFdx(uv.zw);
    p.uv_dy[0] = dFdy(uv.xy);
    p.uv_dy[1] = dFdy(uv.zw);
    p.front = gl_FrontFacing;
    p.position = BN_AT_POINT(position);
    real x = to_real(px) + lit(0.5) + offset.x;
    real y = to_real(py) + lit(0.5) + offset.y;
    p.ray = pixel_ray(x, y, frame.half_width, frame.half_height, frame_view());
    return p;
}

void main()
{
    int m = pass.material, px = int(gl_FragCoord.x), py = int(gl_FragCoord.y) + pass.first_row;
    visible_point p = point_of_fragment(px, py);
    material_inputs at = fetch_material(m, p);
    int alive = alive_samples(m, at.alpha);
    if (alive == 0)
        discard;
    gl_SampleMask[0] = alive;
#ifdef BN_STAGES
    radiance = vec4(float(triangle & 0xffff), float(triangle >> 16), 0.0, 0.0);
    record_point(p);
    record_material(at);
#else
    radiance = vec4(shade_point(m, at, p, py * frame.width + px), 1.0);
#endif
}
