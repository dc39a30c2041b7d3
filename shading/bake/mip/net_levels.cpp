#include "shading/bake/mip/net_levels.h"

#include "shading/bake/mip/texture.h"
#include "shading/bake/mipnet/pyramid.h"
#include "shading/surface/tensor.k.h"

namespace burnish {
namespace {

void put_channels(const MipPoint& p, float* to)
{
    const lobe_tensor t = projected_tensor(tensor_of_covariance(p.s));
    to[0] = p.n.x, to[1] = p.n.y, to[2] = t.a, to[3] = t.b, to[4] = t.c;
}

} // namespace

void put_net_levels(const MipSource& source, const mipnet::Weights& net, const Jobs& jobs, MipLevels& to)
{
    mipnet::Texels level0 = mipnet::make_texels(source.width(), source.height());
    jobs.parallel_for(static_cast<std::size_t>(source.height()), [&](std::size_t y, int) {
        const std::size_t width = static_cast<std::size_t>(source.width());
        std::vector<MipPoint> points(width);
        source.row(static_cast<int>(y), points.data());
        for (std::size_t x = 0; x < width; ++x) {
            float channels[mipnet::kChannels];
            put_channels(points[x], channels);
            for (std::size_t c = 0; c < mipnet::kChannels; ++c)
                level0.channel[c][y * width + x] = channels[c];
        }
    });
    const std::vector<mipnet::Texels> made = mipnet::net_pyramid(level0, net, jobs);
    to.net = mipnet::net_hash(net);
    for (std::size_t l = 1; l < made.size() && l < kMaxTextureLevels; ++l) {
        const mipnet::Texels& t = made[l];
        MipLevel level = {t.width, t.height, std::vector<MipTexel>(t.count())};
        for (std::size_t i = 0; i < t.count(); ++i)
            level.texels[i] = {t.channel[0][i], t.channel[1][i], t.channel[2][i], t.channel[3][i], t.channel[4][i]};
        to.levels.push_back(std::move(level));
    }
}

mipnet::Comparison compare_net(const MipSource& source, const mipnet::Weights& net, float kappa, bool metal, const Jobs& jobs)
{
    const mipnet::Texels sample =
        mipnet::sample_of(source.width(), source.height(), [&](int x, int y, float* texel) { put_channels(source.at(x, y), texel); });
    return mipnet::compare_on(sample, net, static_cast<double>(kappa), metal, jobs);
}

} // namespace burnish
