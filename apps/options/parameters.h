// Technique parameters, from their lines in shading/models.def: as options and in reports.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "apps/report/json.h"
#include "raster/frame/frame.h"

namespace burnish {

std::vector<Option> parameter_options(FrameDesc& to);
Json parameters_json(const FrameDesc& desc);        // {"axis_k": 1.0, ...}
std::string parameters_text(const FrameDesc& desc); // for hash keys: all digits

} // namespace burnish
