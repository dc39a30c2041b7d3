// Shades one pixel: each distinct triangle among its samples once, in order of first appearance. Then resolves the samples.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#include "shading/lang/interface.glsl"
#include "shading/lights/background.t.h"
#include "shading/lights/fragment_light.t.h"
#include "shading/surface/parallax.t.h"
#include "shading/surface/specular_aa.t.h"
#include "shading/surface/visible_point.t.h"
#include "shading/stages/pass.glsl"
#include "shading/stages/records.glsl"
#include "shading/surface/layers.t.h"

layout(std430, set = 0, binding = 11) readonly buffer BnIds { int ids[]; };
layout(std430, set = 0, binding = 13) writeonly buffer BnColor { float colors[]; };
layout(constant_id = 3) const bool kShares = false; // some materials share samples: share.comp makes the colours

#include "shading/stages/shared_samples.glsl"

// Shades one (pixel, triangle) pair and records its words. pixel: index in the band; pair: index of the pair's first
// sample.
shared_sample_record shade_pair(int slot, int px, int py, int covered, int pixel, int pair)
{
    if (recorded(kGpuRecordStages))
        records[stages_at(pair)] = covered;
    bool central = recorded(kGpuRecordLayers) && (covered >> frame.layer_sample & 1) != 0;
    // Shade the background where no triangle is visible
    if (slot == kGpuNoTriangle) {
        for (int i = 0; central && i < kLayerWords; ++i)
            records[layers_at(pixel) + i] = 0;
        return unshared_record(background_color(0, view_params_of(frame.view), px, py));
    }
    // Find the visible point and its material
    triangle_setup t = load_setup(slot);
    int m = t.info >> 2;
    bool uses_color = materials[m].uses_color != 0, textured = materials[m].textured != 0, lights = frame.positions != 0;
    visible_point p = point_of(0, view_params_of(frame.view), t, px, py, covered, uses_color, textured, lights, wants_bends(0, m));
    if (materials[m].parallax != 0)
        apply_parallax(0, m, parallax_plane_of(0, t), p);
    material_inputs at = fetch_material(0, m, p);
    // Record stages and layers
    if (recorded(kGpuRecordStages)) {
        int w = stages_at(pair) + 1;
        record_point(w, p, uses_color, textured, lights);
        record_material(w, at);
    }
    if (central) {
        int w = layers_at(pixel);
        record_layers(w, layers_of(0, m, at, p));
    }
    // Shade the point
    bool shares = kShares && (materials[m].technique_traits & kSharesSamples) != 0;
    return light_of_fragment(0, m, materials[m].technique, at, lobe_shape_at(0, m, at, p), p, px, py, shares);
}

void main()
{
    int pixel = linear_invocation();
    if (pixel >= frame.width * pass.rows)
        return;
    int px = pixel % frame.width, py = pixel / frame.width + pass.first_row, first = pixel * frame.msaa;
    real inv = lit(1.0) / to_real(frame.msaa);
    int rest = (1 << frame.msaa) - 1;
    real3 sum = vec3_all(lit(0.0));
    // Shade each distinct triangle among the samples
    while (rest != 0) {
        // Collect the samples of the next triangle
        int begin = findLSB(rest), slot = ids[first + begin], covered = 0;
        for (int s = begin; s < frame.msaa; ++s)
            if ((rest >> s & 1) != 0 && ids[first + s] == slot)
                covered |= 1 << s;
        rest &= ~covered;
        // Shade the triangle, and weight its colour by the covered share
        shared_sample_record shaded = shade_pair(slot, px, py, covered, pixel, first + begin);
        real3 color = shaded.rest;
        if (kShares)
            store_shared_sample(first + begin, shaded);
        else if (kRecords != 0)
            record_color(first + begin, color);
        real weight = covered_share(covered, inv);
        sum = sum + color * weight;
    }
    if (kShares)
        return;
    // Write the pixel
    colors[3 * pixel] = sum.x;
    colors[3 * pixel + 1] = sum.y;
    colors[3 * pixel + 2] = sum.z;
}
