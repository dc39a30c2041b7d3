#include "shading/bake/mip/optimised_mip.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/base/check.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mip/training_light.h"

namespace burnish {
namespace {

using mipnet::kChannels, mipnet::kSlots, mipnet::Texels;

constexpr int kTrainingSteps = 120;
constexpr std::size_t kKeptTexels = 1u << 14; // largest level whose radiance is stored for the next level

// Radiance of a level's texels, by texel, then pair. Empty if the level is too large.
struct Radiance {
    int width = 0, height = 0;
    std::vector<float> values;
};

void gather_radiance(const Texels& level0, const Radiance& finer, const MipErrorSurface& surface, const TrainingLight& light,
                     const FootprintAxis& across, const FootprintAxis& down, float* to)
{
    if (finer.values.empty()) {
        gather_light(level0, surface, light, across, down, to);
        return;
    }
    std::fill_n(to, kTrainingPairs, 0.0f);
    for (std::size_t y = 0; y < down.at.size(); ++y)
        for (std::size_t x = 0; x < across.at.size(); ++x) {
            const std::size_t texel =
                static_cast<std::size_t>(down.at[y]) * static_cast<std::size_t>(finer.width) + static_cast<std::size_t>(across.at[x]);
            const float share = down.weight[y] * across.weight[x], *const from = finer.values.data() + texel * kTrainingPairs;
            for (std::size_t p = 0; p < kTrainingPairs; ++p)
                to[p] += share * from[p];
        }
}

} // namespace

std::vector<Texels> optimised_levels(const Texels& level0, const std::vector<std::vector<Texels>>& starts, const MipErrorSurface& surface,
                                     const Jobs& jobs, const OptimisedTexels& advance)
{
    BN_CHECK(!starts.empty());
    const TrainingLight light = training_light(surface);
    std::size_t all = 0, done = 0;
    for (const Texels& level : starts[0])
        all += level.count();
    std::mutex telling;
    Radiance finer;
    std::vector<Texels> made;
    for (std::size_t l = 0; l < starts[0].size(); ++l) {
        Texels to = mipnet::make_texels(starts[0][l].width, starts[0][l].height);
        if (!finer.values.empty() && (finer.width % to.width != 0 || finer.height % to.height != 0))
            finer = {};
        const int width = finer.values.empty() ? level0.width : finer.width, height = finer.values.empty() ? level0.height : finer.height;
        const std::size_t count = to.count(), groups = (count + kSlots - 1) / kSlots;
        Radiance kept = {to.width, to.height, std::vector<float>(count <= kKeptTexels ? count * kTrainingPairs : 0)};
        jobs.parallel_for(groups, [&](std::size_t group, int) {
            std::vector<float> radiance(kTrainingPairs * kSlots), shown(radiance.size()), one(kTrainingPairs), out(kChannels * kSlots);
            std::vector<float> from(starts.size() * kChannels * kSlots);
            for (std::size_t slot = 0; slot < kSlots; ++slot) { // repeat the last texel in unused slots
                // Average the reference under each texel, and collect its starts
                const std::size_t at = std::min(group * kSlots + slot, count - 1), row = static_cast<std::size_t>(to.width);
                if (group * kSlots + slot < count)
                    gather_radiance(level0, finer, surface, light, FootprintAxis(static_cast<int>(at % row), width, to.width),
                                    FootprintAxis(static_cast<int>(at / row), height, to.height), one.data());
                for (std::size_t p = 0; p < kTrainingPairs; ++p)
                    radiance[p * kSlots + slot] = one[p];
                if (!kept.values.empty())
                    std::copy(one.begin(), one.end(), kept.values.begin() + static_cast<std::ptrdiff_t>(at * kTrainingPairs));
                for (std::size_t s = 0; s < starts.size(); ++s)
                    for (std::size_t c = 0; c < kChannels; ++c)
                        from[(s * kChannels + c) * kSlots + slot] = starts[s][l].channel[c][at];
            }
            // Optimise a group of texels
            pick<mipnet::MipOptimiserFns>().fit({surface.lobe, kTrainingPairs, light.rows.data(), radiance.data(), from.data(),
                                                 static_cast<int>(starts.size()), kTrainingSteps, kTrainingBatch, shown.data(),
                                                 out.data()});
            const std::size_t first = group * kSlots, texels = std::min<std::size_t>(kSlots, count - first);
            for (std::size_t c = 0; c < kChannels; ++c)
                std::copy_n(out.data() + c * kSlots, texels, to.channel[c].data() + first);
            const std::lock_guard lock(telling);
            done += texels;
            if (advance)
                advance(done, all);
        });
        finer = std::move(kept);
        made.push_back(std::move(to));
    }
    return made;
}

} // namespace burnish
