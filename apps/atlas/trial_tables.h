// Tables of transformed cosines that are made otherwise than the program's own, for entries to break on: --ltc-table trial:NAME.
#pragma once
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "shading/bake/ltc/shipped.h"

namespace burnish {

bool is_trial_table(const std::string& path);
// As `burnish bake ltc --steps 0` makes them: trial:unaligned with --no-align --interpolate matrix, trial:unsymmetric with --no-symmetry as
// well, trial:inverse with --interpolate inverse. Made once. Errors: no such name.
Result<std::shared_ptr<const ltc::ShadingTables>> trial_table(const std::string& path, const Jobs& jobs);

} // namespace burnish
