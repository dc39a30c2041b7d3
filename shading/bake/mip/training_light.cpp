#include "shading/bake/mip/training_light.h"

#include "core/simd/dispatch.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mipnet/batch.h"
#include "shading/bake/mipnet/net.h"

namespace burnish {

TrainingLight training_light(const MipErrorSurface& surface)
{
    const std::size_t pairs = kTrainingPairs;
    TrainingLight l = {std::vector<float>(6 * pairs), std::vector<float>(pairs), std::vector<float>(mipnet::kLightRows * pairs)};
    mipnet::Random random(31);
    for (std::size_t p = 0; p < pairs; ++p) {
        mipnet::put_pair(random, l.directions.data() + p, pairs);
        l.intensity[p] = static_cast<float>(random.between(1.0, 10.0));
    }
    pick<mipnet::MipOptimiserFns>().light(
        {surface.lobe, kTrainingPairs, surface.f0, surface.diffuse, l.directions.data(), l.intensity.data(), l.rows.data()});
    return l;
}

FootprintAxis::FootprintAxis(int i, int source, int target)
{
    for (const TexelShare& share : shares_of(i, source, target))
        at.push_back(share.at), weight.push_back(static_cast<float>(share.weight));
}

void gather_light(const mipnet::Texels& texels, const MipErrorSurface& surface, const TrainingLight& light, const FootprintAxis& across,
                  const FootprintAxis& down, float* to)
{
    mipnet::GatherWork work = {surface.lobe,
                               kTrainingPairs,
                               light.rows.data(),
                               {},
                               static_cast<std::size_t>(texels.width),
                               across.at.data(),
                               down.at.data(),
                               across.weight.data(),
                               down.weight.data(),
                               static_cast<int>(across.at.size()),
                               static_cast<int>(down.at.size()),
                               to};
    for (std::size_t c = 0; c < mipnet::kChannels; ++c)
        work.planes[c] = texels.channel[c].data();
    pick<mipnet::MipOptimiserFns>().gather(work);
}

} // namespace burnish
