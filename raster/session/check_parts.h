// Checks of session parts that come from outside the library.
#pragma once
#include "core/base/result.h"
#include "raster/session/session.h"

namespace burnish {

// Finds the first fault of scene, tables, environment and albedo table, which are all there; the error's place names the field.
Status check_parts(const SessionParts& parts);

// The error of a session whose contents were moved to another object.
inline Error moved_away()
{
    return {ExitCode::usage, "", "", "was moved to another object", "Session"};
}

} // namespace burnish
