// Reads the measurements of an earlier run.
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/chart/rows.h"

namespace burnish {
namespace {

double number_of(const nlohmann::json& json)
{
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

// Returns true if every entry is a valid time in milliseconds.
bool are_times(const std::vector<double>& ms)
{
    return std::all_of(ms.begin(), ms.end(), [](double x) { return x >= 0.0 && x < 1e12; });
}

bool is_error_or_unknown(double x) // NaN: unknown
{
    return !(x < 0.0);
}

std::uint64_t count_of(const nlohmann::json& json)
{
    return json.get_ref<const nlohmann::json::number_unsigned_t&>(); // throws for negative, fractional and too large numbers
}

} // namespace

Result<ChartResults> parse_chart_results(const std::string& text, const std::string& file)
{
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        ChartResults results;
        if (json.at("kept_version") != kChartResultsVersion)
            return results;
        if (json.contains("other_load") && !json["other_load"].is_null())
            results.others = json["other_load"].get<double>();
        for (const auto& [key, noise] : json.at("references").items())
            results.references[key] = {count_of(noise.at("samples")), number_of(noise.at("relative_error")),
                                       number_of(noise.at("flip_noise"))};
        for (const auto& [key, row] : json.at("rows").items()) {
            Measured& m = results.rows[key];
            m.ms = row.at("ms").get<std::vector<double>>();
            m.cpu_ms = row.at("cpu_ms").get<std::vector<double>>();
            if (m.cpu_ms.size() != m.ms.size() || !are_times(m.ms) || !are_times(m.cpu_ms))
                return Error{ExitCode::bad_input, file, "", "does not hold the rows of a chart"};
            m.has_errors = row.contains("flip_mean");
            if (m.has_errors)
                m.errors = {number_of(row.at("flip_mean")),    number_of(row.at("flip_p99")),    number_of(row.at("rel_mse")),
                            number_of(row.at("max_abs")),      count_of(row.at("nan_pixels")),   number_of(row.at("pattern_rms")),
                            number_of(row.at("quad_ratio_x")), number_of(row.at("quad_ratio_y"))};
            for (const double error : {m.errors.flip_mean, m.errors.flip_p99, m.errors.rel_mse, m.errors.max_abs, m.errors.pattern_rms,
                                       m.errors.quad_ratio_x, m.errors.quad_ratio_y})
                if (!is_error_or_unknown(error))
                    return Error{ExitCode::bad_input, file, "", "holds an error below 0"};
        }
        return results;
    } catch (const nlohmann::json::exception&) {
        return Error{ExitCode::bad_input, file, "", "does not hold the rows of a chart"};
    }
}

} // namespace burnish
