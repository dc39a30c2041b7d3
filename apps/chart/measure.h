// Renders and times a chart: the reference and every setting at each place. A place is a scene, an environment and optional overrides
// of the surfaces.
#pragma once
#include <memory>
#include <optional>

#include "apps/chart/chart_checkpoint.h"
#include "apps/chart/options.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct MeasuredChart {
    ChartReport report;
    bool stopped = false;           // by a signal; all rows are kept, the report is incomplete
    std::optional<int> pieces = {}; // exit code, where pieces were listed or made in the report's place
};

// Opens the checkpoint, unless pieces alone are listed or made.
Result<MeasuredChart> measure_chart(const ChartOptions& options, const std::shared_ptr<const Jobs>& jobs, ChartCheckpoint& checkpoint,
                                    Report& report);

} // namespace burnish
