#include "shading/lab/mip/two_lobes.h"

#include <algorithm>
#include <cmath>

#include "core/math/scalar_math.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mip/training_light.h"

namespace burnish {
namespace {

using mipnet::kChannels, mipnet::kSlots, mipnet::Texels;

constexpr int kPairSteps = 60, kTurns = 2, kPairStarts = 5;

// Returns the texels' lobes as starts: unchanged; stretched along one axis and narrowed across it, for two crossed axes and two between;
// or leaning to one side by the lobe's width. second: the pair's other lobe.
Texels started(const Texels& ones, int start, bool second)
{
    Texels to = ones;
    const double sign = second ? -1.0 : 1.0;
    for (std::size_t i = 0; i < ones.count(); ++i) {
        const auto at = [&](std::size_t c) -> float& { return to.channel[c][i]; };
        const double a = static_cast<double>(at(2)), b = static_cast<double>(at(3)), mean = std::sqrt(a * b);
        if (start == 1 || start == 2) {
            const mipnet::Tensor t =
                mipnet::tensor_of(1.6 * mean, 0.4 * mean, (start == 1 ? 0.0 : 0.25 * kPi) + (second ? 0.5 * kPi : 0.0));
            at(2) = static_cast<float>(t.a), at(3) = static_cast<float>(t.b), at(4) = static_cast<float>(t.c);
        } else if (start >= 3) {
            at(start == 3 ? 0 : 1) += static_cast<float>(sign * 0.5 * mean);
        }
    }
    mipnet::make_valid(to);
    return to;
}

struct TexelGroup { // kSlots texels in a level, and the radiance that they should reflect
    std::size_t first;
    std::vector<float> wanted; // [pairs][kSlots]
};

class PairSearch {
  public:
    PairSearch(const MipErrorSurface& surface, const TrainingLight& light) : surface_(surface), light_(light) {}

    // Moves one lobe, with `other` fixed. Writes the pair's error to `loss`.
    void turn(const TexelGroup& group, const Texels& other, Texels& moved, float* loss) const
    {
        std::vector<float> rest(kTrainingPairs * kSlots), one(kTrainingPairs), from(kChannels * kSlots), shown(rest.size()),
            out(from.size());
        // Gather the other lobe's light
        const FootprintAxis only(0, 1, 1);
        for (std::size_t slot = 0; slot < kSlots; ++slot) {
            Texels texel = mipnet::make_texels(1, 1);
            const std::size_t at = std::min(group.first + slot, other.count() - 1);
            for (std::size_t c = 0; c < kChannels; ++c)
                texel.channel[c][0] = other.channel[c][at], from[c * kSlots + slot] = moved.channel[c][at];
            gather_light(texel, surface_, light_, only, only, one.data());
            for (std::size_t p = 0; p < kTrainingPairs; ++p)
                rest[p * kSlots + slot] = 0.5f * one[p];
        }
        // Fit the moving lobe to the remainder
        pick<mipnet::MipOptimiserFns>().fit({surface_.lobe, kTrainingPairs, light_.rows.data(), group.wanted.data(), from.data(), 1,
                                             kPairSteps, kTrainingBatch, shown.data(), out.data(), rest.data(), 0.5f, loss});
        for (std::size_t slot = 0; slot < kSlots && group.first + slot < moved.count(); ++slot)
            for (std::size_t c = 0; c < kChannels; ++c)
                moved.channel[c][group.first + slot] = out[c * kSlots + slot];
    }

  private:
    const MipErrorSurface& surface_;
    const TrainingLight& light_;
};

} // namespace

LobePairs optimised_pairs(const Texels& level0, const std::vector<Texels>& ones, const MipErrorSurface& surface, const Jobs& jobs)
{
    const TrainingLight light = training_light(surface);
    const PairSearch search(surface, light);
    LobePairs made;
    for (const Texels& one : ones) {
        std::vector<Texels> lobes[2]; // by start
        for (int start = 0; start < kPairStarts; ++start)
            for (const bool second : {false, true})
                lobes[second].push_back(started(one, start, second));
        Texels first = one, second = one;
        const std::size_t row = static_cast<std::size_t>(one.width);
        jobs.parallel_for((one.count() + kSlots - 1) / kSlots, [&](std::size_t g, int) {
            TexelGroup group = {g * kSlots, std::vector<float>(kTrainingPairs * kSlots)};
            // Average the reference under each texel
            std::vector<float> wanted(kTrainingPairs);
            for (std::size_t slot = 0; slot < kSlots; ++slot) {
                const std::size_t at = std::min(group.first + slot, one.count() - 1);
                gather_light(level0, surface, light, FootprintAxis(static_cast<int>(at % row), level0.width, one.width),
                             FootprintAxis(static_cast<int>(at / row), level0.height, one.height), wanted.data());
                for (std::size_t p = 0; p < kTrainingPairs; ++p)
                    group.wanted[p * kSlots + slot] = wanted[p];
            }
            // Try all starts, and keep the best pair per texel
            float least[kSlots], loss[kSlots];
            for (std::size_t start = 0; start < kPairStarts; ++start) {
                for (int turn = 0; turn < kTurns; ++turn) {
                    search.turn(group, lobes[1][start], lobes[0][start], loss);
                    search.turn(group, lobes[0][start], lobes[1][start], loss);
                }
                for (std::size_t slot = 0; slot < kSlots && group.first + slot < one.count(); ++slot) {
                    if (start > 0 && !(loss[slot] < least[slot]))
                        continue;
                    least[slot] = loss[slot];
                    for (std::size_t c = 0; c < kChannels; ++c) {
                        const std::size_t at = group.first + slot;
                        first.channel[c][at] = lobes[0][start].channel[c][at], second.channel[c][at] = lobes[1][start].channel[c][at];
                    }
                }
            }
        });
        made.first.push_back(std::move(first)), made.second.push_back(std::move(second));
    }
    return made;
}

} // namespace burnish
