#include "shading/bake/mip/fallback.h"

#include "shading/bake/mip/evaluate.h"
#include "shading/bake/mipnet/classical.h"
#include "shading/bake/mipnet/pyramid.h"

namespace burnish::mipnet {

Texels sample_of(int width, int height, const std::function<void(int x, int y, float* texel)>& texel)
{
    constexpr int kTilesAcross = kSampleSide / kTileSide;
    // Returns the first texel of a tile in the i-th part along a side. With several tiles it is a multiple of 32, so that footprints agree
    // with the material's.
    const auto begin = [](int i, int side, Random& random) {
        const int tiles = side / kTileSide, low = i * tiles / kTilesAcross, high = (i + 1) * tiles / kTilesAcross;
        return tiles == 0 ? 0 : kTileSide * (low + (high > low ? random.below(high - low) : 0));
    };
    Texels sample = make_texels(kSampleSide, kSampleSide);
    Random random(29);
    for (int v = 0; v < kTilesAcross; ++v)
        for (int u = 0; u < kTilesAcross; ++u) {
            const int x0 = begin(u, width, random), y0 = begin(v, height, random);
            for (int y = 0; y < kTileSide; ++y)
                for (int x = 0; x < kTileSide; ++x) {
                    float channels[kChannels];
                    texel((x0 + x) % width, (y0 + y) % height, channels);
                    const std::size_t at = static_cast<std::size_t>((v * kTileSide + y) * kSampleSide + u * kTileSide + x);
                    for (std::size_t c = 0; c < kChannels; ++c)
                        sample.channel[c][at] = channels[c];
                }
        }
    return sample;
}

Comparison compare_on(const Texels& sample, const Weights& weights, double kappa, bool metal, const Jobs& jobs)
{
    const std::vector<double> l1 = mean_l1(
        {classical_pyramid(sample, Method::baseline), classical_pyramid(sample, Method::kappa, kappa), net_pyramid(sample, weights, jobs)},
        weights.shape.lobe, metal, jobs);
    return {l1[2], l1[0], l1[1]};
}

} // namespace burnish::mipnet
