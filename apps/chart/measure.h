// Renders and times a chart: the reference and every setting at each place. A place is a scene, an environment and optional overrides
// of the surfaces.
#pragma once
#include <memory>

#include "apps/chart/chart_checkpoint.h"
#include "apps/chart/options.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct MeasuredChart {
    ChartReport report;
    bool stopped = false; // by a signal; all rows are kept, the report is incomplete
};

Result<MeasuredChart> measure_chart(const ChartOptions& options, const std::shared_ptr<const Jobs>& jobs, ChartCheckpoint& checkpoint,
                                    Report& report);

} // namespace burnish
