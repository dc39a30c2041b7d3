#include "apps/parity/report.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/field_options.h"
#include "apps/report/html.h"
#include "apps/report/json.h"

namespace burnish {
namespace {

std::string row_name(const ParityRow& row)
{
    return fmt::format("{}{} {} {}x {} {}{}", row.scene, row.view.empty() ? "" : " (" + row.view + ")", row.technique, row.msaa,
                       row.sampler, row.pipeline, row.also.empty() ? "" : " " + row.also);
}

std::string place_of(const ParityStage& stage)
{
    return stage.worst_x < 0 ? "" : fmt::format(", worst at pixel {},{}", stage.worst_x, stage.worst_y);
}

struct Total {
    ParityStage stage;
    const ParityRow* worst = nullptr;
};

// Returns sums by stage over all rows, in stage order.
std::vector<Total> totals(const ParityReport& report)
{
    std::vector<Total> sums;
    for (const ParityRow& row : report.rows)
        for (const ParityStage& stage : row.counts.stages) {
            auto at = std::find_if(sums.begin(), sums.end(), [&](const Total& t) { return t.stage.name == stage.name; });
            if (at == sums.end())
                at = sums.insert(sums.end(), Total{ParityStage{stage.name}});
            at->stage.values += stage.values;
            at->stage.words_differ += stage.words_differ;
            if (stage.max_ulp > at->stage.max_ulp) {
                at->stage.max_ulp = stage.max_ulp, at->stage.worst_x = stage.worst_x, at->stage.worst_y = stage.worst_y;
                at->worst = &row;
            }
        }
    return sums;
}

const char* name_of(const CauseShare& c)
{
    return kPixelCauseNames[static_cast<int>(c.cause)];
}

// Returns pixel counts summed and FLIP averaged over all rows. Leaves out equal pixels, where FLIP spreads errors of neighbours.
std::vector<CauseShare> total_causes(const ParityReport& report)
{
    CauseShare sums[kPixelCauses];
    const auto compared = std::count_if(report.rows.begin(), report.rows.end(), [](const ParityRow& row) { return !row.failed(); });
    for (const ParityRow& row : report.rows)
        for (const CauseShare& c : row.causes) {
            CauseShare& sum = sums[static_cast<int>(c.cause)];
            sum.cause = c.cause, sum.pixels += c.pixels, sum.edge_pixels += c.edge_pixels;
            sum.flip += c.flip / static_cast<double>(compared);
        }
    std::vector<CauseShare> present;
    for (const CauseShare& sum : sums)
        if (sum.cause != PixelCause::none && sum.pixels)
            present.push_back(sum);
    return present;
}

std::string causes_text(const ParityRow& row)
{
    std::string text;
    for (const CauseShare& c : row.causes)
        if (c.cause != PixelCause::none)
            text += fmt::format("{}{} {} (FLIP {:.2g})", text.empty() ? "" : ", ", c.pixels, name_of(c), c.flip);
    return text;
}

// Returns the sums of visibility against rays, in words.
std::string rays_text(const ParityReport& report)
{
    RayCounts sum;
    for (const ParityRow& row : report.rows)
        sum.samples += row.rays.samples, sum.differ += row.rays.differ, sum.wrong += row.rays.wrong;
    return fmt::format("Visibility by rays: {} of {} samples show another triangle, {} of them away from edges", sum.differ, sum.samples,
                       sum.wrong);
}

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 1.5rem auto; padding: 0 1rem; max-width: 90rem; }
h1 { font-size: 1.3rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: 1rem 0; }
th, td { text-align: left; padding: .15rem 1rem .15rem 0; border-bottom: 1px solid #8886; white-space: nowrap; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
tr.bad td { font-weight: 600; color: #c03; }
)";

} // namespace

bool bits_promised(const ParityRow& row)
{
    return row.sampler == "exact" && row.pipeline == "ids" && !row.gpu;
}

std::string fault_of(const ParityRow& row)
{
    if (row.failed())
        return line_of(row.error);
    if (row.rays.wrong > 0)
        return fmt::format("visibility: {} of {} samples show another triangle than a ray, away from edges, the last at pixel {},{}",
                           row.rays.wrong, row.rays.samples, row.rays.worst_x, row.rays.worst_y);
    if (!bits_promised(row))
        return row.flip_mean < kMaxFlipMean ? "" : fmt::format("mean FLIP {:.3g}, not below {}", row.flip_mean, kMaxFlipMean);
    for (const ParityStage& stage : row.counts.stages)
        if (stage.name != kVisibilityStage && !stage.equal())
            return fmt::format("{}: {} of {} words differ, by at most {} ulp{}", stage.name, stage.words_differ, stage.values,
                               stage.max_ulp, place_of(stage));
    return "";
}

std::string visibility_fault(const ParityReport& report)
{
    std::uint64_t samples = 0, differ = 0;
    for (const ParityRow& row : report.rows)
        if (bits_promised(row))
            samples += row.counts.samples, differ += row.counts.visibility_differ;
    if (static_cast<double>(differ) <= kMaxVisibilityShare * static_cast<double>(samples))
        return "";
    return fmt::format("visibility: {} of {} samples differ, more than one in a million", differ, samples);
}

bool passed(const ParityReport& report)
{
    return visibility_fault(report).empty() &&
           std::all_of(report.rows.begin(), report.rows.end(), [](const ParityRow& row) { return fault_of(row).empty(); });
}

ExitCode outcome(const ParityReport& report)
{
    const auto differs = [](const ParityRow& row) { return !row.failed() && !fault_of(row).empty(); };
    if (!visibility_fault(report).empty() || std::any_of(report.rows.begin(), report.rows.end(), differs))
        return ExitCode::differ;
    ExitCode code = ExitCode::ok;
    for (const ParityRow& row : report.rows)
        if (row.failed() && (code == ExitCode::ok || code == ExitCode::unavailable))
            code = row.error.code;
    return code;
}

std::string describe(const ParityRow& row)
{
    if (row.failed())
        return row_name(row) + ": " + line_of(row.error);
    const ParityCounts& c = row.counts;
    std::string text = row_name(row) + (row.samples_emulated ? ", samples emulated" : "") + ": ";
    const ParityStage* first = first_difference(c);
    const std::string rays = row.rays.wrong ? fmt::format("; {} samples show another triangle than rays", row.rays.wrong) : "";
    if (!first)
        return text + fmt::format("{} samples, all equal", c.samples) + rays;
    text += fmt::format("first difference in {}: {} of {} words, at most {} ulp{}", first->name, first->words_differ, first->values,
                        first->max_ulp, place_of(*first));
    if (c.visibility_differ)
        text += fmt::format("; {} of {} samples show another triangle", c.visibility_differ, c.samples);
    return text + rays +
           fmt::format("; {} pixels differ, {} of them at edges, by {}; mean FLIP {:.3g}", c.pixels_differ, c.edge_pixels_differ,
                       causes_text(row), row.flip_mean);
}

std::string stage_table(const ParityReport& report)
{
    std::string text = fmt::format("{:<16} {:>14} {:>12} {:>12}  {}\n", "stage", "values", "differ", "max ulp", "worst");
    for (const Total& t : totals(report))
        text += fmt::format("{:<16} {:>14} {:>12} {:>12}  {}\n", t.stage.name, t.stage.values, t.stage.words_differ, t.stage.max_ulp,
                            t.worst ? row_name(*t.worst) + place_of(t.stage) : "-");
    text += rays_text(report) + "\n";
    const std::vector<CauseShare> causes = total_causes(report);
    if (causes.empty())
        return text;
    text += fmt::format("\n{:<16} {:>14} {:>12} {:>12}\n", "pixels differ by", "pixels", "at edges", "mean FLIP");
    for (const CauseShare& c : causes)
        text += fmt::format("{:<16} {:>14} {:>12} {:>12.2g}\n", name_of(c), c.pixels, c.edge_pixels, c.flip);
    return text;
}

namespace {

Json parity_document(const ParityReport& report)
{
    Json json;
    json["driver"] = report.driver;
    json["device"] = report.device;
    json["api"] = report.api;
    json["processor"] = report.processor;
    json["version"] = report.version;
    json["width"] = report.width, json["height"] = report.height;
    json["passed"] = passed(report);
    json["rows"] = Json::array();
    for (const ParityRow& row : report.rows) {
        Json r;
        r["scene"] = row.scene, r["view"] = row.view, r["technique"] = row.technique, r["msaa"] = row.msaa, r["also"] = row.also;
        r["sampler"] = row.sampler, r["pipeline"] = row.pipeline, r["samples_emulated"] = row.samples_emulated, r["gpu"] = row.gpu;
        r["pixel_hash"] = fmt::format("{:016x}", row.pixel_hash);
        r["samples"] = row.counts.samples, r["visibility_differ"] = row.counts.visibility_differ;
        r["ray_samples"] = row.rays.samples, r["ray_differ"] = row.rays.differ, r["ray_wrong"] = row.rays.wrong;
        r["pixels_differ"] = row.counts.pixels_differ, r["edge_pixels_differ"] = row.counts.edge_pixels_differ;
        r["stages"] = Json::array();
        for (const ParityStage& stage : row.counts.stages) {
            Json s = {{"name", stage.name}, {"values", stage.values}, {"words_differ", stage.words_differ}, {"max_ulp", stage.max_ulp}};
            if (stage.worst_x >= 0)
                s["worst_pixel"] = Json::array({stage.worst_x, stage.worst_y});
            r["stages"].push_back(s);
        }
        const ParityStage* first = first_difference(row.counts);
        r["first_difference"] = first ? Json(first->name) : Json();
        r["flip_mean"] = row.flip_mean;
        r["causes"] = Json::array();
        for (const CauseShare& c : row.causes)
            r["causes"].push_back({{"stage", name_of(c)}, {"pixels", c.pixels}, {"edge_pixels", c.edge_pixels}, {"flip", c.flip}});
        r["error"] = row.failed() ? Json(line_of(row.error)) : Json();
        json["rows"].push_back(r);
    }
    return json;
}

} // namespace

std::string parity_json(const ParityReport& report)
{
    return json_text(parity_document(report), 2) + "\n";
}

std::string parity_csv(const ParityReport& report)
{
    return csv_text(parity_document(report)["rows"]);
}

std::string parity_junit(const ParityReport& report)
{
    const std::string visibility = visibility_fault(report);
    std::size_t failures = !visibility.empty();
    std::string cases;
    const auto add = [&](const std::string& name, const std::string& fault) {
        cases += fmt::format("  <testcase classname=\"parity\" name=\"{}\"", escaped(name));
        cases += fault.empty() ? "/>\n" : fmt::format("><failure message=\"{}\"/></testcase>\n", escaped(fault));
    };
    for (const ParityRow& row : report.rows) {
        const std::string fault = fault_of(row);
        failures += !fault.empty();
        add(row_name(row), fault);
    }
    add("visibility of all rows", visibility);
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"burnish parity, {}\" tests=\"{}\" "
                       "failures=\"{}\">\n{}</testsuite>\n",
                       escaped(report.device), report.rows.size() + 1, failures, cases);
}

std::string parity_html(const ParityReport& report)
{
    std::string stages, rows, causes;
    for (const CauseShare& c : total_causes(report))
        causes += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{:.2g}</td></tr>\n", name_of(c),
                              c.pixels, c.edge_pixels, c.flip);
    if (!causes.empty())
        causes =
            "<div class=\"scroll\"><table><tr><th>pixels differ first by</th><th>pixels</th><th>at edges</th><th>mean FLIP</th></tr>\n" +
            causes + "</table></div>\n";
    for (const Total& t : totals(report))
        stages += fmt::format("<tr{}><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n",
                              t.stage.equal() ? "" : " class=\"bad\"", t.stage.name, t.stage.values, t.stage.words_differ, t.stage.max_ulp,
                              t.worst ? escaped(row_name(*t.worst) + place_of(t.stage)) : "");
    for (const ParityRow& row : report.rows) {
        const ParityStage* first = first_difference(row.counts);
        rows += fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{}{}</td><td class=\"n\">{}</td>"
                            "<td class=\"n\">{}</td><td>{}</td><td>{}</td><td class=\"n\">{:.3g}</td></tr>\n",
                            fault_of(row).empty() ? "" : " class=\"bad\"", escaped(row.scene), escaped(row.view),
                            escaped(row.also.empty() ? row.technique : row.technique + " " + row.also), row.sampler + ", " + row.pipeline,
                            row.msaa, row.samples_emulated ? " (emulated)" : "", row.counts.samples, row.counts.visibility_differ,
                            row.failed() ? escaped(line_of(row.error))
                            : first      ? first->name
                                         : "none",
                            causes_text(row), row.flip_mean);
    }
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n"
        "<title>burnish parity</title><style>{}</style></head><body>\n<h1>Parity: {}</h1>\n<p>{}, {}, Vulkan {}; {}; burnish {}; {}x{} "
        "pixels, {} rows.</p>\n<div class=\"scroll\"><table><tr><th>stage</th><th>values</th><th>differ</th><th>max "
        "ulp</th><th>worst</th></tr>\n{}</table></div>\n<p>{}.</p>\n{}"
        "<div class=\"scroll\"><table><tr><th>scene</th><th>view</th><th>technique</th><th>sampler, "
        "pipeline</th><th>msaa</th><th>samples</th>"
        "<th>other triangle</th><th>first difference</th><th>pixels differ first by</th><th>mean "
        "FLIP</th></tr>\n{}</table></div>\n</body></html>\n",
        kStyle, passed(report) ? "as promised" : "not as promised", escaped(report.device), escaped(report.driver), report.api,
        escaped(report.processor), report.version, report.width, report.height, report.rows.size(), stages, rays_text(report), causes,
        rows);
}

} // namespace burnish
