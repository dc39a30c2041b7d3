// Levels of a material's normals and lobes by one of the filters of shading/models.def. Each texel of level 0 becomes what a filter can
// average exactly, means and spreads about them, which are merged without the difference of large numbers: means m_i with spreads C_i of
// weights w_i have m = sum w_i m_i, C = sum w_i (C_i + k (m_i - m)(m_i - m)^T). No level adds an error of its own; sides that are no powers
// of two have exact footprints.
#pragma once
#include <functional>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mip/teacher.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish {

struct MipRows { // level 0
    int width, height;
    std::function<void(int y, float* to)> planes; // of a row, from the top, as MipSource::planes() has them
};
MipRows rows_of(const MipSource& source);             // which has to stay
MipRows rows_of_texels(const mipnet::Texels& texels); // the same

// From level 1 on. filter: one that averages, of those that makes_lobes().
std::vector<MipLevel> make_mean_levels(const MipRows& level0, MipFilter filter, float kappa, const Jobs& jobs);

struct MipHelp {                          // of filters that are no means
    const mipnet::Weights* net = nullptr; // null: the program's for lobes of GGX
    bool metal = false;                   // of teacher: whether the material reflects as one
    TaughtTexels advance{};
    mipnet::Lobe lobe = mipnet::Lobe::ggx_aniso; // of gains, where there is no net that says it
    Gains gains = Gains::none;
};

// MipLevels::net of a filter that takes_net(). Of teacher its last bit says whether the material reflects as a metal.
std::uint64_t levels_hash(const mipnet::Weights& net, MipFilter filter, bool metal);

// filter: one that makes_lobes(). The bytes do not depend on the number of threads.
MipLevels make_mip_levels(const MipSource& source, MipFilter filter, float kappa, const Jobs& jobs, const MipHelp& help = {});

} // namespace burnish
