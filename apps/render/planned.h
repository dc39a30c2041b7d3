// --budget, --plan and --verify: frames by a plan.
#pragma once
#include <optional>

#include "apps/cli/report.h"
#include "apps/options/options.h"
#include "apps/plan/plan.h"
#include "apps/render/stats.h"
#include "raster/session/session.h"

namespace burnish {

// Plans the frame by --budget, or reads the plan of --plan, and puts it into `desc`. Reports the choices, and writes --plan-out. Returns
// nothing without these options. The plan is the same on every machine, backend and number of threads.
Result<std::optional<Plan>> plan_frame(const RenderOptions& options, FrameDesc& desc, Session& session, Report& report);

// Notes the plan's figures for --stats. desc: from plan_frame().
void note_plan(const RenderOptions& options, const FrameDesc& desc, const std::optional<Plan>& plan, RenderFigures& figures);

// Renders the reference of the frame, and prints the picture's mean HDR-FLIP beside the plan's prediction (--verify).
Status verify_plan(const RenderOptions& options, const FrameDesc& desc, const Session& session, const Image& color,
                   const std::optional<Plan>& plan, Report& report);

} // namespace burnish
