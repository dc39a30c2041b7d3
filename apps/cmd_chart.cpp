// `burnish chart`: what every technique costs and what it gets wrong, as figures, as charts, as a page.
#include <fmt/format.h>
#include <memory>
#include <set>

#include "apps/chart_measure.h"
#include "apps/chart_page.h"
#include "apps/chart_plots.h"
#include "apps/command.h"
#include "apps/report.h"
#include "apps/stop_signal.h"
#include "core/image/image_io.h"

namespace burnish {
namespace {

std::uint64_t pictures_with_nan(const ChartReport& chart)
{
    std::uint64_t count = 0;
    for (const ChartRow& row : chart.rows)
        count += row.measured.errors.nan_pixels != 0;
    return count;
}

Status write_report(const ChartReport& chart, const Keeper& keeper, Report& report)
{
    Result<std::vector<ReportFile>> files = chart_files(chart);
    if (!files)
        return files.error();
    files->push_back({"report.json", report_json(chart)});
    Result<std::string> page = chart_page(chart);
    if (!page)
        return page.error();
    files->push_back({"report.html", std::move(*page)});
    std::set<std::string> used;
    for (const ReportFile& file : *files) {
        used.insert(keeper.file(file.name));
        if (const Status written = write_file(keeper.file(file.name), file.bytes); !written)
            return written;
        report.detail("wrote", keeper.file(file.name));
    }
    for (const ChartRow& row : chart.rows)
        used.insert({row.picture, row.error_map});
    for (const auto& [place, reference] : chart.references)
        used.insert(reference.picture);
    keeper.remove_stale(used);
    report.event("wrote", keeper.file("report.html"));
    return {};
}

int run_chart(const ChartArguments& arguments)
{
    const Result<ChartOptions> checked = check_chart_options(arguments);
    if (!checked)
        return fail(checked.error());
    const ChartOptions& options = *checked;
    Report report(options.base.quiet, options.base.verbosity);
    Result<Keeper> keeper = Keeper::open(options.folder, report);
    if (!keeper)
        return fail(keeper.error());
    const Jobs jobs(options.base.threads);
    const Result<MeasuredChart> measured = measure_chart(options, jobs, *keeper, report);
    if (!measured)
        return fail(measured.error());
    if (measured->stopped) {
        report.event("stopped", fmt::format("the same command goes on from {}; no report was written", keeper->file("rows.json")));
        return 128 + stop_signal(); // as a shell reports a process that a signal ended
    }
    const ChartReport& chart = measured->report;
    for (const ChartRow& row : chart.rows)
        report.detail("row", describe(row));
    if (const Status written = write_report(chart, *keeper, report); !written)
        return fail(written.error());
    if (const std::uint64_t bad = pictures_with_nan(chart))
        return fail(Error{ExitCode::not_finite, options.folder, "", fmt::format("{} of {} pictures hold NaN or Inf", bad, chart.rows.size())});
    return 0;
}

} // namespace

Command add_chart(CLI::App& program)
{
    CLI::App* app = program.add_subcommand("chart", "Chart the speed of techniques against their accuracy");
    auto arguments = std::make_shared<ChartArguments>();
    add_chart_options(*app, *arguments);
    return {app, [arguments] { return run_chart(*arguments); }};
}

} // namespace burnish
