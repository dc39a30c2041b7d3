// Clips the rare triangle that crosses the near plane or leaves the guard band, one at a time. Bins its pieces.
#include <algorithm>

#include "raster/tile/tile_types.h"
#include "shading/kernels/clip.t.h"
#include "shading/kernels/pixel_range.k.h"

namespace burnish {

namespace {

// Computes the rectangle of tiles that the bounding box can touch, as in TileRun. Returns false if the box touches no sample.
bool tiles_of_box(const FrameParams& f, const TriangleSetup& t, std::uint32_t corners[2])
{
    std::int32_t lo[2] = {t.x[0], t.y[0]}, hi[2] = {t.x[0], t.y[0]};
    for (int i = 1; i < 3; ++i) {
        lo[0] = t.x[i] < lo[0] ? t.x[i] : lo[0], hi[0] = t.x[i] > hi[0] ? t.x[i] : hi[0];
        lo[1] = t.y[i] < lo[1] ? t.y[i] : lo[1], hi[1] = t.y[i] > hi[1] ? t.y[i] : hi[1];
    }
    const pixel_range x = pixels_touched(lo[0], hi[0], f.center_x, f.pattern.min_x, f.pattern.max_x, f.width);
    const pixel_range y = pixels_touched(lo[1], hi[1], f.center_y, f.pattern.min_y, f.pattern.max_y, f.height);
    if (x.first > x.last || y.first > y.last)
        return false;
    const auto first = [&](int pixel) { return std::max(pixel - f.tile_rim, 0) / f.tile_step; };
    const auto last = [&](int pixel, int tiles) { return std::min((pixel + f.tile_rim) / f.tile_step, tiles - 1); };
    corners[0] = static_cast<std::uint32_t>(first(x.first) | first(y.first) << 16);
    corners[1] = static_cast<std::uint32_t>(last(x.last, f.tiles_x) | last(y.last, f.tiles_y) << 16);
    return true;
}

// Bins one piece. front: the polygon shows its front (seen_side()).
void emit_piece(const FrameParams& f, std::uint32_t triangle, bool front, const clip_corner* const corner[3], ChunkOutput& out)
{
    // Drop pieces that rounding turned over
    TriangleSetup t = {};
    for (int i = 0; i < 3; ++i)
        t.x[i] = corner[i]->x, t.y[i] = corner[i]->y, t.inv_w[i] = corner[i]->inv_w, t.z[i] = corner[i]->z;
    const std::int64_t area =
        static_cast<std::int64_t>(t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - static_cast<std::int64_t>(t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
    if (front ? area >= 0 : area <= 0)
        return;
    // Store the corners so that the area is positive
    const std::uint32_t material = f.triangle_material[triangle];
    ClipRecord record = {};
    for (int j = 0; j < 3; ++j) {
        const int from = turned_corner(front, j);
        for (int k = 0; k < 3; ++k)
            record.bary[3 * j + k] = static_cast<float>(corner[from]->bary[k]);
        record.vertex[j] = static_cast<std::int32_t>(f.indices[3 * triangle + static_cast<std::uint32_t>(j)]);
    }
    const TriangleSetup u = t;
    for (int j = 0; j < 3; ++j) {
        const int from = turned_corner(front, j);
        t.x[j] = u.x[from], t.y[j] = u.y[from], t.inv_w[j] = u.inv_w[from], t.z[j] = u.z[from];
    }
    // Append the piece to the tiles that it may touch
    t.info = static_cast<std::int32_t>(material << 2) | (front ? kFrontFacing : 0) | kClipped;
    record.triangle = triangle;
    std::uint32_t corners[2];
    if (!tiles_of_box(f, t, corners))
        return;
    add_run(out, corners[0], corners[1], 1);
    out.entries[out.count++] = kClippedEntry | out.piece_count;
    out.pieces[out.piece_count++] = {t, record};
}

} // namespace

void clip_triangle(const FrameParams& f, std::uint32_t triangle, ChunkOutput& out)
{
    // Load the corners; vertices in the guard band keep their snapped positions
    clip_polygon polygon;
    for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = f.indices[3 * triangle + static_cast<std::uint32_t>(i)];
        set_corner(f, polygon, i, f.px[v], f.py[v], f.pz[v]);
        const SnappedVertex& s = f.vertices[v];
        if (s.x != kNeedsClip)
            place_corner(polygon, i, s.x, s.y, s.inv_w, s.z);
    }
    // Clip, cull back faces, and fan the polygon into pieces
    clip_triangle_to_frame(f, polygon);
    const int side = seen_side(polygon);
    if (side == 0 || (side < 0 && !f.materials[f.triangle_material[triangle]].double_sided))
        return;
    for (int i = 1; i + 1 < polygon.count; ++i) {
        const clip_corner* const corner[3] = {&polygon.corner[0], &polygon.corner[i], &polygon.corner[i + 1]};
        emit_piece(f, triangle, side > 0, corner, out);
    }
}

} // namespace burnish
