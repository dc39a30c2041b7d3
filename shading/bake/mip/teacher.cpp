#include "shading/bake/mip/teacher.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/base/check.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mipnet/batch.h"
#include "shading/bake/mipnet/net.h"
#include "shading/bake/mipnet/teacher_fns.h"

namespace burnish {
namespace {

using mipnet::kChannels, mipnet::kSlots, mipnet::Texels;

constexpr int kTaughtPairs = 256, kTaughtBatch = 32, kTaughtSteps = 120;
constexpr std::size_t kKeptTexels = 1u << 14; // of a level whose radiance the next one is averaged from

struct Lights {
    std::vector<float> directions, intensity, rows;
};

Lights lights_of(const ShownSurface& surface)
{
    const std::size_t pairs = kTaughtPairs;
    Lights l = {std::vector<float>(6 * pairs), std::vector<float>(pairs), std::vector<float>(mipnet::kLightRows * pairs)};
    mipnet::Random random(31);
    for (std::size_t p = 0; p < pairs; ++p) {
        mipnet::put_pair(random, l.directions.data() + p, pairs);
        l.intensity[p] = static_cast<float>(random.between(1.0, 10.0));
    }
    pick<mipnet::TeacherFns>().light(
        {surface.lobe, kTaughtPairs, surface.f0, surface.diffuse, l.directions.data(), l.intensity.data(), l.rows.data()});
    return l;
}

struct Axis { // a footprint along one
    std::vector<int> at;
    std::vector<float> weight;
    Axis(int i, int source, int target)
    {
        for (const Share& share : shares_of(i, source, target))
            at.push_back(share.at), weight.push_back(static_cast<float>(share.weight));
    }
};

// Radiance of a level's texels, by texel, then pair; of none where it is too large to be kept.
struct Radiance {
    int width = 0, height = 0;
    std::vector<float> values;
};

void gather_radiance(const Texels& level0, const Radiance& finer, const ShownSurface& surface, const Lights& lights, const Axis& across,
                     const Axis& down, float* to)
{
    if (finer.values.empty()) {
        mipnet::GatherWork work = {surface.lobe,
                                   kTaughtPairs,
                                   lights.rows.data(),
                                   {},
                                   static_cast<std::size_t>(level0.width),
                                   across.at.data(),
                                   down.at.data(),
                                   across.weight.data(),
                                   down.weight.data(),
                                   static_cast<int>(across.at.size()),
                                   static_cast<int>(down.at.size()),
                                   to};
        for (std::size_t c = 0; c < kChannels; ++c)
            work.planes[c] = level0.channel[c].data();
        pick<mipnet::TeacherFns>().gather(work);
        return;
    }
    std::fill_n(to, kTaughtPairs, 0.0f);
    for (std::size_t y = 0; y < down.at.size(); ++y)
        for (std::size_t x = 0; x < across.at.size(); ++x) {
            const std::size_t texel =
                static_cast<std::size_t>(down.at[y]) * static_cast<std::size_t>(finer.width) + static_cast<std::size_t>(across.at[x]);
            const float share = down.weight[y] * across.weight[x], *const from = finer.values.data() + texel * kTaughtPairs;
            for (std::size_t p = 0; p < kTaughtPairs; ++p)
                to[p] += share * from[p];
        }
}

} // namespace

std::vector<Texels> taught_levels(const Texels& level0, const std::vector<std::vector<Texels>>& starts, const ShownSurface& surface,
                                  const Jobs& jobs, const TaughtTexels& advance)
{
    BN_CHECK(!starts.empty());
    const Lights lights = lights_of(surface);
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
        Radiance kept = {to.width, to.height, std::vector<float>(count <= kKeptTexels ? count * kTaughtPairs : 0)};
        jobs.parallel_for(groups, [&](std::size_t group, int) {
            std::vector<float> radiance(kTaughtPairs * kSlots), shown(radiance.size()), one(kTaughtPairs), out(kChannels * kSlots);
            std::vector<float> from(starts.size() * kChannels * kSlots);
            for (std::size_t slot = 0; slot < kSlots; ++slot) { // the last texel again where there are fewer
                const std::size_t at = std::min(group * kSlots + slot, count - 1), row = static_cast<std::size_t>(to.width);
                if (group * kSlots + slot < count)
                    gather_radiance(level0, finer, surface, lights, Axis(static_cast<int>(at % row), width, to.width),
                                    Axis(static_cast<int>(at / row), height, to.height), one.data());
                for (std::size_t p = 0; p < kTaughtPairs; ++p)
                    radiance[p * kSlots + slot] = one[p];
                if (!kept.values.empty())
                    std::copy(one.begin(), one.end(), kept.values.begin() + static_cast<std::ptrdiff_t>(at * kTaughtPairs));
                for (std::size_t s = 0; s < starts.size(); ++s)
                    for (std::size_t c = 0; c < kChannels; ++c)
                        from[(s * kChannels + c) * kSlots + slot] = starts[s][l].channel[c][at];
            }
            pick<mipnet::TeacherFns>().fit({surface.lobe, kTaughtPairs, lights.rows.data(), radiance.data(), from.data(),
                                            static_cast<int>(starts.size()), kTaughtSteps, kTaughtBatch, shown.data(), out.data()});
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
