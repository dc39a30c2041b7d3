// One picture in bands of rows: memory holds one band, and files are written row by row.
#pragma once
#include "apps/cli/report.h"
#include "apps/options/options.h"
#include "apps/render/stats.h"
#include "raster/session/session.h"

namespace burnish {

// Draws the picture, or lists, makes or merges its bands as pieces. Writes the outputs and the statistics. desc: its first window, seen by
// the picture's view. figures: the session's figures so far. Returns the exit code.
int run_bands(const RenderArguments& arguments, const OptionTable& given, const RenderOptions& options, const FrameDesc& desc,
              Session& session, RenderFigures figures, Report& report);

} // namespace burnish
