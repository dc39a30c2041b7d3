// Levels of a material's normals and lobes by one of the filters of shading/models.def. Each texel of level 0 becomes what a filter can
// average exactly, means and spreads about them, which are merged without the difference of large numbers: means m_i with spreads C_i of
// weights w_i have m = sum w_i m_i, C = sum w_i (C_i + k (m_i - m)(m_i - m)^T). No level adds an error of its own; sides that are no powers
// of two have exact footprints.
#pragma once
#include "core/jobs/jobs.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/source.h"

namespace burnish {

// filter: one that makes_lobes(). net: of filter mipnet, which is no mean; null: the program's for lobes of GGX. The bytes do not depend on
// the number of threads.
MipLevels make_mip_levels(const MipSource& source, MipFilter filter, float kappa, const Jobs& jobs, const mipnet::Weights* net = nullptr);

} // namespace burnish
