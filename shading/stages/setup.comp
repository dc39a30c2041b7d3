// Turns triangles into setups, in draw order, in two phases with a prefix sum between. The first counts each triangle's
// setups (0, 1, or the pieces left by clipping). The second writes them. The phase is pass.group, so drivers compile one.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#define BN_SETUP_ACCESS writeonly
#include "shading/lang/interface.glsl"
#include "shading/kernels/clip.t.h"
#include "shading/kernels/pixel_range.k.h"
#include "shading/stages/pass.glsl"

layout(std430, set = 0, binding = 9) buffer BnCounts { int counts[]; }; // setups by triangle; after the scan, the first setup

// Returns the sign of the triangle's area. Its two products need 47 bits each.
int area_sign(ivec3 x, ivec3 y)
{
    int high0, high1, low0, low1;
    imulExtended(x.y - x.x, y.z - y.x, high0, low0);
    imulExtended(x.z - x.x, y.y - y.x, high1, low1);
    if (high0 != high1)
        return high0 > high1 ? 1 : -1;
    return low0 == low1 ? 0 : uint(low0) > uint(low1) ? 1 : -1;
}

// Returns true where the range of v touches a sample along one axis of the picture.
bool touches(ivec3 v, int center, int sample_min, int sample_max, int size)
{
    int lo = min(v.x, min(v.y, v.z)), hi = max(v.x, max(v.y, v.z));
    pixel_range r = pixels_touched(lo, hi, center, sample_min, sample_max, size);
    return r.first <= r.last;
}

// Writes setup `at` in the writing phase. Returns the number of setups, 0 or 1.
int emit(int triangle, ivec3 x, ivec3 y, vec3 inv_w, vec3 z, mat3 bary, int clipped, int at)
{
    // Cull triangles that face away, have no area or touch no sample
    int area = area_sign(x, y);
    int material = bn_ints[places.material_base + triangle];
    bool front = area < 0; // counter-clockwise with y up
    if (materials[material].hidden != 0 || area == 0 || (!front && materials[material].double_sided == 0))
        return 0;
    if (!touches(x, frame.center_x, frame.pattern.min_x, frame.pattern.max_x, frame.width) ||
        !touches(y, frame.center_y, frame.pattern.min_y, frame.pattern.max_y, frame.height))
        return 0;
    if (pass.group == 0 || at >= places.setup_capacity)
        return 1;
    // Write the corners, turned so that the area is positive with y down
    for (int j = 0; j < 3; ++j) {
        int o = turned_corner(front, j);
        setups[at].x[j] = x[o];
        setups[at].y[j] = y[o];
        setups[at].inv_w[j] = inv_w[o];
        setups[at].z[j] = z[o];
        setups[at].vertex[j] = bn_ints[places.index_base + 3 * triangle + (clipped != 0 ? j : o)];
        for (int k = 0; k < 3; ++k)
            setups[at].bary[3 * j + k] = bary[o][k];
    }
    setups[at].info = material << 2 | (front ? kFrontFacing : 0) | clipped;
    setups[at].triangle = triangle;
    return 1;
}

// Clips a triangle. Returns the remaining polygon's visible side, see seen_side().
int clip_triangle(ivec3 v, inout clip_polygon polygon)
{
    // Set up the corners; those inside keep their snapped place
    for (int i = 0; i < 3; ++i) {
        vec3 place = vertex_position(v[i]);
        set_corner(0, polygon, i, place.x, place.y, place.z);
        if (vertices[v[i]].x != kNeedsClip)
            place_corner(polygon, i, vertices[v[i]].x, vertices[v[i]].y, vertices[v[i]].inv_w, vertices[v[i]].z);
    }
    clip_triangle_to_frame(0, polygon);
    return seen_side(polygon);
}

void main()
{
    int triangle = linear_invocation();
    if (triangle >= places.triangle_count)
        return;
    // Load the snapped corners
    ivec3 v, x, y;
    vec3 inv_w, z;
    mat3 bary = mat3(1.0);
    for (int i = 0; i < 3; ++i) {
        v[i] = bn_ints[places.index_base + 3 * triangle + i];
        x[i] = vertices[v[i]].x;
        y[i] = vertices[v[i]].y;
        inv_w[i] = vertices[v[i]].inv_w;
        z[i] = vertices[v[i]].z;
    }
    // Clip the triangle
    clip_polygon polygon;
    polygon.count = 3;
    bool clips = x[0] == kNeedsClip || x[1] == kNeedsClip || x[2] == kNeedsClip;
    int side = 0;
    if (clips)
        side = clip_triangle(v, polygon);
    // Emit it, or a fan of pieces
    int at = pass.group == 0 ? 0 : counts[triangle], count = 0;
    for (int piece = 1; piece + 1 < polygon.count; ++piece) {
        if (clips) {
            for (int i = 0; i < 3; ++i) {
                clip_corner c = polygon.corner[i == 0 ? 0 : piece + i - 1];
                x[i] = c.x;
                y[i] = c.y;
                inv_w[i] = c.inv_w;
                z[i] = c.z;
                bary[i] = vec3(float(c.bary[0]), float(c.bary[1]), float(c.bary[2]));
            }
            // Drop pieces that snapping has turned around
            if (side == 0 || area_sign(x, y) != -side)
                continue;
        }
        count += emit(triangle, x, y, inv_w, z, bary, clips ? kClipped : 0, at + count);
    }
    if (pass.group == 0)
        counts[triangle] = count;
}
