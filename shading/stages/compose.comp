// Composes blended surfaces over the solid ones, one pixel per invocation, in three phases. The first begins after the
// solid surfaces are shaded. The second puts a shaded layer behind the layers before it. The third writes the pixels that
// show layers.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#define BN_PEEL_ACCESS
#define BN_RECORDS_ACCESS readonly
#include "shading/lang/interface.glsl"
#include "shading/surface/material.t.h"
#include "shading/surface/parallax.t.h"
#include "shading/surface/visible_point.t.h"
#include "shading/stages/pass.glsl"
#include "shading/stages/peel.glsl"
#include "shading/stages/records.glsl"

layout(std430, set = 0, binding = 10) buffer BnDraw { GpuDraw draw; };
layout(std430, set = 0, binding = 11) readonly buffer BnIds { int ids[]; };
layout(std430, set = 0, binding = 12) readonly buffer BnDepths { float depths[]; };
layout(std430, set = 0, binding = 13) writeonly buffer BnColor { float colors[]; };
layout(constant_id = 5) const int kPhase = 0; // 0: begin, 1: a layer, 2: end

real3 color_of_pair(int pair)
{
    int at = color_at(pair);
    return vec3(intBitsToFloat(records[at]), intBitsToFloat(records[at + 1]), intBitsToFloat(records[at + 2]));
}

blended_light load_blended(int at)
{
    blended_light b;
    b.over = vec3(peel[at + kPeelOver], peel[at + kPeelOver + 1], peel[at + kPeelOver + 2]);
    b.through = peel[at + kPeelThrough];
    return b;
}
void store_blended(int at, blended_light b)
{
    peel[at + kPeelOver] = b.over.x;
    peel[at + kPeelOver + 1] = b.over.y;
    peel[at + kPeelOver + 2] = b.over.z;
    peel[at + kPeelThrough] = b.through;
}

// Starts a pixel's layers. first: index of the pixel's first sample.
void begin_layers(int first)
{
    for (int s = 0; s < frame.msaa; ++s) {
        // Take the colour of the sample's solid pair
        int at = (first + s) * kGpuPeelWords, pair = 0;
        while (ids[first + pair] != ids[first + s])
            ++pair;
        real3 color = color_of_pair(first + pair);
        for (int c = 0; c < 3; ++c)
            peel[at + kPeelBehind + c] = color[c];
        // Start in front of all surfaces, with nothing blended
        peel[at + kPeelSolidDepth] = depths[first + s];
        peel[at + kPeelSolidId] = intBitsToFloat(ids[first + s]);
        peel[at + kPeelDepth] = 2.0; // nearer than any surface
        peel[at + kPeelId] = intBitsToFloat(-1);
        store_blended(at, blended_none());
        if (s == 0)
            peel[at + kPeelShown] = 0.0;
    }
}

// Returns the alpha of a (pixel, triangle) pair.
real alpha_of_pair(int slot, int px, int py, int covered)
{
    triangle_setup t = load_setup(slot);
    int m = t.info >> 2;
    visible_point p = point_of(0, view_params_of(frame.view), t, px, py, covered, materials[m].uses_color != 0, materials[m].textured != 0,
                               frame.positions != 0, false);
    if (materials[m].parallax != 0)
        apply_parallax(0, m, parallax_plane_of(0, t), p);
    return fetch_alpha(0, m, p);
}

// Composes one layer of a pixel. Returns the number of its pairs.
int compose_layer(int first, int px, int py)
{
    int rest = (1 << frame.msaa) - 1, pairs = 0;
    while (rest != 0) {
        // Collect the samples of the next triangle
        int begin = findLSB(rest), slot = ids[first + begin], covered = 0;
        for (int s = begin; s < frame.msaa; ++s)
            if (ids[first + s] == slot)
                covered |= 1 << s;
        rest &= ~covered;
        // Fetch the pair's colour and alpha
        bool seen = slot != kGpuNoTriangle;
        real3 color = color_of_pair(first + begin);
        real alpha = lit(0.0);
        if (seen)
            alpha = alpha_of_pair(slot, px, py, covered);
        pairs += seen ? 1 : 0;
        // Blend the pair behind each covered sample
        for (int s = begin; s < frame.msaa; ++s)
            if ((covered >> s & 1) != 0) {
                int at = (first + s) * kGpuPeelWords;
                blended_light b = load_blended(at);
                if (seen)
                    b = blend_behind(b, color, alpha);
                store_blended(at, b);
                peel[at + kPeelDepth] = seen && b.through > lit(0.0) ? depths[first + s] : lit(-1.0);
                peel[at + kPeelId] = intBitsToFloat(slot);
            }
    }
    if (pairs > 0)
        peel[first * kGpuPeelWords + kPeelShown] = 1.0;
    return pairs;
}

// Blends each sample's layers over its solid colour, and resolves the pixel.
void end_layers(int first, int pixel)
{
    real3 sum = vec3_all(lit(0.0));
    for (int s = 0; s < frame.msaa; ++s) {
        int at = (first + s) * kGpuPeelWords;
        real3 behind = vec3(peel[at + kPeelBehind], peel[at + kPeelBehind + 1], peel[at + kPeelBehind + 2]);
        real3 color = blend_over(load_blended(at), behind);
        sum = sum + color;
    }
    real each = lit(1.0) / to_real(frame.msaa);
    real3 mean = sum * each;
    for (int c = 0; c < 3; ++c)
        colors[3 * pixel + c] = mean[c];
}

void main()
{
    int pixel = linear_invocation();
    if (pixel >= frame.width * pass.rows)
        return;
    int first = pixel * frame.msaa;
    if (kPhase == 0)
        begin_layers(first);
    if (kPhase == 1) {
        int pairs = compose_layer(first, pixel % frame.width, pixel / frame.width + pass.first_row);
        if (pairs > 0) {
            atomicAdd(draw.peeled, pairs);
            int row = pixel / frame.width;
            if (row >= pass.own_begin && row < pass.own_end)
                atomicAdd(draw.peeled_own, pairs);
        }
    }
    if (kPhase == 2 && peel[first * kGpuPeelWords + kPeelShown] != 0.0)
        end_layers(first, pixel);
}
