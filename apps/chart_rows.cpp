#include "apps/chart_rows.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/render_stats.h"

namespace burnish {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kKeptVersion = 2; // of the file's layout

// Names of files are bytes to the operating system: what is not UTF-8 is replaced instead of ending the program.
std::string dump(const Json& json)
{
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json number_or_null(double value)
{
    return std::isfinite(value) ? Json(value) : Json();
}

double number_of(const Json& json)
{
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Json errors_json(const RowErrors& e)
{
    return {{"flip_mean", number_or_null(e.flip_mean)},
            {"flip_p99", number_or_null(e.flip_p99)},
            {"rel_mse", number_or_null(e.rel_mse)},
            {"max_abs", number_or_null(e.max_abs)},
            {"nan_pixels", e.nan_pixels}};
}

Json settings_json(const ChartReport& report, const ChartRow& row)
{
    const auto or_null = [](const std::optional<float>& v) { return v ? Json(*v) : Json(); };
    return {{"samples", row.setting.sampled ? Json(row.setting.samples) : Json()},
            {"roughness", or_null(row.cell.roughness)},
            {"anisotropy", or_null(row.cell.anisotropy)},
            {"msaa", report.msaa},
            {"width", report.width},
            {"height", report.height},
            {"error_width", report.error_width},
            {"error_height", report.error_height}};
}

Json noise_json(const ReferenceNoise& noise)
{
    return {{"samples", noise.samples}, {"relative_error", number_or_null(noise.relative_error)}, {"flip_noise", number_or_null(noise.flip)}};
}

Json row_json(const ChartReport& report, const ChartRow& row)
{
    Json json = {{"scene", row.scene},
                 {"env", row.env},
                 {"technique", row.setting.technique},
                 {"settings", settings_json(report, row)},
                 {"ms_median", ms_of(row)},
                 {"ms_p95", p95_of(row)},
                 {"cpu_ms_median", median(row.measured.cpu_ms)}};
    json.update(errors_json(row.measured.errors));
    json["pareto"] = row.pareto;
    return json;
}

} // namespace

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
    return median(row.measured.ms);
}

double p95_of(const ChartRow& row)
{
    return percentile_95(row.measured.ms);
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

std::string kept_json(const Kept& kept)
{
    Json json = {{"kept_version", kKeptVersion}, {"rows", Json::object()}, {"references", Json::object()}};
    for (const auto& [key, noise] : kept.references)
        json["references"][key] = noise_json(noise);
    for (const auto& [key, m] : kept.rows) {
        Json row = m.has_errors ? errors_json(m.errors) : Json::object();
        row["ms"] = m.ms;
        row["cpu_ms"] = m.cpu_ms;
        json["rows"][key] = row;
    }
    return dump(json);
}

Result<Kept> parse_kept(const std::string& text, const std::string& file)
{
    try {
        const Json json = Json::parse(text);
        Kept kept;
        if (json.at("kept_version") != kKeptVersion)
            return kept;
        for (const auto& [key, noise] : json.at("references").items())
            kept.references[key] = {noise.at("samples").get<std::uint64_t>(), number_of(noise.at("relative_error")),
                                    number_of(noise.at("flip_noise"))};
        for (const auto& [key, row] : json.at("rows").items()) {
            Measured& m = kept.rows[key];
            m.ms = row.at("ms").get<std::vector<double>>();
            m.cpu_ms = row.at("cpu_ms").get<std::vector<double>>();
            if (m.cpu_ms.size() != m.ms.size())
                return Error{ExitCode::bad_input, file, "", "does not hold the rows of a chart"};
            m.has_errors = row.contains("flip_mean");
            if (m.has_errors)
                m.errors = {number_of(row.at("flip_mean")), number_of(row.at("flip_p99")), number_of(row.at("rel_mse")),
                            number_of(row.at("max_abs")), row.at("nan_pixels").get<std::uint64_t>()};
        }
        return kept;
    } catch (const Json::exception&) {
        return Error{ExitCode::bad_input, file, "", "does not hold the rows of a chart"};
    }
}

std::string report_json(const ChartReport& report)
{
    Json json;
    json["machine"] = {{"version", report.machine.version},
                       {"processor", report.machine.processor},
                       {"isa", report.machine.isa},
                       {"threads", report.machine.threads}};
    json["runs"] = report.runs;
    json["reference_samples"] = report.reference_samples;
    json["references"] = Json::array();
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const ChartRow& row = report.rows[i];
        if (i > 0 && place(report.rows[i - 1]) == place(row))
            continue; // rows of a place stand together
        const Json settings = settings_json(report, row);
        Json reference = {{"scene", row.scene}, {"env", row.env}, {"roughness", settings["roughness"]}, {"anisotropy", settings["anisotropy"]}};
        reference.update(noise_json(report.references.at(place(row)).noise));
        json["references"].push_back(reference);
    }
    json["rows"] = Json::array();
    for (const ChartRow& row : report.rows)
        json["rows"].push_back(row_json(report, row));
    return dump(json);
}

} // namespace burnish
