// The page of `burnish compare --sequence --html`.
#pragma once
#include <string>

#include "apps/compare/options.h"
#include "apps/report/json.h"
#include "core/base/result.h"
#include "core/jobs/jobs.h"

namespace burnish {

// Returns a self-contained page: the verdict, errors and changes over the frames, and the pictures of the worst frame. `json`: the object
// that --json writes. Reads the worst frame's files.
Result<std::string> sequence_page(const CompareOptions& options, const Status& verdict, const Json& json, const Jobs& jobs);

} // namespace burnish
