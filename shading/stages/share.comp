// Runs after shade.comp, one pixel per invocation: fragments average the samples of their 2x2 quad. Then resolves the
// pixel.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#include "shading/stages/interface.glsl"
#include "shading/stages/shared_samples.glsl"
#include "shading/stages/pass.glsl"
#include "shading/stages/records.glsl"
#include "shading/surface/coverage.t.h"

layout(std430, set = 0, binding = 11) readonly buffer BnIds { int ids[]; };
layout(std430, set = 0, binding = 13) writeonly buffer BnColor { float colors[]; };

// Returns the samples of the pair whose first sample is `begin`.
int samples_of_pair(int first, int begin)
{
    int covered = 0;
    for (int s = begin; s < frame.msaa; ++s)
        covered |= ids[first + s] == ids[first + begin] ? 1 << s : 0;
    return covered;
}

// Returns a pair's colour, averaged with the other pixels of its quad. x, y: pixel in the band.
real3 shared_colour(shared_sample_record own, int x, int y)
{
    real inv = lit(1.0) / to_real(frame.msaa);
    shared_sample_mean mean = shared_sample_mean_begin(own);
    // Visit the three other pixels of the quad
    for (int k = 1; k < 4; ++k) {
        int qx = x ^ (k & 1), qy = y ^ (k >> 1);
        if (qx >= frame.width || qy >= pass.rows)
            continue;
        int first = (qy * frame.width + qx) * frame.msaa, rest = (1 << frame.msaa) - 1;
        // Add each of that pixel's pairs, weighted by its covered share
        while (rest != 0) {
            int begin = findLSB(rest), covered = samples_of_pair(first, begin);
            rest &= ~covered;
            shared_sample_record r = load_shared_sample(first + begin);
            mean = shared_sample_mean_add(mean, own, r, covered_share(covered, inv), r.width >= 0.0);
        }
    }
    return shared_sample_mean_colour(mean, own);
}

void main()
{
    int pixel = linear_invocation();
    if (pixel >= frame.width * pass.rows)
        return;
    int x = pixel % frame.width, y = pixel / frame.width, first = pixel * frame.msaa; // pixel in the band, which begins at an even row
    real inv = lit(1.0) / to_real(frame.msaa);
    int rest = (1 << frame.msaa) - 1;
    real3 sum = vec3_all(lit(0.0));
    // Find the colour of each pair, and weight it by its covered share
    while (rest != 0) {
        int begin = findLSB(rest), covered = samples_of_pair(first, begin);
        rest &= ~covered;
        shared_sample_record own = load_shared_sample(first + begin);
        real3 color = own.rest;
        if (own.width >= 0.0)
            color = shared_colour(own, x, y);
        if (kRecords != 0)
            record_color(first + begin, color);
        real weight = covered_share(covered, inv);
        sum = sum + color * weight;
    }
    // Write the pixel
    colors[3 * pixel] = sum.x;
    colors[3 * pixel + 1] = sum.y;
    colors[3 * pixel + 2] = sum.z;
}
