// `burnish chart`: speed and errors of every technique, as figures, charts and a page.
#include <algorithm>
#include <fmt/core.h>
#include <memory>
#include <set>

#include "apps/chart/measure.h"
#include "apps/chart/page.h"
#include "apps/chart/plots.h"
#include "apps/cli/command.h"
#include "apps/cli/report.h"
#include "apps/cli/stop_signal.h"
#include "apps/live/live.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(REPORT_DIR gets report.html (one page that needs no other file), report.json, report.csv, the charts as .svg, and the pictures.
rows.json holds the finished rows, and a stopped chart continues from it. References take the longest. They are
cached beside environments.

--mip measures mip filters of normals and lobes instead of frames: FLIP, L1 and MSE of each shaded level against level 0, shaded at full
detail and averaged. It uses families of materials made in code, and materials of --maps. REPORT_DIR gets mip.json, mip.csv (one row for each
material, model, filter and level) and mip.txt, the means.

Examples:
  burnish chart -o report
  burnish chart --mip --maps textures -o report
  burnish chart lamp.glb --env workshop.hdr --env builtin:sky --size 1280x720 -o report
  burnish chart --budget 0.003,0.01,0.03 -o report
  burnish chart --techniques bent_normal,major_axis --sweep samples=2,4,8,16,32 -o report
  burnish chart --sweep samples=16 --sweep roughness=0.1,0.3,0.5,0.7 --sweep anisotropy=-0.9,-0.5,0,0.5,0.9 -o report)";

std::uint64_t pictures_with_nan(const ChartReport& chart)
{
    std::uint64_t count = 0;
    for (const ChartRow& row : chart.rows)
        count += row.measured.errors.nan_pixels != 0;
    return count;
}

// Returns true if the page can draw the rows: no option reads a further file.
bool pages_can_draw(const OptionTable& given)
{
    RenderArguments arguments;
    OptionTable render = render_option_table(arguments);
    for (const Option& option : given.options()) {
        const Option* const of_render = render.find(option.name);
        if (option.given && !option.positional() && of_render && !is_served(*of_render) && option.group != "Machine" &&
            option.group != "Output" && option.group != "Measurements" && option.name != "--size" && option.name != "--no-cache")
            return false;
    }
    return true;
}

// Returns the options without those that a later one replaces. Lights add up.
std::vector<std::pair<std::string, std::string>> last_of_each(const std::vector<std::pair<std::string, std::string>>& options)
{
    std::vector<std::pair<std::string, std::string>> kept;
    for (auto at = options.begin(); at != options.end(); ++at)
        if (at->first == "--light" || std::none_of(at + 1, options.end(), [&](const auto& later) { return later.first == at->first; }))
            kept.push_back(*at);
    return kept;
}

// Returns the scripts that draw the rows anew in the page.
std::string live_html(const ChartReport& chart, const ChartOptions& options, const OptionTable& given, Report& report)
{
    LiveWish wish;
    wish.renderer_folder = options.renderer, wish.limits = options.base.limits, wish.threads = options.base.threads;
    for (const ChartRow& row : chart.rows) {
        if (row.setting.budget > 0.0)
            continue; // pages draw one technique for all materials
        DrawRequest request;
        request.scene = row.scene, request.environment = row.env, request.width = chart.error_width, request.height = chart.error_height;
        for (const auto& [name, value] : {std::pair{"--glass", "interface"}, {"--floor", "off"}, {"--resolve", "linear"}})
            request.options.emplace_back(name, value); // as charts have them; the last value of a name counts
        add_served(given, request);
        request.options.emplace_back("--technique", row.setting.technique);
        if (row.setting.sampled)
            request.options.emplace_back("--samples", std::to_string(row.setting.samples));
        if (row.cell.roughness)
            request.options.emplace_back("--roughness", fmt::format("{}", *row.cell.roughness));
        if (row.cell.anisotropy)
            request.options.emplace_back("--anisotropy", fmt::format("{}", *row.cell.anisotropy));
        for (const auto& [name, value] : row.cell.others)
            request.options.emplace_back("--" + name, value);
        request.options = last_of_each(request.options);
        wish.rows.push_back({row.key, std::move(request)});
    }
    const Result<LiveParts> parts = pages_can_draw(given) ? live_parts(wish) : Result<LiveParts>(LiveParts{});
    if (!parts || parts->html.empty() || !parts->left_out.empty())
        report.warning("--live: the page cannot draw " + std::string(parts && !parts->html.empty() ? "some rows" : "the rows") +
                       (!parts                    ? ": " + parts.error().line()
                        : parts->left_out.empty() ? ": an option reads a file"
                                                  : ": " + parts->left_out.front().second.line()));
    return parts ? parts->html : "";
}

// Returns the fastest settings within errors, for a chart of one place. The page has the settings of several places.
std::vector<std::string> wanted_lines(const ChartReport& chart)
{
    std::vector<const ChartRow*> rows;
    for (const ChartRow& row : chart.rows)
        rows.push_back(&row);
    return chart.references.size() == 1 ? wanted_settings(rows, chart.references.begin()->second.noise, chart.wanted)
                                        : std::vector<std::string>();
}

Status write_report(const ChartReport& chart, const std::string& live, const ChartCheckpoint& checkpoint, Report& report)
{
    std::vector<ReportFile> files = chart_files(chart);
    files.push_back({"report.json", report_json(chart)});
    files.push_back({"report.csv", report_csv(chart)});
    Result<std::string> page = chart_page(chart, live);
    BN_TRY(page);
    files.push_back({"report.html", std::move(*page)});
    std::set<std::string> used;
    for (const ReportFile& file : files) {
        used.insert(checkpoint.file(file.name));
        BN_TRY(write_file(checkpoint.file(file.name), file.bytes));
        report.detail("wrote", checkpoint.file(file.name));
    }
    for (const ChartRow& row : chart.rows)
        used.insert({row.picture, row.error_map});
    for (const auto& [place, reference] : chart.references)
        used.insert(reference.picture);
    checkpoint.remove_stale(used);
    report.event("wrote", checkpoint.file("report.html"));
    return {};
}

int run_chart(const ChartArguments& arguments, const OptionTable& given)
{
    if (arguments.plain.mip)
        return chart_mips(arguments, given);
    for (const char* option : {"--maps", "--per-set", "--two-lobes"})
        if (given.given(option))
            return fail(usage_error(option, "is of --mip"));
    if (const Status pieces = check_piece_options(arguments.plain.pieces); !pieces)
        return fail(pieces.error());
    const Result<ChartOptions> checked = check_chart_options(arguments, given);
    if (!checked)
        return fail(checked.error());
    const ChartOptions& options = *checked;
    if (options.live)
        if (const Status found = check_renderer(options.renderer); !found)
            return fail(found.error());
    Report report(options.base.quiet, options.base.verbosity);
    ChartCheckpoint checkpoint;
    const auto jobs = std::make_shared<const Jobs>(options.base.threads);
    const Result<MeasuredChart> measured = measure_chart(options, jobs, checkpoint, report);
    if (!measured)
        return fail(measured.error());
    if (measured->pieces)
        return *measured->pieces;
    if (measured->stopped) {
        report.event("stopped", fmt::format("the same command goes on from {}; no report was written", checkpoint.file("rows.json")));
        return 128 + stop_signal(); // as a shell reports a process ended by a signal
    }
    const ChartReport& chart = measured->report;
    for (const ChartRow& row : chart.rows)
        report.detail("row", describe(row));
    for (const std::string& line : wanted_lines(chart))
        report.event("wanted", line);
    if (const std::optional<double> others = chart.machine.others; others.value_or(0.0) > kBusy)
        report.warning(
            fmt::format("other programs took {:.0f} % of the cores while frames were timed: times are too long", 100.0 * *others));
    const std::string live = options.live ? live_html(chart, options, given, report) : "";
    if (const Status written = write_report(chart, live, checkpoint, report); !written)
        return fail(written.error());
    if (const std::uint64_t bad = pictures_with_nan(chart))
        return fail(
            Error{ExitCode::not_finite, options.folder, "", fmt::format("{} of {} pictures hold NaN or Inf", bad, chart.rows.size())});
    return 0;
}

} // namespace

Command chart_command()
{
    auto arguments = std::make_shared<ChartArguments>();
    return {"chart", "Chart the speed of techniques against their accuracy", chart_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_chart(*arguments, given); }};
}

} // namespace burnish
