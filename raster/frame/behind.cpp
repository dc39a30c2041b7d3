#include "raster/frame/behind.h"

#include <algorithm>
#include <cmath>

#include "shading/lang/tables.h"

namespace burnish {

namespace {

struct Level { // RGBA
    int width = 0, height = 0;
    std::vector<float> texels;
    float* row(int y) { return texels.data() + std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(y); }
    const float* row(int y) const { return const_cast<Level*>(this)->row(y); }
};

Level level_of(int width, int height)
{
    Level l{width, height, {}};
    l.texels.resize(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return l;
}

// A texel's share of the finer level along one axis: up to three texels.
struct Footprint {
    int first, last;
    float first_weight, last_weight; // of the outer ones; those between have 1
};

Footprint footprint_of(int at, int fine, int coarse)
{
    const double scale = static_cast<double>(fine) / coarse, begin = at * scale,
                 end = std::min((at + 1) * scale, static_cast<double>(fine));
    Footprint f;
    f.first = static_cast<int>(begin), f.last = std::min(static_cast<int>(std::ceil(end)) - 1, fine - 1);
    f.first_weight = static_cast<float>(std::min(f.first + 1.0, end) - begin);
    f.last_weight = static_cast<float>(end - f.last);
    return f;
}

float weight_at(const Footprint& f, int i)
{
    return i == f.first ? f.first_weight : i == f.last ? f.last_weight : 1.0f;
}

// Halves a level: each texel is the mean over its part of the finer level.
Level halved(const Level& fine, const Jobs& jobs)
{
    Level coarse = level_of(std::max(1, fine.width / 2), std::max(1, fine.height / 2));
    const float scale =
        static_cast<float>(static_cast<double>(coarse.width) * coarse.height / (static_cast<double>(fine.width) * fine.height));
    jobs.parallel_for(static_cast<std::size_t>(coarse.height), [&](std::size_t y, int) {
        const Footprint down = footprint_of(static_cast<int>(y), fine.height, coarse.height);
        float* to = coarse.row(static_cast<int>(y));
        for (int x = 0; x < coarse.width; ++x, to += 4) {
            const Footprint across = footprint_of(x, fine.width, coarse.width);
            float sum[4] = {};
            for (int j = down.first; j <= down.last; ++j)
                for (int i = across.first; i <= across.last; ++i) {
                    const float weight = weight_at(down, j) * weight_at(across, i);
                    const float* const from = fine.row(j) + 4 * i;
                    for (int c = 0; c < 4; ++c)
                        sum[c] += from[c] * weight;
                }
            for (int c = 0; c < 4; ++c)
                to[c] = sum[c] * scale;
        }
    });
    return coarse;
}

} // namespace

FrameDesc behind_frame(const FrameDesc& desc)
{
    FrameDesc d = desc;
    d.opaque_only = d.triangle_ids = d.layers = true;
    d.background = d.profile = d.stages = d.parts = false;
    return d;
}

BehindPicture make_behind_picture(const Frame& frame, const Jobs& jobs)
{
    const TraceSpan span("surfaces behind");
    const int width = frame.color.width, height = frame.color.height;
    // Pair colours with coverage and depths
    std::vector<Level> levels{level_of(width, height)};
    Level depth = level_of(width, height);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                      samples = frame.triangle_ids.size() / pixels;
    jobs.parallel_for(static_cast<std::size_t>(height), [&](std::size_t y, int) {
        for (std::size_t p = y * static_cast<std::size_t>(width); p < (y + 1) * static_cast<std::size_t>(width); ++p) {
            const auto* const ids = frame.triangle_ids.data() + p * samples;
            const auto covered = samples - static_cast<std::size_t>(std::count(ids, ids + samples, kNoTriangle));
            std::copy_n(frame.color.f32() + 3 * p, 3, levels[0].texels.data() + 4 * p);
            levels[0].texels[4 * p + 3] = static_cast<float>(covered) / static_cast<float>(samples);
            const float z = frame.layers[p].depth;
            depth.texels[4 * p] = z > 0.0f ? 1.0f / z : 0.0f;
        }
    });
    while (levels.back().width > 1 || levels.back().height > 1)
        levels.push_back(halved(levels.back(), jobs));
    // Store them as textures
    Texture sampler;
    sampler.wrap_s = sampler.wrap_t = WrapMode::clamp;
    BehindPicture picture;
    picture.light = make_texture_pyramid(width, height, sampler, TextureEncoding::linear, [&](int level, int across, int y, float* rgba) {
        std::copy_n(levels[static_cast<std::size_t>(level)].row(y), 4 * across, rgba);
    });
    picture.depth = make_texture_pyramid(width, height, sampler, TextureEncoding::linear, [&](int level, int across, int y, float* rgba) {
        if (level == 0)
            std::copy_n(depth.row(y), 4 * across, rgba);
        else
            std::fill_n(rgba, 4 * across, 0.0f);
    });
    return picture;
}

} // namespace burnish
