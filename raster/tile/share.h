// Averages fragments over the pixels around them that share samples (shading/techniques/shared_samples.k.h). Records lie by fragment and
// word. Planes by pixel hold
// what each pixel shows its neighbours, so neighbours are loads side by side.
#pragma once
#include "raster/tile/batch.h"
#include "raster/tile/compose.h"
#include "raster/tile/resolve.h"
#include "shading/surface/coverage.t.h"
#include "shading/techniques/shared_samples.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr int kWidthWord = 0, kReadWords = 10, kFactorWord = 10; // neighbours read the words before kReadWords
static_assert(kSharedWords == kFactorWord + 3 && kSharedPlanes == kReadWords + 1);

// Returns the records' word k, by fragment.
BN_INLINE float* shared_word(const TileScratch& s, int k)
{
    return s.shared_words + static_cast<std::ptrdiff_t>(s.shared_capacity) * k;
}

// Returns shared_pixel::record's word k, by pixel. Plane kReadWords holds shared_pixel::cover.
BN_INLINE float* shared_plane(const TileScratch& s, int k)
{
    return s.shared_pixels + std::ptrdiff_t{kSharedPixels} * k;
}

// Returns a pixel's index in a plane. x, y: in the tile.
BN_INLINE int shared_place(int x, int y)
{
    return (y + 1) * kSharedStride + x + kSharedMargin;
}

// Marks all fragments as sharing nothing, and empties the planes.
BN_INLINE void begin_sharing(TileScratch& s)
{
    float* const width = shared_word(s, kWidthWord);
    for (std::uint32_t i = 0; i < s.fragment_count; i += kLanes)
        store(width + i, lit(-1.0));
    __builtin_memset(shared_plane(s, kReadWords), 0, sizeof(float) * kSharedPixels);
}

// Stores a batch's records; `rest` lies in its colours.
BN_INLINE void store_shared_samples(const Tile& t, const Batch& b, const shared_sample_record& r)
{
    store_batch(t, b, r.rest);
    const shared_sample_words words = words_of_shared_sample(r);
    if (b.run) {
        for (int k = 0; k < kSharedWords; ++k)
            store(shared_word(t.s, k) + b.fragment[0], words.at[k]);
        return;
    }
    for (int k = 0; k < kSharedWords; ++k) {
        float of_lane[kLanes], *const to = shared_word(t.s, k);
        store(of_lane, words.at[k]);
        for (int i = 0; i < b.n; ++i)
            to[b.fragment[i]] = of_lane[i];
    }
}

BN_INLINE shared_sample_record record_of_words(const real words[kReadWords])
{
    shared_sample_words all;
    for (int k = 0; k < 16; ++k)
        all.at[k] = k < kReadWords ? words[k] : lit(0.0);
    return shared_sample_of_words(all);
}

// Calls body(place, passes, lanes, at) for each pixel register. place: shared_place() for its first pixel; others: for_each_register().
template <class Body> BN_INLINE void for_each_run(const Tile& t, const Body& body)
{
    const int blocks_x = t.f.tile_size / kBlock;
    for_each_register(t.f, t.width, t.height, t.s, [&](int block, int v, int passes, const std::uint32_t* lanes, std::uint32_t at) {
        const int x = block % blocks_x * kBlock + (v * kLanes & 7), y = block / blocks_x * kBlock + (v * kLanes >> 3);
        body(shared_place(x, y), passes, lanes, at);
    });
}

// Loads the first `count` words in a pass's records. m: its lanes.
BN_INLINE void load_words(const TileScratch& s, int count, std::uint32_t at, std::uint32_t lanes, mask m, real* to)
{
    for (int k = 0; k < count; ++k)
        to[k] = lanes == kAllLanes ? load(shared_word(s, k) + at) : expand_load(shared_word(s, k) + at, m);
}

// Fills the planes with what each pixel shows its neighbours.
BN_INLINE void fill_planes(const Tile& t)
{
    TileScratch& s = t.s;
    const real zero = lit(0.0), each = splat(1.0f / static_cast<float>(t.f.msaa));
    for_each_run(t, [&](int place, int passes, const std::uint32_t* lanes, std::uint32_t at) {
        shared_pixel p = shared_pixel_begin();
        real words[kReadWords];
        if (passes == 1 && *lanes == kAllLanes) { // every pixel is one fragment with weight 1
            load_words(s, kReadWords, at, kAllLanes, mask_from_bits(kAllLanes), words);
            p.cover = select(words[kWidthWord] >= zero, lit(1.0), zero);
        } else {
            for (int pass = 0; pass < passes; ++pass) {
                const mask m = mask_from_bits(lanes[pass]);
                load_words(s, kReadWords, at, lanes[pass], m, words);
                const real share = share_of(expand_load_int(s.fragment_mask + at, m), each, t.f.msaa);
                p = shared_pixel_add(p, record_of_words(words), select(both(m, words[kWidthWord] >= zero), share, zero));
                at += static_cast<std::uint32_t>(__builtin_popcount(lanes[pass]));
            }
            const shared_sample_words all = words_of_shared_sample(shared_pixel_end(p).record);
            for (int k = 0; k < kReadWords; ++k)
                words[k] = all.at[k];
        }
        if (none(p.cover > zero))
            return;
        const auto to = [&](int k) { return shared_plane(s, k) + place; };
        for (int k = 0; k < kReadWords; ++k)
            store_rows(to(k), to(k) + kSharedStride, words[k]);
        store_rows(to(kReadWords), to(kReadWords) + kSharedStride, p.cover);
    });
}

// Returns a pixel register's shared record.
BN_INLINE shared_pixel load_pixels(const TileScratch& s, int place)
{
    const auto word = [&](int k) {
        const float* const from = shared_plane(s, k) + place;
        return load_rows(from, from + kSharedStride);
    };
    real words[kReadWords];
    for (int k = 0; k < kReadWords; ++k)
        words[k] = word(k);
    return {record_of_words(words), word(kReadWords)};
}

// Returns the mean light over a pixel register's windows.
BN_INLINE real3 window_light(const TileScratch& s, const shared_sample_record& own, int place)
{
    shared_sample_mean mean = shared_sample_mean_begin(own);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            if (dx == 0 && dy == 0)
                continue;
            const shared_pixel other = load_pixels(s, place + dy * kSharedStride + dx);
            mean = shared_sample_mean_add(mean, own, other.record, other.cover, window_weight(dx, dy));
        }
    return shared_sample_mean_light(mean);
}

// Averages all fragments over their windows, and stores their colours.
BN_INLINE void share_fragments(const Tile& t)
{
    TileScratch& s = t.s;
    fill_planes(t);
    for_each_run(t, [&](int place, int passes, const std::uint32_t* lanes, std::uint32_t at) {
        const shared_pixel pixel = load_pixels(s, place);
        if (none(pixel.cover > lit(0.0)))
            return;
        const real3 light = window_light(s, pixel.record, place);
        for (int pass = 0; pass < passes; ++pass) {
            const std::uint32_t bits = lanes[pass], count = static_cast<std::uint32_t>(__builtin_popcount(bits));
            const mask m = mask_from_bits(bits);
            real words[kSharedWords];
            load_words(s, kSharedWords, at, bits, m, words);
            shared_sample_record own = record_of_words(words);
            own.factor = vec3_of(words[kFactorWord], words[kFactorWord + 1], words[kFactorWord + 2]);
            float* const to[3] = {s.red + at, s.green + at, s.blue + at};
            at += count;
            if (bits == kAllLanes) {
                own.rest = vec3_of(load(to[0]), load(to[1]), load(to[2]));
                const real3 colour = shared_sample_colour(own, light, pixel.record);
                store(to[0], colour.x), store(to[1], colour.y), store(to[2], colour.z);
                continue;
            }
            own.rest = vec3_of(expand_load(to[0], m), expand_load(to[1], m), expand_load(to[2], m));
            const real3 colour = shared_sample_colour(own, light, pixel.record);
            float of_lane[3][kLanes];
            store(of_lane[0], colour.x), store(of_lane[1], colour.y), store(of_lane[2], colour.z);
            std::uint32_t rest = bits;
            for (std::uint32_t i = 0; i < count; ++i, rest &= rest - 1)
                for (int c = 0; c < 3; ++c)
                    to[c][i] = of_lane[c][__builtin_ctz(rest)];
        }
    });
}

} // namespace BN_ISA_NS
} // namespace burnish
