// Triangles to setups, in draw order, in two phases with a prefix sum between them: how many setups each triangle gives (0, 1, or the
// pieces that clipping leaves), then the setups. The clipping is that of raster/tile/clip.cpp: Sutherland and Hodgman 1974 in homogeneous
// coordinates, each cut computed from the inside to the outside vertex.
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
#define BN_COMPUTE
#define BN_SETUP_ACCESS writeonly
#include "shading/stages/interface.glsl"
#include "shading/kernels/camera.t.h"

layout(constant_id = 0) const int kPhase = 0; // 0: count, 1: write
layout(std430, set = 0, binding = 9) buffer BnCounts { int counts[]; }; // by triangle: setups; after the prefix sum: the first of them

const int kPlanes = 5, kMaxCorners = 3 + kPlanes;

struct clip_corner {
    real4 c;    // clip space x, y, w, z
    real3 bary; // of the whole triangle
};
clip_corner polygon[kMaxCorners + 1];
clip_corner next[kMaxCorners + 1];

real plane_distance(real4 c, int p)
{
    real gx = to_real(kCutBand / kSubpixel) / frame.half_width;
    real gy = to_real(kCutBand / kSubpixel) / frame.half_height;
    real d = gy * c.z + c.y;
    if (p == 0) {
        real near_orthographic = 1.0 - c.w;
        real near_perspective = c.z - frame.view.znear;
        d = frame.view.orthographic != 0 ? near_orthographic : near_perspective;
    }
    if (p == 1)
        d = gx * c.z - c.x;
    if (p == 2)
        d = gx * c.z + c.x;
    if (p == 3)
        d = gy * c.z - c.y;
    return d;
}

clip_corner cut(clip_corner inside, clip_corner outside, real d_in, real d_out)
{
    real t = d_in / (d_in - d_out);
    clip_corner v;
    v.c = inside.c + t * (outside.c - inside.c);
    v.bary = inside.bary + t * (outside.bary - inside.bary);
    return v;
}

int clip_polygon(int n)
{
    for (int p = 0; p < kPlanes && n > 0; ++p) {
        int m = 0;
        for (int i = 0; i < n; ++i) {
            clip_corner a = polygon[i];
            clip_corner b = polygon[(i + 1) % n];
            real da = plane_distance(a.c, p);
            real db = plane_distance(b.c, p);
            if (da >= 0.0)
                next[m++] = a;
            if (da >= 0.0 && db < 0.0)
                next[m++] = cut(a, b, da, db);
            else if (da < 0.0 && db >= 0.0)
                next[m++] = cut(b, a, db, da);
        }
        n = m;
        for (int i = 0; i < n; ++i)
            polygon[i] = next[i];
    }
    return n;
}

// Sign of the area: its two products need 47 bits each.
int area_sign(ivec3 x, ivec3 y)
{
    int high0, high1, low0, low1;
    imulExtended(x.y - x.x, y.z - y.x, high0, low0);
    imulExtended(x.z - x.x, y.y - y.x, high1, low1);
    if (high0 != high1)
        return high0 > high1 ? 1 : -1;
    return low0 == low1 ? 0 : uint(low0) > uint(low1) ? 1 : -1;
}

bool touches(ivec3 v, int center, int sample_min, int sample_max, int size)
{
    int lo = min(v.x, min(v.y, v.z)), hi = max(v.x, max(v.y, v.z));
    int first = (lo + center - sample_max + 255) >> 8, last = (hi + center - sample_min) >> 8;
    return max(first, 0) <= min(last, size - 1);
}

// Writes setup `at` where this is the writing phase; returns how many it is: 0 or 1.
int emit(int triangle, ivec3 x, ivec3 y, vec3 inv_w, vec3 z, mat3 bary, int clipped, int at)
{
    int area = area_sign(x, y);
    int material = bn_ints[places.material_base + triangle];
    bool front = area < 0; // counter-clockwise with y up
    if (area == 0 || (!front && materials[material].double_sided == 0))
        return 0;
    if (!touches(x, frame.center_x, frame.pattern.min_x, frame.pattern.max_x, frame.width) ||
        !touches(y, frame.center_y, frame.pattern.min_y, frame.pattern.max_y, frame.height))
        return 0;
    if (kPhase == 0 || at >= places.setup_capacity)
        return 1;
    for (int j = 0; j < 3; ++j) {
        int o = front && j > 0 ? 3 - j : j; // a front face's second and third corner change places: the area becomes positive
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

int emit_piece(int triangle, int i1, int i2, int at)
{
    int corner[3] = int[3](0, i1, i2);
    ivec3 x, y;
    vec3 inv_w, z;
    mat3 bary;
    for (int i = 0; i < 3; ++i) {
        clip_corner c = polygon[corner[i]];
        // a cut may come out a rounding error behind the near plane
        if (frame.view.orthographic == 0 && !(c.c.z > frame.view.znear))
            c.c.z = frame.view.znear;
        if (frame.view.orthographic != 0 && c.c.w > 1.0)
            c.c.w = 1.0;
        snapped_vertex s = snap_to_frame(0, c.c, view_params_of(frame.view), kGuardBand);
        if (!s.valid)
            return 0; // numerically degenerate: nothing left of it
        x[i] = s.x;
        y[i] = s.y;
        inv_w[i] = s.inv_w;
        z[i] = s.z;
        bary[i] = c.bary;
    }
    return emit(triangle, x, y, inv_w, z, bary, kClipped, at);
}

int clip_triangle(int triangle, ivec3 v, int at)
{
    for (int i = 0; i < 3; ++i) {
        polygon[i].c = vec4(vertices[v[i]].clip[0], vertices[v[i]].clip[1], vertices[v[i]].clip[2], vertices[v[i]].clip[3]);
        polygon[i].bary = vec3(i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0);
    }
    int n = clip_polygon(3), count = 0;
    for (int i = 1; i + 1 < n; ++i)
        count += emit_piece(triangle, i, i + 1, at + count);
    return count;
}

void main()
{
    int triangle = linear_invocation();
    if (triangle >= places.triangle_count)
        return;
    ivec3 v, x, y;
    vec3 inv_w, z;
    for (int i = 0; i < 3; ++i) {
        v[i] = bn_ints[places.index_base + 3 * triangle + i];
        x[i] = vertices[v[i]].x;
        y[i] = vertices[v[i]].y;
        inv_w[i] = vertices[v[i]].inv_w;
        z[i] = vertices[v[i]].z;
    }
    int at = kPhase == 0 ? 0 : counts[triangle], count;
    if (x[0] == kNeedsClip || x[1] == kNeedsClip || x[2] == kNeedsClip)
        count = clip_triangle(triangle, v, at);
    else
        count = emit(triangle, x, y, inv_w, z, mat3(1.0), 0, at);
    if (kPhase == 0)
        counts[triangle] = count;
}
