// Runs after shade.comp, one pixel per invocation: fragments average the samples of the 3x3 pixels around them. Then
// resolves the pixel. The first and last rows of a band lack neighbours, so bands overlap.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#include "shading/lang/interface.glsl"
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

// Returns a pixel's shared record. pixel: in the band.
shared_pixel pixel_at(int pixel)
{
    real inv = lit(1.0) / to_real(frame.msaa);
    int first = pixel * frame.msaa, rest = (1 << frame.msaa) - 1;
    shared_pixel p = shared_pixel_begin();
    while (rest != 0) {
        int begin = findLSB(rest), covered = samples_of_pair(first, begin);
        rest &= ~covered;
        shared_sample_record r = load_shared_sample(first + begin);
        p = shared_pixel_add(p, r, r.width >= 0.0 ? covered_share(covered, inv) : lit(0.0));
    }
    return shared_pixel_end(p);
}

// Returns the mean light over the window of a pixel. x, y: pixel in the band.
real3 window_light(shared_sample_record own, int x, int y)
{
    shared_sample_mean mean = shared_sample_mean_begin(own);
    for (int k = 0; k < 9; ++k) {
        int dx = k % 3 - 1, dy = k / 3 - 1, wx = x + dx, wy = y + dy;
        if (k == 4 || wx < 0 || wy < 0 || wx >= frame.width || wy >= pass.rows)
            continue;
        shared_pixel other = pixel_at(wy * frame.width + wx);
        mean = shared_sample_mean_add(mean, own, other.record, other.cover, window_weight(dx, dy));
    }
    return shared_sample_mean_light(mean);
}

void main()
{
    int pixel = linear_invocation();
    if (pixel >= frame.width * pass.rows)
        return;
    int x = pixel % frame.width, y = pixel / frame.width, first = pixel * frame.msaa; // pixel in the band
    real inv = lit(1.0) / to_real(frame.msaa);
    int rest = (1 << frame.msaa) - 1;
    real3 sum = vec3_all(lit(0.0));
    // Average the window if the pixel shares samples
    shared_pixel own_pixel = pixel_at(pixel);
    real3 light = vec3_all(lit(0.0));
    if (own_pixel.cover > 0.0)
        light = window_light(own_pixel.record, x, y);
    // Find the colour of each pair, and weight it by its covered share
    while (rest != 0) {
        int begin = findLSB(rest), covered = samples_of_pair(first, begin);
        rest &= ~covered;
        shared_sample_record own = load_shared_sample(first + begin);
        real3 color = shared_sample_colour(own, light, own_pixel.record);
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
