#include "shading/bake/mipnet/pyramid.h"

#include <algorithm>
#include <cstring>

#include "core/image/image.h"
#include "shading/bake/mipnet/classical.h"

namespace burnish::mipnet {
namespace {

constexpr std::size_t kTexelsAtOnce = 512; // of a level, by one thread
constexpr double kOddKappa = 0.5;          // of what odd sizes are gathered with

// A level as one of the size asked for.
const Texels& brought_to(const Texels& level, int width, int height, Texels& storage)
{
    if (level.width == width && level.height == height)
        return level;
    storage = shrunk(level, width, height, Method::kappa, kOddKappa);
    return storage;
}

struct NetLevel {                     // a level being made
    const Texels *below, *below_that; // twice and four times as large; the second may be null
    Texels* to;
};

// Texels first... of a level, `count` of them, the last one again up to `padded`.
void gather(const NetLevel& l, std::size_t first, std::size_t count, std::size_t padded, float* children, float* grandchildren)
{
    const std::size_t width = static_cast<std::size_t>(l.to->width);
    for (std::size_t i = 0; i < padded; ++i) {
        const std::size_t at = first + std::min(i, count - 1), x = at % width, y = at / width;
        for (std::size_t j = 0; j < 4; ++j) {
            const std::size_t cx = 2 * x + (j & 1), cy = 2 * y + (j >> 1);
            for (std::size_t c = 0; c < kChannels; ++c)
                children[(c * 4 + j) * padded + i] = l.below->channel[c][cy * 2 * width + cx];
            if (!l.below_that)
                continue;
            for (std::size_t g = 0; g < 4; ++g) { // the g-th texel of the j-th child
                const std::size_t from = (2 * cy + (g >> 1)) * 4 * width + 2 * cx + (g & 1);
                for (std::size_t c = 0; c < kChannels; ++c)
                    grandchildren[(c * 16 + 4 * g + j) * padded + i] = l.below_that->channel[c][from];
            }
        }
    }
}

} // namespace

std::vector<Texels> net_pyramid(const Texels& level0, const Weights& weights, const Jobs& jobs, Isa isa)
{
    const Fns& fns = pick<Fns>(isa);
    const Plan plan = plan_of(weights.shape);
    std::vector<Texels> levels = {level0};
    make_valid(levels[0]);
    using Memory = std::vector<std::byte, LineAllocator<std::byte>>;
    std::vector<Memory> memories(static_cast<std::size_t>(jobs.threads()));
    while (levels.back().width > 1 || levels.back().height > 1) {
        const int level = static_cast<int>(levels.size());
        Texels to = make_texels(side_of_level(level0.width, level), side_of_level(level0.height, level)), storage[2];
        NetLevel l = {&brought_to(levels.back(), 2 * to.width, 2 * to.height, storage[0]), nullptr, &to};
        if (level >= 2)
            l.below_that = &brought_to(levels[static_cast<std::size_t>(level) - 2], 4 * to.width, 4 * to.height, storage[1]);
        const std::size_t texels = to.count(), pieces = (texels + kTexelsAtOnce - 1) / kTexelsAtOnce;
        jobs.parallel_for(pieces, [&](std::size_t piece, int worker) {
            const std::size_t first = piece * kTexelsAtOnce, count = std::min(kTexelsAtOnce, texels - first);
            const std::size_t padded = (count + kSlots - 1) / kSlots * kSlots;
            constexpr std::size_t kMostFloats = kTexelsAtOnce * kChannels * (4 + 16 + 1);
            Memory& memory = memories[static_cast<std::size_t>(worker)];
            if (memory.empty())
                memory.resize(kMostFloats * sizeof(float) + fns.forward_bytes(plan, kTexelsAtOnce));
            float* const children = reinterpret_cast<float*>(memory.data());
            float* const grandchildren = children + kTexelsAtOnce * kChannels * 4;
            float* const made = grandchildren + kTexelsAtOnce * kChannels * 16;
            gather(l, first, count, padded, children, grandchildren);
            fns.forward({&plan, weights.numbers.data(), padded, children, l.below_that ? grandchildren : nullptr, made,
                         memory.data() + kMostFloats * sizeof(float)});
            for (std::size_t c = 0; c < kChannels; ++c)
                std::memcpy(&to.channel[c][first], made + c * padded, count * sizeof(float));
        });
        levels.push_back(std::move(to));
    }
    return levels;
}

} // namespace burnish::mipnet
