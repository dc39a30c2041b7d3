// Composites blended layers over solid surfaces, sample by sample.
#pragma once
#include "raster/tile/blocks.h"
#include "shading/surface/coverage.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Calls body(block, v, passes, lanes, at) for each pixel register v in each block of the tile. passes: number of passes in the fragment
// list; lanes: their lanes; at: the first fragment's index.
template <class Body> BN_INLINE void for_each_register(const FrameParams& f, int width, int height, const TileScratch& s, const Body& body)
{
    const std::uint32_t* lanes = s.pass_lanes;
    const std::uint8_t* register_passes = s.register_passes;
    std::uint32_t at = 0;
    for (int by = 0; by * kBlock < height; ++by)
        for (int bx = 0; bx * kBlock < width; ++bx)
            for (int v = 0; v < kVectors; ++v) {
                const int passes = *register_passes++;
                body(by * (f.tile_size / kBlock) + bx, v, passes, lanes, at);
                for (int k = 0; k < passes; ++k)
                    at += static_cast<std::uint32_t>(__builtin_popcount(*lanes++));
            }
}

BN_INLINE blended_light load_blended(const PeelScratch& p, int at)
{
    blended_light b;
    b.over = vec3_of(load(p.red + at), load(p.green + at), load(p.blue + at));
    b.through = load(p.through + at);
    return b;
}

// Composites one pass of a layer behind the earlier layers. Returns the pass' pixels that show a surface.
BN_INLINE std::uint32_t compose_pass(const FrameParams& f, const TileScratch& layer, PeelScratch& p, int first, mask m, std::uint32_t at)
{
    const mask seen = both(m, expand_load_int(layer.fragment_triangle + at, m) >= int_lit(0));
    if (none(seen))
        return 0;
    const integer samples = expand_load_int(layer.fragment_mask + at, m);
    const real3 colour = vec3_of(expand_load(layer.red + at, m), expand_load(layer.green + at, m), expand_load(layer.blue + at, m));
    const real alpha = expand_load(p.alpha + at, m);
    // Blend each covered sample
    for (int s = 0; s < f.msaa; ++s) {
        const int to = first + s * kBlockPixels;
        const mask mine = both(seen, (samples & int_lit(1 << s)) != int_lit(0));
        const blended_light b = load_blended(p, to), next = blend_behind(b, colour, alpha);
        store(p.red + to, select(mine, next.over.x, b.over.x));
        store(p.green + to, select(mine, next.over.y, b.over.y));
        store(p.blue + to, select(mine, next.over.z, b.over.z));
        store(p.through + to, select(mine, next.through, b.through));
    }
    return to_bits(seen);
}

// Composites the shaded layer behind the earlier layers.
BN_INLINE void compose_layer(const FrameParams& f, int width, int height, PeelScratch& p)
{
    const TileScratch& layer = *p.layer;
    real nearest = lit(-1.0);
    for (int block = 0; block < (f.tile_size / kBlock) * (f.tile_size / kBlock); ++block)
        p.done[block] = true;
    for_each_register(f, width, height, layer, [&](int block, int v, int passes, const std::uint32_t* lanes, std::uint32_t at) {
        const int first = block * f.msaa * kBlockPixels + v * kLanes;
        std::uint32_t shown = 0;
        for (int k = 0; k < passes; ++k) {
            shown |= compose_pass(f, layer, p, first, mask_from_bits(lanes[k]), at);
            at += static_cast<std::uint32_t>(__builtin_popcount(lanes[k]));
        }
        if (!shown) { // no further layer here
            for (int s = 0; s < f.msaa; ++s)
                store(p.depth + first + s * kBlockPixels, lit(-1.0));
            return;
        }
        // Keep the layer's depths where light still passes
        p.pixels[block] |= static_cast<std::uint64_t>(shown) << (v * kLanes);
        bool more = false;
        for (int s = 0; s < f.msaa; ++s) {
            const int to = first + s * kBlockPixels;
            const integer id = load_int(reinterpret_cast<const std::int32_t*>(layer.ids) + to);
            const mask open = both(id >= int_lit(0), load(p.through + to) > lit(0.0));
            const real depth = select(open, load(layer.depth + to), lit(-1.0));
            store(p.depth + to, depth);
            nearest = max(nearest, depth);
            store_int(p.id + to, id);
            more = any(open) || more;
        }
        p.done[block] = p.done[block] && !more;
    });
    float of_lane[kLanes];
    store(of_lane, reduce_max(nearest));
    p.nearest_open = of_lane[0];
    p.fragment_count += layer.own_fragments - layer.own_background;
}

// Colours behind the blended surfaces, by sample, for a register of pixels.
struct SampleColours {
    real3 at[kMaxSamples];
};
BN_INLINE SampleColours colours_of_samples(const FrameParams& f, const TileScratch& s, int passes, const std::uint32_t* lanes,
                                           std::uint32_t at)
{
    SampleColours r;
    for (int k = 0; k < f.msaa; ++k)
        r.at[k] = vec3_all(lit(0.0));
    for (int k = 0; k < passes; ++k) {
        const mask m = mask_from_bits(lanes[k]);
        const integer samples = expand_load_int(s.fragment_mask + at, m);
        const real3 colour = vec3_of(expand_load(s.red + at, m), expand_load(s.green + at, m), expand_load(s.blue + at, m));
        for (int i = 0; i < f.msaa; ++i)
            r.at[i] = select(both(m, (samples & int_lit(1 << i)) != int_lit(0)), colour, r.at[i]);
        at += static_cast<std::uint32_t>(__builtin_popcount(lanes[k]));
    }
    return r;
}

// Writes the tile's own pixels with blended surfaces. resolve() must have written all pixels before.
BN_INLINE void resolve_blended(const FrameParams& f, const TileRect& tile, const TileScratch& s)
{
    const PeelScratch& p = *s.peel;
    const real each = splat(1.0f / static_cast<float>(f.msaa));
    const int blocks_x = f.tile_size / kBlock;
    for_each_register(f, tile.width, tile.height, s, [&](int block, int v, int passes, const std::uint32_t* lanes, std::uint32_t at) {
        const std::uint32_t shown = static_cast<std::uint32_t>(p.pixels[block] >> (v * kLanes)) & kAllLanes;
        if (!shown)
            return;
        const int first = block * f.msaa * kBlockPixels + v * kLanes;
        // Blend over the solid colours, and average the samples
        const SampleColours behind = colours_of_samples(f, s, passes, lanes, at);
        real3 sum = vec3_all(lit(0.0));
        for (int k = 0; k < f.msaa; ++k)
            sum = sum + blend_over(load_blended(p, first + k * kBlockPixels), behind.at[k]);
        sum = sum * each;
        // Write the pixels one by one
        float rgb[3][kLanes];
        store(rgb[0], sum.x), store(rgb[1], sum.y), store(rgb[2], sum.z);
        for (std::uint32_t bits = shown; bits; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits), in_block = v * kLanes + lane;
            const int x = block % blocks_x * kBlock + (in_block & 7), y = block / blocks_x * kBlock + (in_block >> 3);
            if (!tile.owns(x, y))
                continue;
            const std::size_t pixel =
                static_cast<std::size_t>(tile.y0 + y) * static_cast<std::size_t>(f.width) + static_cast<std::size_t>(tile.x0 + x);
            for (std::size_t c = 0; c < 3; ++c)
                s.output[3 * pixel + c] = rgb[c][lane];
            for (int k = 0; k < f.msaa && p.output_through; ++k)
                p.output_through[pixel * static_cast<std::size_t>(f.msaa) + static_cast<std::size_t>(k)] =
                    p.through[first + k * kBlockPixels + lane];
        }
    });
}

} // namespace BN_ISA_NS
} // namespace burnish
