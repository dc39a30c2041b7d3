#include "shading/bake/mip/net_levels.h"

#include <algorithm>

#include "core/simd/dispatch.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/mean_fns.h"
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

mipnet::TexelRows bands_of(const MipRows& rows)
{
    return {rows.width, rows.height, [rows](int first, int count, mipnet::Texels& to) {
                const std::size_t width = static_cast<std::size_t>(rows.width), stride = mip::row_stride(width);
                std::vector<float> points(mip::kPointPlanes * stride), tensors(mipnet::kChannels * stride);
                for (int y = 0; y < count; ++y) {
                    rows.planes(first + y, points.data());
                    pick<mip::Fns>().tensors({width, stride, points.data(), tensors.data()});
                    for (std::size_t c = 0; c < mipnet::kChannels; ++c)
                        std::copy_n(tensors.begin() + static_cast<std::ptrdiff_t>(c * stride), width,
                                    to.channel[c].begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * width));
                }
            }};
}

// Converts levels. Frees each level once it is written.
void put_levels(std::vector<mipnet::Texels> levels, MipLevels& to)
{
    for (std::size_t l = 0; l < levels.size() && l + 1 < kMaxTextureLevels; ++l) {
        const mipnet::Texels t = std::move(levels[l]);
        MipLevel level = {t.width, t.height, std::vector<MipTexel>(t.count())};
        for (std::size_t i = 0; i < t.count(); ++i)
            level.texels[i] = {t.channel[0][i], t.channel[1][i], t.channel[2][i], t.channel[3][i], t.channel[4][i]};
        to.levels.push_back(std::move(level));
    }
}

} // namespace

std::uint64_t levels_hash(const mipnet::Weights& net, MipFilter filter, bool metal)
{
    const std::uint64_t hash = mipnet::net_hash(net);
    return filter == kMipFilter_teacher ? (hash & ~std::uint64_t{1}) | (metal ? 1u : 0u) : hash;
}

void put_net_levels(const MipRows& level0, const mipnet::Weights& net, const Jobs& jobs, MipLevels& to)
{
    to.net = levels_hash(net, kMipFilter_mipnet, false);
    put_levels(mipnet::net_levels(bands_of(level0), net, jobs), to);
}

// Search from several starts: the net's levels and four filters' levels
void put_optimised_levels(const MipRows& level0_rows, const mipnet::Weights& net, const MipHelp& help, const Jobs& jobs, MipLevels& to)
{
    const mipnet::TexelRows rows = bands_of(level0_rows);
    mipnet::Texels level0 = mipnet::make_texels(level0_rows.width, level0_rows.height);
    rows.rows(0, level0_rows.height, level0);
    mipnet::make_valid(level0);
    std::vector<std::vector<mipnet::Texels>> starts = {mipnet::net_levels(rows, net, jobs)};
    starts[0].resize(std::min(starts[0].size(), static_cast<std::size_t>(kMaxTextureLevels - 1)));
    for (const MipFilter filter : {kMipFilter_baseline, kMipFilter_kappa, kMipFilter_leadr, kMipFilter_ssgt}) {
        starts.emplace_back();
        for (const MipLevel& level : make_mean_levels(level0_rows, filter, to.kappa, jobs))
            starts.back().push_back(mip_level_texels(level));
    }
    to.net = levels_hash(net, kMipFilter_teacher, help.metal);
    put_levels(optimised_levels(level0, starts, mip_error_surface(net.shape.lobe, help.metal), jobs, help.advance), to);
}

mipnet::Comparison compare_net(const MipSource& source, const mipnet::Weights& net, float kappa, bool metal, const Jobs& jobs)
{
    const mipnet::Texels sample =
        mipnet::sample_of(source.width(), source.height(), [&](int x, int y, float* texel) { put_channels(source.at(x, y), texel); });
    return mipnet::compare_on(sample, net, static_cast<double>(kappa), metal, jobs);
}

} // namespace burnish
