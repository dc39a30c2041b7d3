// Tables that are made otherwise than the program's own, for entries to break on: --ltc-table trial:NAME, --as-table trial:NAME.
#pragma once
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "shading/bake/ltc/shipped.h"
#include "shading/bake/tables/phong_files.h"

namespace burnish {

bool is_trial_table(const std::string& path);
// As `burnish bake ltc --steps 0` makes them: trial:unaligned with --no-align --interpolate matrix, trial:unsymmetric with --no-symmetry as
// well, trial:inverse with --interpolate inverse, but fitted by fewer directions. Made once. Errors: no such name.
Result<std::shared_ptr<const ltc::ShadingTables>> trial_table(const std::string& path, const Jobs& jobs);

// As `burnish bake half-vectors --size 256x256` makes them, but by exponents that are not rounded, for the lobe of alpha_lin and eta, each
// in [0,1]: trial:floats in .exr, trial:eight-bits in .png. Errors: no such name.
Result<std::shared_ptr<const PhongFiles>> trial_half_vectors(const std::string& path, double alpha_lin, double eta);

} // namespace burnish
