// Invented reports for tests.
#pragma once
#include "apps/chart/rows.h"

namespace burnish::test {

inline ChartRow row(const std::string& key, const std::string& technique, int samples, double ms, double flip)
{
    ChartRow row;
    row.key = key;
    row.scene = "a<b>&\"c\".glb"; // needs escaping on a page
    row.env = "builtin:studio";
    row.setting = {technique, samples, technique != "bent_normal" && technique != "split_isotropic"};
    row.measured.has_errors = true;
    row.measured.errors = {flip, 2.0 * flip, flip * flip, 1.0, 0, 0.04, 1.1, 0.9};
    row.measured.ms = {ms, ms, 1.2 * ms};
    row.measured.cpu_ms = {2.0 * ms, 2.0 * ms, 2.0 * ms};
    return row;
}

// Returns a report on two techniques, one with two sample counts.
inline ChartReport report()
{
    ChartReport report;
    report.machine = {"1", "a processor", "avx2", 2};
    report.width = 64, report.height = 36, report.msaa = 4, report.runs = 3;
    report.error_width = 32, report.error_height = 18;
    report.rows = {row("0a", "bent_normal", 1, 2.0, 0.25), row("0b", "major_axis", 4, 3.0, 0.125),
                   row("0c", "major_axis", 16, 5.0, 0.0625)};
    report.references[place(report.rows[0])] = {"", {4096, 0.01, 0.003}};
    return report;
}

} // namespace burnish::test
