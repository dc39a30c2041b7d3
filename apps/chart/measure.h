// Renders and times what a chart shows: a reference and every setting at each place, which is a scene under an environment, its
// surfaces overridden or not.
#pragma once
#include <memory>

#include "apps/chart/keeper.h"
#include "apps/chart/options.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct MeasuredChart {
    ChartReport report;
    bool stopped = false; // by a signal, with everything kept; the report is not complete
};

Result<MeasuredChart> measure_chart(const ChartOptions& options, const std::shared_ptr<const Jobs>& jobs, Keeper& keeper, Report& report);

} // namespace burnish
