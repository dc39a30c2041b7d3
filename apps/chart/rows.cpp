#include "apps/chart/rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/options/parameters.h"
#include "apps/render/stats.h"
#include "apps/report/json.h"
#include "core/base/text.h"

namespace burnish {
namespace {

Json override_json(const std::optional<float>& value)
{
    return value ? Json(shortest_decimal(*value)) : Json();
}

Json load_json(const std::optional<double>& share)
{
    return share ? Json(*share) : Json();
}

Json errors_json(const RowErrors& e)
{
    return {{"flip_mean", e.flip_mean},       {"flip_p99", e.flip_p99},       {"rel_mse", e.rel_mse},
            {"max_abs", e.max_abs},           {"pattern_rms", e.pattern_rms}, {"quad_ratio_x", e.quad_ratio_x},
            {"quad_ratio_y", e.quad_ratio_y}, {"nan_pixels", e.nan_pixels}};
}

Json settings_json(const ChartReport& report, const ChartRow& row)
{
    Json json = {{"samples", row.setting.sampled ? Json(row.setting.samples) : Json()},
                 {"budget", row.setting.budget > 0.0 ? Json(row.setting.budget) : Json()},
                 {"roughness", override_json(row.cell.roughness)},
                 {"anisotropy", override_json(row.cell.anisotropy)},
                 {"msaa", report.msaa},
                 {"width", report.width},
                 {"height", report.height},
                 {"error_width", report.error_width},
                 {"error_height", report.error_height}};
    FrameDesc drawn = report.frame;
    row.setting.planned.put(drawn);
    json.update(parameters_json(drawn));
    for (const auto& [option, value] : row.cell.others) {
        const std::optional<double> number = number_in(value);
        std::string key = option;
        std::replace(key.begin(), key.end(), '-', '_');
        json[key] = number ? Json(*number) : Json(value);
    }
    return json;
}

Json noise_json(const ReferenceNoise& noise)
{
    return {{"samples", noise.samples}, {"relative_error", noise.relative_error}, {"flip_noise", noise.flip}};
}

Json row_json(const ChartReport& report, const ChartRow& row)
{
    Json json = {
        {"scene", row.scene},      {"env", row.env},        {"technique", row.setting.technique}, {"settings", settings_json(report, row)},
        {"ms_median", ms_of(row)}, {"ms_p95", p95_of(row)}, {"cpu_ms_median", cpu_ms_of(row)}};
    json.update(errors_json(row.measured.errors));
    json["pareto"] = row.pareto;
    return json;
}

} // namespace

std::optional<double> number_in(const std::string& value)
{
    double number = 0.0;
    const std::from_chars_result read = std::from_chars(value.data(), value.data() + value.size(), number);
    return read.ec == std::errc() && read.ptr == value.data() + value.size() && std::isfinite(number) ? std::optional(number)
                                                                                                      : std::nullopt;
}

std::string place(const ChartRow& row)
{
    return row.scene + "\n" + row.env + "\n" + describe(row.cell);
}

double flip_of(const ChartRow& row)
{
    return row.measured.errors.flip_mean;
}

double ms_of(const ChartRow& row)
{
    return row.measured.ms.empty() ? std::numeric_limits<double>::quiet_NaN() : median(row.measured.ms);
}

double p95_of(const ChartRow& row)
{
    return row.measured.ms.empty() ? std::numeric_limits<double>::quiet_NaN() : percentile_95(row.measured.ms);
}

double cpu_ms_of(const ChartRow& row)
{
    return row.measured.cpu_ms.empty() ? std::numeric_limits<double>::quiet_NaN() : median(row.measured.cpu_ms);
}

std::vector<bool> pareto_front(const std::vector<std::pair<double, double>>& points)
{
    std::vector<bool> front(points.size());
    const auto finite = [](const auto& p) { return std::isfinite(p.first) && std::isfinite(p.second); };
    for (std::size_t i = 0; i < points.size(); ++i) {
        front[i] = finite(points[i]);
        for (const auto& other : points)
            if (finite(other) && other.first <= points[i].first && other.second <= points[i].second && other != points[i])
                front[i] = false;
    }
    return front;
}

void mark_pareto(std::vector<ChartRow>& rows)
{
    std::map<std::string, std::vector<std::size_t>> places;
    for (std::size_t i = 0; i < rows.size(); ++i)
        places[place(rows[i])].push_back(i);
    for (const auto& [name, members] : places) {
        std::vector<std::pair<double, double>> points;
        for (const std::size_t i : members)
            points.emplace_back(ms_of(rows[i]), flip_of(rows[i]));
        const std::vector<bool> front = pareto_front(points);
        for (std::size_t k = 0; k < members.size(); ++k)
            rows[members[k]].pareto = front[k];
    }
}

std::vector<std::string> wanted_settings(const std::vector<const ChartRow*>& rows, const ReferenceNoise& noise, std::vector<double> errors)
{
    std::vector<std::string> lines;
    std::sort(errors.begin(), errors.end(), std::greater<>());
    for (const double error : errors) {
        const ChartRow* best = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (const ChartRow* row : rows) {
            least = flip_of(*row) < least ? flip_of(*row) : least;
            if (!row->measured.ms.empty() && flip_of(*row) <= error && (!best || ms_of(*row) < ms_of(*best)))
                best = row;
        }
        if (rows.empty() || rows.front()->measured.ms.empty())
            return {};
        std::string line = fmt::format("error {:g}: ", error);
        line += best ? fmt::format("{}, {:.3g} ms, FLIP {:.3g}", describe(best->setting), ms_of(*best), flip_of(*best))
                     : fmt::format("none of these settings; the least is {:.3g}", least);
        lines.push_back(line + (noise.flip > error ? "; the reference's own noise is larger" : ""));
    }
    return lines;
}

std::string chart_results_json(const ChartResults& results)
{
    Json json = {{"kept_version", kChartResultsVersion},
                 {"rows", Json::object()},
                 {"references", Json::object()},
                 {"other_load", load_json(results.others)}};
    for (const auto& [key, noise] : results.references)
        json["references"][key] = noise_json(noise);
    for (const auto& [key, m] : results.rows) {
        Json row = m.has_errors ? errors_json(m.errors) : Json::object();
        row["ms"] = m.ms;
        row["cpu_ms"] = m.cpu_ms;
        json["rows"][key] = row;
    }
    return json_text(json, 1) + "\n";
}

std::string report_json(const ChartReport& report)
{
    Json json;
    json["machine"] = {{"version", report.machine.version},
                       {"processor", report.machine.processor},
                       {"isa", report.machine.isa},
                       {"threads", report.machine.threads},
                       {"other_load", load_json(report.machine.others)}};
    json["runs"] = report.runs;
    json["reference_samples"] = report.reference_samples;
    json["metric"] = report.display_flip ? "flip" : "flip-hdr";
    json["references"] = Json::array();
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const ChartRow& row = report.rows[i];
        if (i > 0 && place(report.rows[i - 1]) == place(row))
            continue; // rows of a place are adjacent
        Json settings = settings_json(report, row);
        Json reference = {
            {"scene", row.scene}, {"env", row.env}, {"roughness", settings["roughness"]}, {"anisotropy", settings["anisotropy"]}};
        reference.update(noise_json(report.references.at(place(row)).noise));
        json["references"].push_back(reference);
    }
    json["rows"] = Json::array();
    for (const ChartRow& row : report.rows)
        json["rows"].push_back(row_json(report, row));
    return json_text(json, 1) + "\n";
}

std::string report_csv(const ChartReport& report)
{
    Json rows = Json::array();
    for (const ChartRow& row : report.rows)
        rows.push_back(row_json(report, row));
    return csv_text(rows);
}

} // namespace burnish
