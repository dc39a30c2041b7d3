// The report for people: charts as SVG files, and one page that needs nothing else and no network.
#pragma once
#include <string>
#include <vector>

#include "apps/chart/rows.h"

namespace burnish {

struct ReportFile {
    std::string name, bytes;
};

std::vector<ReportFile> chart_files(const ChartReport& report); // each chart as SVG
// live: scripts of a page with the renderer inside, by the rows' keys; or "".
Result<std::string> chart_page(const ChartReport& report, const std::string& live = "");

} // namespace burnish
