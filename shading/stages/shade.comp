// One pixel: shades each distinct triangle among its samples once, in the order of first appearance, and resolves.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#include "shading/stages/shade.glsl"

layout(constant_id = 4) const bool kRecords = false; // writes the stages of each pair, for comparisons

layout(std430, set = 0, binding = 11) readonly buffer BnIds { int ids[]; };
layout(std430, set = 0, binding = 13) writeonly buffer BnColor { float colors[]; };
layout(std430, set = 0, binding = 14) writeonly buffer BnRecords { int records[]; }; // [pixel][first sample][kGpuPairWords]

int record_at;

void put(int word)
{
    records[record_at] = word;
    ++record_at;
}
void put_real(real x) { put(floatBitsToInt(x)); }
void put2(real2 v)
{
    put_real(v.x);
    put_real(v.y);
}
void put3(real3 v)
{
    put2(v.xy);
    put_real(v.z);
}

void record_point(visible_point p)
{
    put3(p.normal);
    put3(p.tangent);
    put_real(p.tangent_sign);
    put2(p.color.xy);
    put2(p.color.zw);
    for (int i = 0; i < 2; ++i) {
        put2(p.uv[i]);
        put2(p.uv_dx[i]);
        put2(p.uv_dy[i]);
    }
    put(p.front ? 1 : 0);
    put3(p.ray);
    put3(p.position);
}

void record_material(material_inputs at)
{
    put3(at.base);
    put_real(at.alpha);
    put_real(at.metallic);
    put_real(at.roughness);
    put_real(at.occlusion);
    put3(at.normal_map);
    put3(at.emissive);
    put3(at.dielectric_f0);
    put_real(at.dielectric_f90);
    put3(at.tensor2);
    put3(at.tensor4);
}

real3 shade_pair(int slot, int px, int py, int covered)
{
    if (slot == kGpuNoTriangle) {
        record_at += kGpuInterpolantWords + kGpuMaterialWords;
        return shade_background(px, py);
    }
    triangle_setup t = load_setup(slot);
    visible_point p = point_of(t, px, py, covered);
    int m = t.info >> 2;
    material_inputs at = fetch_material(m, p);
    if (kRecords) {
        record_point(p);
        record_material(at);
    }
    return shade_point(m, at, p, py * frame.width + px);
}

void main()
{
    int pixel = linear_invocation();
    if (pixel >= frame.width * frame.height)
        return;
    int px = pixel % frame.width, py = pixel / frame.width, first = pixel * frame.msaa;
    real inv = lit(1.0) / to_real(frame.msaa);
    int rest = (1 << frame.msaa) - 1;
    real3 sum = vec3_all(lit(0.0));
    while (rest != 0) {
        int begin = findLSB(rest), slot = ids[first + begin], covered = 0;
        for (int s = begin; s < frame.msaa; ++s)
            if ((rest >> s & 1) != 0 && ids[first + s] == slot)
                covered |= 1 << s;
        rest &= ~covered;
        record_at = (first + begin) * kGpuPairWords;
        if (kRecords)
            put(covered);
        real3 color = shade_pair(slot, px, py, covered);
        if (kRecords)
            put3(color);
        real weight = to_real(bitCount(covered)) * inv;
        sum = sum + color * weight;
    }
    colors[3 * pixel] = sum.x;
    colors[3 * pixel + 1] = sum.y;
    colors[3 * pixel + 2] = sum.z;
}
