// The report for people: charts as SVG and PNG files, and one self-contained page without network access.
#pragma once
#include <string>
#include <vector>

#include "apps/chart/rows.h"

namespace burnish {

struct ReportFile {
    std::string name, bytes;
};

Result<std::vector<ReportFile>> chart_files(const ChartReport& report); // each chart as SVG and as PNG
Result<std::string> chart_page(const ChartReport& report);

} // namespace burnish
