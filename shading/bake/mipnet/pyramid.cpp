#include "shading/bake/mipnet/pyramid.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/image/image.h"
#include "shading/bake/mipnet/classical.h"

namespace burnish::mipnet {
namespace {

constexpr std::size_t kTexelsAtOnce = 512; // of a level, per thread
constexpr int kBandRows = 64;              // of level 0, per step for levels 1 and 2; a multiple of 4
constexpr double kOddKappa = 0.5;          // for resampling odd sizes

// Returns a level with the requested size; resamples to `storage` if needed.
const Texels& brought_to(const Texels& level, int width, int height, Texels& storage)
{
    if (level.width == width && level.height == height)
        return level;
    storage = shrunk(level, width, height, Method::kappa, kOddKappa);
    return storage;
}

// Rows of a level from `first_row` on.
struct LevelRows {
    const float* channel[kChannels];
    int width, first_row;
};
LevelRows rows_of_level(const Texels& t, int first_row = 0)
{
    LevelRows rows = {{}, t.width, first_row};
    for (std::size_t c = 0; c < kChannels; ++c)
        rows.channel[c] = t.channel[c].data();
    return rows;
}

// Copies every `step`-th texel in a row, from x on.
void put_strided(const LevelRows& from, std::size_t channel, std::size_t x, std::size_t y, std::size_t step, std::size_t count, float* to)
{
    const float* at = from.channel[channel] + (y - static_cast<std::size_t>(from.first_row)) * static_cast<std::size_t>(from.width) + x;
    for (std::size_t i = 0; i < count; ++i)
        to[i] = at[step * i];
}

struct NetLevel {                      // an unfinished level
    LevelRows below;                   // the next finer level
    std::optional<LevelRows> further;  // two levels finer
    std::optional<LevelRows> farthest; // three levels finer, for far nets
    Texels* to;
};

// Gathers inputs for `count` texels in a level, from `first` on. Repeats the last one up to `padded`.
void gather(const NetLevel& l, std::size_t first, std::size_t count, std::size_t padded, float* children, float* grandchildren,
            float* great)
{
    const std::size_t width = static_cast<std::size_t>(l.to->width);
    for (std::size_t i = 0; i < count;) { // row by row
        const std::size_t x = (first + i) % width, y = (first + i) / width, here = std::min(width - x, count - i);
        for (std::size_t j = 0; j < 4; ++j) {
            const std::size_t cx = j & 1, cy = 2 * y + (j >> 1);
            for (std::size_t c = 0; c < kChannels; ++c)
                put_strided(l.below, c, 2 * x + cx, cy, 2, here, children + (c * 4 + j) * padded + i);
            for (std::size_t g = 0; l.further && g < 4; ++g) // the g-th texel of the j-th child
                for (std::size_t c = 0; c < kChannels; ++c)
                    put_strided(*l.further, c, 4 * x + 2 * cx + (g & 1), 2 * cy + (g >> 1), 4, here,
                                grandchildren + (c * 16 + 4 * g + j) * padded + i);
            for (std::size_t h = 0; l.farthest && h < 16; ++h) // the (h >> 2)-th texel of its (h & 3)-th child
                for (std::size_t c = 0; c < kChannels; ++c)
                    put_strided(*l.farthest, c, 8 * x + 4 * cx + 2 * (h & 1) + (h >> 2 & 1), 4 * cy + 2 * (h >> 1 & 1) + (h >> 3), 8, here,
                                great + (c * 64 + 16 * (h >> 2) + 4 * (h & 3) + j) * padded + i);
        }
        i += here;
    }
    const auto pad = [&](float* planes, std::size_t rows) {
        for (std::size_t r = 0; r < rows; ++r)
            std::fill(planes + r * padded + count, planes + (r + 1) * padded, planes[r * padded + count - 1]);
    };
    pad(children, 4 * kChannels);
    if (l.further)
        pad(grandchildren, 16 * kChannels);
    if (l.farthest)
        pad(great, 64 * kChannels);
}

// Makes texels of a level; owns its memory.
class NetMaker {
  public:
    NetMaker(const Fns& fns, const Plan& plan, const Weights& weights) : fns_(fns), plan_(plan), weights_(weights) {}

    void make(const NetLevel& l, std::size_t first, std::size_t count)
    {
        const std::size_t most_floats = kTexelsAtOnce * kChannels * (4 + 16 + 1 + (plan_.far ? 64 : 0));
        if (memory_.empty())
            memory_.resize(most_floats * sizeof(float) + fns_.forward_bytes(plan_, kTexelsAtOnce));
        float* const children = reinterpret_cast<float*>(memory_.data());
        float *const grandchildren = children + kTexelsAtOnce * kChannels * 4, *const made = grandchildren + kTexelsAtOnce * kChannels * 16;
        float* const great = made + kTexelsAtOnce * kChannels;
        for (const std::size_t end = first + count; first < end; first += kTexelsAtOnce) {
            const std::size_t some = std::min(kTexelsAtOnce, end - first), padded = (some + kSlots - 1) / kSlots * kSlots;
            gather(l, first, some, padded, children, grandchildren, great);
            fns_.forward({&plan_, weights_.numbers.data(), padded, children, l.further ? grandchildren : nullptr,
                          l.farthest ? great : nullptr, made, memory_.data() + most_floats * sizeof(float)});
            for (std::size_t c = 0; c < kChannels; ++c)
                std::memcpy(&l.to->channel[c][first], made + c * padded, some * sizeof(float));
        }
    }

  private:
    const Fns& fns_;
    const Plan& plan_;
    const Weights& weights_;
    std::vector<std::byte, LineAllocator<std::byte>> memory_;
};

Texels valid_band(const TexelRows& level0, int first_row, int rows)
{
    Texels band = make_texels(level0.width, rows);
    level0.rows(first_row, rows, band);
    make_valid(band);
    return band;
}

} // namespace

std::vector<Texels> net_levels(const TexelRows& level0, const Weights& weights, const Jobs& jobs, Isa isa)
{
    const Fns& fns = pick<Fns>(isa);
    const Plan plan = plan_of(weights.shape);
    std::vector<NetMaker> makers(static_cast<std::size_t>(jobs.threads()), NetMaker(fns, plan, weights));
    const auto next = [&](std::size_t level) {
        const int l = static_cast<int>(level);
        return make_texels(side_of_level(level0.width, l), side_of_level(level0.height, l));
    };
    std::vector<Texels> levels(1); // level 0 only if its sides are no multiples of 4, or the net is far
    // Make levels 1 and 2 in bands of level 0
    if (level0.width % 4 == 0 && level0.height % 4 == 0 && !plan.far) {
        levels.push_back(next(1)), levels.push_back(next(2));
        const int bands = (level0.height + kBandRows - 1) / kBandRows;
        jobs.parallel_for(static_cast<std::size_t>(bands), [&](std::size_t band, int worker) {
            const int first = static_cast<int>(band) * kBandRows, rows = std::min(kBandRows, level0.height - first);
            const Texels texels = valid_band(level0, first, rows);
            const LevelRows of0 = rows_of_level(texels, first), of1 = rows_of_level(levels[1]);
            const NetLevel made[] = {{of0, std::nullopt, std::nullopt, &levels[1]}, {of1, of0, std::nullopt, &levels[2]}};
            for (const NetLevel& l : made) {
                const std::size_t row = static_cast<std::size_t>(l.to->width), scale = static_cast<std::size_t>(level0.width) / row;
                makers[static_cast<std::size_t>(worker)].make(l, static_cast<std::size_t>(first) / scale * row,
                                                              static_cast<std::size_t>(rows) / scale * row);
            }
        });
    } else {
        levels[0] = valid_band(level0, 0, level0.height);
    }
    // Make the other levels one by one
    for (std::size_t level = levels.size(); next(level - 1).count() > 1; ++level) {
        Texels to = next(level), storage[3];
        const auto below = [&](std::size_t up) {
            const int scale = 1 << up;
            return rows_of_level(brought_to(levels[level - up], scale * to.width, scale * to.height, storage[up - 1]));
        };
        NetLevel l = {below(1), std::nullopt, std::nullopt, &to};
        if (level >= 2)
            l.further = below(2);
        if (level >= 3 && plan.far)
            l.farthest = below(3);
        const std::size_t texels = to.count(), pieces = (texels + kTexelsAtOnce - 1) / kTexelsAtOnce;
        jobs.parallel_for(pieces, [&](std::size_t piece, int worker) {
            const std::size_t first = piece * kTexelsAtOnce;
            makers[static_cast<std::size_t>(worker)].make(l, first, std::min(kTexelsAtOnce, texels - first));
        });
        levels.push_back(std::move(to));
    }
    levels.erase(levels.begin());
    return levels;
}

std::vector<Texels> net_pyramid(const Texels& level0, const Weights& weights, const Jobs& jobs, Isa isa)
{
    const TexelRows rows = {level0.width, level0.height, [&](int first, int count, Texels& to) {
                                const std::size_t width = static_cast<std::size_t>(level0.width);
                                for (std::size_t c = 0; c < kChannels; ++c)
                                    std::copy_n(level0.channel[c].begin() +
                                                    static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * width),
                                                static_cast<std::size_t>(count) * width, to.channel[c].begin());
                            }};
    std::vector<Texels> levels = net_levels(rows, weights, jobs, isa);
    levels.insert(levels.begin(), level0);
    make_valid(levels[0]);
    return levels;
}

} // namespace burnish::mipnet
