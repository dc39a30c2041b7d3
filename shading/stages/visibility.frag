// Triangle id and depth of one sample. Depth equals the tile renderer's: a double at the corner of an 8x8 block, floats
// from there. Without BN_EXACT_DEPTH the rasterizer interpolates depth.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/lang/interface.glsl"
#ifdef BN_EXACT_DEPTH
#include "shading/kernels/depth_plane.k.h"
#endif
#include "shading/surface/material.t.h"
#include "shading/surface/parallax.t.h"
#include "shading/surface/visible_point.t.h"
#include "shading/stages/pass.glsl"
#include "shading/stages/peel.glsl"

layout(location = 0) flat in int slot;
layout(location = 0) out vec2 id; // lower and upper 16 bits: integer targets support fewer samples than float targets

#ifdef BN_EXACT_DEPTH
// Returns the depth of sample s in pixel (px, py).
real depth_at(int px, int py, int s)
{
    int x0 = setups[slot].x[0], y0 = setups[slot].y[0];
    real z0 = setups[slot].z[0];
    // Depth slopes along x and y, in double precision
    any_wide first = to_wide(z0);
    any_wide z10 = to_wide(setups[slot].z[1]) - first;
    any_wide z20 = to_wide(setups[slot].z[2]) - first;
    any_wide right = to_wide(0);
    any_wide down = to_wide(0);
    depth_slopes(to_wide(setups[slot].x[1] - x0), to_wide(setups[slot].y[1] - y0), to_wide(setups[slot].x[2] - x0),
                 to_wide(setups[slot].y[2] - y0), z10, z20, right, down);
    real dz_x = float(depth_slope_by_pixel(right));
    real dz_y = float(depth_slope_by_pixel(down));
    // Depth at the block's corner, then at the pixel
    int from_x = ((px & ~7) << 8) - frame.center_x - x0, from_y = ((py & ~7) << 8) - frame.center_y - y0;
    real corner = float(depth_at(first, right, down, to_wide(from_x), to_wide(from_y)));
    real z = corner + depth_change(dz_x, dz_y, to_real(px & 7), to_real(py & 7));
    // Depth at the sample, clamped to the triangle's range
    real sample_x = to_real(frame.pattern.x[s]) * lit(0.00390625);
    real sample_y = to_real(frame.pattern.y[s]) * lit(0.00390625);
    real z1 = setups[slot].z[1];
    real z2 = setups[slot].z[2];
    return depth_at_sample(z, depth_change(dz_x, dz_y, sample_x, sample_y), min(z2, min(z0, z1)), max(z2, max(z0, z1)));
}
#endif

// Returns false where an alpha-tested surface has a hole in this pixel.
bool survives_alpha(int m, int px, int py)
{
    if (materials[m].alpha_mode == kAlpha_opaque)
        return true;
    triangle_setup t = load_setup(slot);
    visible_point p = point_of(0, view_params_of(frame.view), t, px, py, (1 << frame.msaa) - 1, materials[m].uses_color != 0,
                               materials[m].textured != 0, false, false);
    if (materials[m].parallax != 0)
        apply_parallax(0, m, parallax_plane_of(0, t), p);
    real alpha = fetch_alpha(0, m, p);
    return alpha_stays(m, alpha, lit(0.5));
}

// Returns true where a blended surface at depth z lies behind the last layer and in front of solid surfaces. Of equal
// depths, the surface drawn first lies in front.
bool in_next_layer(int px, int py, int s, real z)
{
    int at = (((py - pass.first_row) * frame.width + px) * frame.msaa + s) * kGpuPeelWords;
    real last = peel[at + kPeelDepth];
    return z >= peel[at + kPeelSolidDepth] && (z < last || (z == last && slot > floatBitsToInt(peel[at + kPeelId])));
}

void main()
{
    int px = int(gl_FragCoord.x), py = int(gl_FragCoord.y) + pass.first_row;
    int s = pass.sample_number >= 0 ? pass.sample_number : gl_SampleID;
    int m = setups[slot].info >> 2;
    bool blended = materials[m].alpha_mode == kAlpha_blend;
    // Keep only the surfaces of this pass
    if (pass.surfaces != kGpuAll && blended != (pass.surfaces == kGpuLayer))
        discard;
    if (pass.surfaces != kGpuLayer && !survives_alpha(m, px, py))
        discard;
// Find the depth, and keep only the next blended layer
#ifdef BN_EXACT_DEPTH
    real z = depth_at(px, py, s);
    gl_FragDepth = z;
#else
    real z = gl_FragCoord.z;
#endif
    if (pass.surfaces == kGpuLayer && !in_next_layer(px, py, s, z))
        discard;
    id = vec2(float(slot & 0xffff), float(slot >> 16));
}
