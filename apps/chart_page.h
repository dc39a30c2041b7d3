// The report for people: charts as SVG files, and one page that needs nothing else and no network.
#pragma once
#include <string>
#include <vector>

#include "apps/chart_rows.h"

namespace burnish {

struct ReportFile {
    std::string name, text;
};

std::vector<ReportFile> chart_svgs(const ChartReport& report);
Result<std::string> chart_page(const ChartReport& report);

} // namespace burnish
