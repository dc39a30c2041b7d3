// Records the intermediate values of a tile's samples, vertices and fragments, for comparison with other renderers (StageRecords in
// raster/frame/frame.h). Interpolants and material inputs are recomputed, one fragment at a time, by the functions that shading calls. So
// a fault in the way that shading fills its lanes shows in the colours first. Depths and colours are those in the picture.
#pragma once
#include "raster/frame/frame.h"
#include "raster/tile/fragment.h"
#include "raster/tile/raster.h"
#include "shading/surface/layers.t.h"
#include "shading/surface/recorded.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Writes the first lane of each register.
struct WordWriter {
    std::uint32_t* to;
    void put(std::uint32_t word) { *to++ = word; }
    void put(integer i)
    {
        std::int32_t lanes[kLanes];
        store_int(lanes, i);
        put(static_cast<std::uint32_t>(lanes[0]));
    }
    void put(real x) { put(bits_of(x)); }
};

// Customization points of shading/lang/recorder.h:
BN_INLINE void put_real(WordWriter& w, real x)
{
    w.put(x);
}

// Writes all lanes of each register.
struct LaneWriter {
    float* to; // [word][kLanes]
};
BN_INLINE void put_real(LaneWriter& w, real x)
{
    store(w.to, x);
    w.to += kLanes;
}

BN_STAGE void record_vertices(const FrameParams& f, std::uint32_t count, std::uint32_t* out)
{
    const view_params view = view_params_of(f.view);
    WordWriter w{out};
    for (std::uint32_t v = 0; v < count; ++v) {
        const real4 clip = clip_position(vec3_of(splat(f.px[v]), splat(f.py[v]), splat(f.pz[v])), view);
        const snapped_vertex s = snap_to_frame(f, clip, view, kWholeBand);
        put_real4(w, clip);
        w.put(select(s.valid, s.x, int_lit(kNeedsClip)));
        w.put(s.y);
        w.put(s.inv_w);
        w.put(s.z);
    }
}

// Records the fragments of the tile's own pixels after shading.
BN_STAGE void record_fragments(const FrameParams& f, const view_params& view, const TileRect& tile, const TileScratch& s)
{
    const int x0 = tile.x0, y0 = tile.y0;
    const auto pixel_of = [&](std::int32_t pixel) {
        return static_cast<std::size_t>(y0 + (pixel >> 8)) * static_cast<std::size_t>(f.width) +
               static_cast<std::size_t>(x0 + (pixel & 255));
    };
    const std::size_t msaa = static_cast<std::size_t>(f.msaa);
    for (std::uint32_t i = 0; i < s.fragment_count; ++i) {
        const std::int32_t pixel = s.fragment_pixel[i], covered = s.fragment_mask[i], id = s.fragment_triangle[i];
        if (!tile.owns(pixel & 255, pixel >> 8))
            continue;
        const std::size_t first = static_cast<std::size_t>(__builtin_ctz(static_cast<unsigned>(covered)));
        std::uint32_t* const record = s.output_pairs + (pixel_of(pixel) * msaa + first) * kPairWords;
        WordWriter w{record};
        w.put(static_cast<std::uint32_t>(covered));
        // Recompute interpolants and material inputs
        if (id >= 0) {
            const MaterialRecord& m = f.materials[s.triangles[id].info >> 2];
            const visible_point p =
                make_fragment(f, m, view, s, int_lit(id), id, int_lit(x0 + (pixel & 255)), int_lit(y0 + (pixel >> 8)), int_lit(covered));
            record_point(w, p, m.uses_color != 0, m.textured != 0, f.positions != 0);
            record_material(w, fetch_lanes(f, m, p));
        }
        // Store the drawn colour
        w.to = record + kPairWords - 3;
        w.put(splat(s.red[i])), w.put(splat(s.green[i])), w.put(splat(s.blue[i]));
    }
}

BN_STAGE void record_depths(const FrameParams& f, const TileRect& tile, const TileScratch& s)
{
    const int blocks_x = f.tile_size / kBlock;
    for (int y = tile.own_y0; y < tile.own_y1; ++y)
        for (int x = tile.own_x0; x < tile.own_x1; ++x) {
            const int block = (y / kBlock) * blocks_x + x / kBlock, in_block = (y % kBlock) * kBlock + x % kBlock;
            const float* from = s.depth + block * f.msaa * kBlockPixels + in_block;
            std::uint32_t* to = s.output_depths + (static_cast<std::size_t>(tile.y0 + y) * static_cast<std::size_t>(f.width) +
                                                   static_cast<std::size_t>(tile.x0 + x)) *
                                                      static_cast<std::size_t>(f.msaa);
            for (int k = 0; k < f.msaa; ++k)
                __builtin_memcpy(to + k, from + k * kBlockPixels, sizeof *to);
        }
}

} // namespace BN_ISA_NS
} // namespace burnish
