// Tables baked with other methods than the built-in ones, for entries to fail on: --ltc-table trial:NAME, --as-table trial:NAME.
#pragma once
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "shading/bake/ltc/shipped.h"
#include "shading/bake/tables/phong_files.h"

namespace burnish {

bool is_trial_table(const std::string& path);
// Makes a table as `burnish bake ltc --steps 0` does, but with fewer directions in the fit. trial:unaligned has --no-align --interpolate
// matrix, trial:unsymmetric also --no-symmetry, trial:inverse has --interpolate inverse. Each is made once. Fails for other names.
Result<std::shared_ptr<const ltc::ShadingTables>> trial_table(const std::string& path, const Jobs& jobs);

// Makes a table as `burnish bake half-vectors --size 256x256` does, but with unrounded exponents, for the lobe with roughness and eta in
// [0,1]. trial:floats is like .exr, trial:eight-bits like .png. Fails for other names.
Result<std::shared_ptr<const PhongFiles>> trial_half_vectors(const std::string& path, double roughness, double eta);

} // namespace burnish
