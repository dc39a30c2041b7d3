// Mip levels of a material's normals and lobes, by a filter in shading/models.def. Each texel of level 0 becomes means and spreads about
// them, which a filter can average exactly. The merge does not subtract large numbers: means m_i with spreads C_i and weights w_i give m =
// sum w_i m_i, C = sum w_i (C_i + k (m_i - m)(m_i - m)^T). So no level adds an error. Sides that are not powers of two have exact
// footprints.
#pragma once
#include <functional>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/optimised_mip.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish {

struct MipRows { // level 0
    int width, height;
    std::function<void(int y, float* to)> planes; // writes the planes of a row, from the top, in the layout of MipSource::planes()
};
MipRows rows_of(const MipSource& source);             // the source must outlive the rows
MipRows rows_of_texels(const mipnet::Texels& texels); // the texels must outlive the rows

// Makes levels from 1 on. filter: one that averages, among those that makes_lobes().
std::vector<MipLevel> make_mean_levels(const MipRows& level0, MipFilter filter, float kappa, const Jobs& jobs);

struct MipHelp {                          // for filters that are not means
    const mipnet::Weights* net = nullptr; // null: the built-in net for GGX lobes
    bool metal = false;                   // for optimised levels: the material reflects as a metal
    OptimisedTexels advance{};
    mipnet::Lobe lobe = mipnet::Lobe::ggx_aniso; // for gains, if no net names the lobe
    Gains gains = Gains::none;
};

// Returns MipLevels::net for a filter that takes_net(). For optimised levels, the last bit tells whether the material reflects as a metal.
std::uint64_t levels_hash(const mipnet::Weights& net, MipFilter filter, bool metal);

// Makes all levels. filter: one that makes_lobes(). The bytes do not depend on the number of threads.
MipLevels make_mip_levels(const MipSource& source, MipFilter filter, float kappa, const Jobs& jobs, const MipHelp& help = {});

} // namespace burnish
