#include "apps/options/animate.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/cli/parse.h"
#include "apps/cli/report.h"
#include "apps/cli/suggest.h"
#include "apps/options/options.h"

namespace burnish {
namespace {

// Names the options that --animate takes, without dashes.
std::vector<std::string> names_of_paths(const OptionTable& table)
{
    std::vector<std::string> names;
    for (const Option& option : table.options())
        if (changes_pictures(option, false))
            names.push_back(option.name.substr(2));
    return names;
}

Result<std::vector<double>> numbers_of(const std::string& option, const std::string& text)
{
    std::vector<double> numbers;
    for (const std::string& part : split(text, ',')) {
        const Result<double> number = parse_number(option, part, -1e30, 1e30);
        BN_TRY(number);
        numbers.push_back(*number);
    }
    return numbers;
}

// Splits at the commas between entries NAME=FROM:TO. Keeps commas within a value.
std::vector<std::string> entries_of(const std::string& text)
{
    std::vector<std::string> entries;
    for (const std::string& part : split(text, ','))
        if (entries.empty() || part.find('=') != std::string::npos)
            entries.push_back(part);
        else
            entries.back().append(1, ',').append(part);
    return entries;
}

Result<OptionPath> parse_path(const std::string& option, const std::string& entry, OptionTable& table)
{
    const std::size_t equals = entry.find('='), colon = entry.find(':', equals == std::string::npos ? 0 : equals);
    if (equals == std::string::npos || colon == std::string::npos)
        return usage_error(option, fmt::format("expected NAME=FROM:TO such as roughness=0.1:0.6, got '{}'", entry));
    const std::string name = entry.substr(0, equals);
    const std::vector<std::string> names = names_of_paths(table);
    if (std::find(names.begin(), names.end(), name) == names.end())
        return usage_error(option, fmt::format("'{}' is not one of {}{}", name, join(names), did_you_mean(name, names)));
    OptionPath path;
    path.option = fmt::format("--{}", name);
    path.whole = table.find(name)->value.kind == ValueKind::integer;
    for (const auto& [text, to] :
         {std::pair{entry.substr(equals + 1, colon - equals - 1), &path.from}, {entry.substr(colon + 1), &path.to}}) {
        const Result<std::vector<double>> numbers = numbers_of(option, text);
        BN_TRY(numbers);
        *to = *numbers;
        BN_TRY(table.set(path.option, text));
    }
    if (path.from.size() != path.to.size())
        return usage_error(
            option, fmt::format("'{}' goes from {} to {}", entry, counted(path.from.size(), "number"), counted(path.to.size(), "number")));
    return path;
}

} // namespace

Result<std::vector<OptionPath>> parse_option_paths(const std::string& option, const std::string& text, OptionTable& table)
{
    std::vector<OptionPath> paths;
    for (const std::string& entry : entries_of(text)) {
        Result<OptionPath> path = parse_path(option, entry, table);
        BN_TRY(path);
        for (const OptionPath& other : paths)
            if (other.option == path->option)
                return usage_error(option, fmt::format("names {} twice", path->option.substr(2)));
        paths.push_back(std::move(*path));
    }
    return paths;
}

std::string value_at(const OptionPath& path, double t)
{
    std::string text;
    for (std::size_t i = 0; i < path.from.size(); ++i) {
        const double along =
            path.geometric ? path.from[i] * std::pow(path.to[i] / path.from[i], t) : path.from[i] + (path.to[i] - path.from[i]) * t;
        const double value = t < 1.0 ? along : path.to[i];
        const std::string number = path.whole ? fmt::format("{}", std::llround(value)) : fmt::format("{:.9g}", value);
        text += fmt::format("{}{}", i ? "," : "", number);
    }
    return text;
}

std::vector<View> turntable_views(const DrawTables& tables, const FrameDesc& frame, const glm::vec2& first_deg, float fov_y_rad, int count)
{
    constexpr float kRadiansPerDegree = 0.017453292519943295f;
    const glm::vec3 centre = (tables.bounds_min + tables.bounds_max) * 0.5f;
    std::vector<View> views;
    float distance = 0.0f;
    for (int i = 0; i < count; ++i) {
        Framing framing;
        framing.azimuth_rad = (first_deg.x + 360.0f * static_cast<float>(i) / static_cast<float>(count)) * kRadiansPerDegree;
        framing.elevation_rad = first_deg.y * kRadiansPerDegree;
        framing.fov_y_rad = fov_y_rad, framing.target = centre;
        views.push_back(auto_frame(tables, frame.width, frame.height, framing));
        distance = std::max(distance, glm::dot(centre - views.back().eye, views.back().forward));
    }
    for (View& view : views) {
        const float znear = view.znear; // the nearer eye's
        view = make_view(centre - view.forward * distance, centre, fov_y_rad, frame.width, frame.height);
        view.znear = znear;
    }
    return views;
}

} // namespace burnish
