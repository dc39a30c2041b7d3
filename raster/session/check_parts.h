// Checks of session parts that come from outside the library.
#pragma once
#include "core/base/result.h"
#include "raster/session/session.h"

namespace burnish {

// Finds the first material with a mip filter, kappa or gain lobe that does not exist. check_parts() calls this function.
Status check_mip_filters(const Scene& scene, const std::string& file);

// Finds the first fault in the scene, tables, environment and albedo table, none of which may be null. The error's place names the field.
Status check_parts(const SessionParts& parts);

} // namespace burnish
