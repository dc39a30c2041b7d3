#include "shading/bake/mip/evaluate.h"

namespace burnish::mipnet {
namespace {

constexpr int kFirstPair = 48, kTileTimes = 24; // pairs below the first judge what is chosen by these

} // namespace

std::vector<std::vector<Texels>> evaluated_levels(const std::vector<std::vector<Texels>>& pyramids)
{
    std::vector<std::vector<Texels>> levels;
    for (const std::vector<Texels>& pyramid : pyramids)
        levels.emplace_back(pyramid.begin() + 1, pyramid.begin() + 1 + kEvaluatedLevels);
    return levels;
}

std::vector<double> mean_l1(const std::vector<std::vector<Texels>>& pyramids, Lobe lobe, bool metal, const Jobs& jobs)
{
    const Texels& level0 = pyramids.front().front();
    const MipErrorPairs pairs = {.first = kFirstPair, .times = kTileTimes, .tiles = level0.width / kTileSide, .lamps = 0};
    std::vector<double> means;
    for (const std::vector<MipError>& levels :
         mip_errors(level0, evaluated_levels(pyramids), mip_error_surface(lobe, metal), jobs, pairs)) {
        means.push_back(0.0);
        for (const MipError& level : levels)
            means.back() += level.l1 / kEvaluatedLevels;
    }
    return means;
}

} // namespace burnish::mipnet
