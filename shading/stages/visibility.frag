// Triangle id and depth of one sample. Depth is the tile renderer's own plane equation (raster/tile/raster.h): a double at the corner of an
// 8x8 block, floats from there; without BN_EXACT_DEPTH it is what the rasterizer interpolates.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/surface/material.t.h"
#include "shading/surface/visible_point.t.h"
#include "shading/stages/pass.glsl"

layout(location = 0) flat in int slot;
layout(location = 0) out vec2 id; // lower and upper 16 bits: integer targets have fewer samples than float ones

#ifdef BN_EXACT_DEPTH
real depth_at(int px, int py, int s)
{
    int x0 = setups[slot].x[0], y0 = setups[slot].y[0];
    precise double x10 = double(setups[slot].x[1] - x0);
    precise double y10 = double(setups[slot].y[1] - y0);
    precise double x20 = double(setups[slot].x[2] - x0);
    precise double y20 = double(setups[slot].y[2] - y0);
    precise double z0 = double(setups[slot].z[0]);
    precise double z10 = double(setups[slot].z[1]) - z0;
    precise double z20 = double(setups[slot].z[2]) - z0;
    precise double inv_area = 1.0lf / (x10 * y20 - x20 * y10);
    precise double zx = (z10 * y20 - z20 * y10) * inv_area; // by 1/256 pixel
    precise double zy = (x10 * z20 - x20 * z10) * inv_area;
    precise double zx_pixel = zx * 256.0lf;
    precise double zy_pixel = zy * 256.0lf;
    real dz_x = float(zx_pixel);
    real dz_y = float(zy_pixel);
    int from_x = ((px & ~7) << 8) - frame.center_x - x0, from_y = ((py & ~7) << 8) - frame.center_y - y0;
    precise double corner = z0 + zx * double(from_x) + zy * double(from_y);
    real z = float(corner) + (dz_x * to_real(px & 7) + dz_y * to_real(py & 7));
    real sample_z = dz_x * (to_real(frame.pattern.x[s]) * lit(0.00390625)) + dz_y * (to_real(frame.pattern.y[s]) * lit(0.00390625));
    real at_sample = z + sample_z;
    real a = setups[slot].z[0];
    real b = setups[slot].z[1];
    real c = setups[slot].z[2];
    real z_min = a < b ? a : b;
    real z_max = a > b ? a : b;
    z_min = c < z_min ? c : z_min;
    z_max = c > z_max ? c : z_max;
    return min(max(at_sample, z_min), z_max);
}
#endif

bool survives_alpha(int px, int py, int s)
{
    int m = setups[slot].info >> 2;
    if (materials[m].alpha_mode == kAlphaOpaque)
        return true;
    visible_point p = point_of(0, view_params_of(frame.view), load_setup(slot), px, py, (1 << frame.msaa) - 1, materials[m].uses_color != 0,
                               materials[m].textured != 0, false);
    real alpha = fetch_alpha(0, m, p);
    return alpha_stays(m, alpha, blend_threshold(s, frame.msaa));
}

void main()
{
    int px = int(gl_FragCoord.x), py = int(gl_FragCoord.y) + pass.first_row;
    int s = pass.sample_number >= 0 ? pass.sample_number : gl_SampleID;
    if (!survives_alpha(px, py, s))
        discard;
#ifdef BN_EXACT_DEPTH
    gl_FragDepth = depth_at(px, py, s);
#endif
    id = vec2(float(slot & 0xffff), float(slot >> 16));
}
