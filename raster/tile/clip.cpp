// Clipping of the rare triangle that crosses the near plane or leaves the guard band. Sutherland and Hodgman 1974, in
// homogeneous coordinates. Every cut is computed from the inside to the outside vertex, so two triangles that share an edge get
// the same cut whatever their order, and no crack opens.
#include "raster/tile/tile_types.h"
#include "shading/kernels/camera.t.h"

namespace burnish {

namespace {

struct ClipVertex {
    float c[4];    // clip space x, y, w, z
    float bary[3]; // of the whole triangle
};
inline constexpr int kPlanes = 5;
inline constexpr int kMaxVertices = 3 + kPlanes;

// Signed distance to plane p; inside is >= 0. 0: near; 1..4: guard band, where the snapped position would leave its range.
float plane_distance(const FrameParams& f, const ClipVertex& v, int p)
{
    const float gx = static_cast<float>(kCutBand / kSubpixel) / f.half_width;
    const float gy = static_cast<float>(kCutBand / kSubpixel) / f.half_height;
    switch (p) {
    case 0:
        return f.view.orthographic ? 1.0f - v.c[3] : v.c[2] - f.view.znear;
    case 1:
        return gx * v.c[2] - v.c[0];
    case 2:
        return gx * v.c[2] + v.c[0];
    case 3:
        return gy * v.c[2] - v.c[1];
    default:
        return gy * v.c[2] + v.c[1];
    }
}

ClipVertex cut(const ClipVertex& inside, const ClipVertex& outside, float d_in, float d_out)
{
    const float t = d_in / (d_in - d_out);
    ClipVertex v;
    for (int i = 0; i < 4; ++i)
        v.c[i] = inside.c[i] + t * (outside.c[i] - inside.c[i]);
    for (int i = 0; i < 3; ++i)
        v.bary[i] = inside.bary[i] + t * (outside.bary[i] - inside.bary[i]);
    return v;
}

int clip_polygon(const FrameParams& f, ClipVertex* polygon, int n)
{
    ClipVertex next[kMaxVertices + 1];
    for (int p = 0; p < kPlanes && n > 0; ++p) {
        int m = 0;
        for (int i = 0; i < n; ++i) {
            const ClipVertex& a = polygon[i];
            const ClipVertex& b = polygon[(i + 1) % n];
            const float da = plane_distance(f, a, p), db = plane_distance(f, b, p);
            if (da >= 0.0f)
                next[m++] = a;
            if (da >= 0.0f && db < 0.0f)
                next[m++] = cut(a, b, da, db);
            else if (da < 0.0f && db >= 0.0f)
                next[m++] = cut(b, a, db, da);
        }
        n = m;
        for (int i = 0; i < n; ++i)
            polygon[i] = next[i];
    }
    return n;
}

std::int32_t floor_div(std::int32_t a, std::int32_t b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

// Corners of the rectangle of tiles that the bounding box can touch, as in ChunkOutput; false where it touches no sample.
bool tile_rect(const FrameParams& f, const TriangleSetup& t, std::uint32_t corners[2])
{
    std::int32_t lo[2] = {t.x[0], t.y[0]}, hi[2] = {t.x[0], t.y[0]};
    for (int i = 1; i < 3; ++i) {
        lo[0] = t.x[i] < lo[0] ? t.x[i] : lo[0], hi[0] = t.x[i] > hi[0] ? t.x[i] : hi[0];
        lo[1] = t.y[i] < lo[1] ? t.y[i] : lo[1], hi[1] = t.y[i] > hi[1] ? t.y[i] : hi[1];
    }
    std::int32_t x0 = -floor_div(-(lo[0] + f.center_x - f.pattern.max_x), kSubpixel);
    std::int32_t x1 = floor_div(hi[0] + f.center_x - f.pattern.min_x, kSubpixel);
    std::int32_t y0 = -floor_div(-(lo[1] + f.center_y - f.pattern.max_y), kSubpixel);
    std::int32_t y1 = floor_div(hi[1] + f.center_y - f.pattern.min_y, kSubpixel);
    x0 = x0 > 0 ? x0 : 0, y0 = y0 > 0 ? y0 : 0;
    x1 = x1 < f.width ? x1 : f.width - 1, y1 = y1 < f.height ? y1 : f.height - 1;
    if (x0 > x1 || y0 > y1)
        return false;
    corners[0] = static_cast<std::uint32_t>(x0 / f.tile_size | y0 / f.tile_size << 16);
    corners[1] = static_cast<std::uint32_t>(x1 / f.tile_size | y1 / f.tile_size << 16);
    return true;
}

void emit_piece(const FrameParams& f, std::uint32_t triangle, const ClipVertex* const corner[3], ChunkOutput& out)
{
    const view_params view = view_params_of(f.view);
    TriangleSetup t = {};
    for (int i = 0; i < 3; ++i) {
        // a cut may come out a rounding error behind the near plane
        const float w = f.view.orthographic || corner[i]->c[2] > f.view.znear ? corner[i]->c[2] : f.view.znear;
        const float z = f.view.orthographic && corner[i]->c[3] > 1.0f ? 1.0f : corner[i]->c[3];
        const snapped_vertex s = snap_to_frame(f, vec4_of(corner[i]->c[0], corner[i]->c[1], w, z), view, kGuardBand);
        if (!s.valid)
            return; // numerically degenerate: nothing left of it
        t.x[i] = s.x, t.y[i] = s.y, t.inv_w[i] = s.inv_w, t.z[i] = s.z;
    }
    const std::int64_t area =
        static_cast<std::int64_t>(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - static_cast<std::int64_t>(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
    const std::uint32_t material = f.triangle_material[triangle];
    const bool front = area < 0; // counter-clockwise with y up
    if (area == 0 || (!front && !f.materials[material].double_sided))
        return;
    ClipRecord record = {};
    for (int j = 0; j < 3; ++j) {
        const int from = front && j > 0 ? 3 - j : j; // a front face runs the other way with y down
        for (int k = 0; k < 3; ++k)
            record.bary[3 * j + k] = corner[from]->bary[k];
        record.vertex[j] = static_cast<std::int32_t>(f.indices[3 * triangle + static_cast<std::uint32_t>(j)]);
    }
    if (front) {
        const TriangleSetup u = t;
        for (int j = 1; j < 3; ++j)
            t.x[j] = u.x[3 - j], t.y[j] = u.y[3 - j], t.inv_w[j] = u.inv_w[3 - j], t.z[j] = u.z[3 - j];
    }
    t.info = static_cast<std::int32_t>(material << 2) | (front ? kFrontFacing : 0) | kClipped;
    record.triangle = triangle;
    std::uint32_t corners[2];
    if (!tile_rect(f, t, corners))
        return;
    out.first_tile[out.count] = corners[0], out.last_tile[out.count] = corners[1];
    out.entries[out.count++] = kClippedEntry | out.piece_count;
    out.pieces[out.piece_count++] = {t, record};
}

} // namespace

void clip_triangle(const FrameParams& f, std::uint32_t triangle, ChunkOutput& out)
{
    ClipVertex polygon[kMaxVertices + 1];
    for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t v = f.indices[3 * triangle + i];
        const real4 c = clip_position(vec3_of(f.px[v], f.py[v], f.pz[v]), view_params_of(f.view));
        polygon[i] = {{c.x, c.y, c.z, c.w}, {i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f}};
    }
    const int n = clip_polygon(f, polygon, 3);
    for (int i = 1; i + 1 < n; ++i) {
        const ClipVertex* const corner[3] = {&polygon[0], &polygon[i], &polygon[i + 1]};
        emit_piece(f, triangle, corner, out);
    }
}

} // namespace burnish
