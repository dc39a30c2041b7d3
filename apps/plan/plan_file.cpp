// Plans as JSON files.
#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/plan/plan.h"
#include "apps/report/json.h"
#include "core/base/file.h"
#include "core/base/version.h"
#include "core/image/image.h"

namespace burnish {
namespace {

constexpr std::uint64_t kMostBytes = 64ull << 20;
constexpr int kFormat = 1;

Error malformed(const std::string& path, const std::string& place, std::string reason)
{
    return Error{ExitCode::bad_input, path, place, std::move(reason)};
}

// Returns the subject's members as texts, in the order in which they are compared.
std::vector<std::pair<const char*, std::string>> members(const PlanSubject& s)
{
    return {
        {"version", version()}, {"scene", s.scene},    {"environment", s.environment}, {"size", fmt::format("{}x{}", s.width, s.height)},
        {"view", s.view},       {"content", s.content}};
}

Json step_json(const PlanStep& step)
{
    return {{"technique", step.setting.technique}, {"samples", step.setting.samples}, {"error", step.error}, {"instructions", step.cost}};
}

Json area_json(const AreaLightsStep& step)
{
    return {{"method", area_ways()[static_cast<std::size_t>(step.setting.way)].name},
            {"samples", step.setting.samples},
            {"error", step.error},
            {"instructions", step.cost}};
}

// Reads the method for area lights; an Error for one that is malformed.
Status read_area_lights(const Json& row, const std::string& path, PlannedFrame& to)
{
    const bool whole = row.is_object() && row.contains("method") && row["method"].is_string() && row.contains("samples") &&
                       row["samples"].is_number_unsigned() && row["samples"].get<std::uint64_t>() <= 65536;
    if (!whole)
        return malformed(path, "/area_lights", "needs a method and samples");
    const std::vector<AreaWayInfo>& ways = area_ways();
    const auto found = std::find_if(ways.begin(), ways.end(), [&](const AreaWayInfo& way) { return row["method"] == way.name; });
    if (found == ways.end())
        return malformed(path, "/area_lights/method", fmt::format("unknown method '{}'", row["method"].get<std::string>()));
    to.area_lights = {static_cast<int>(found - ways.begin()), static_cast<int>(row["samples"].get<std::uint64_t>())};
    return {};
}

} // namespace

std::string plan_json(const Plan& plan, const PlanSubject& subject)
{
    Json json;
    json["format"] = kFormat;
    for (const auto& [name, value] : members(subject))
        json[name] = value;
    json["predicted_flip"] = plan.error;
    if (plan.p99)
        json["predicted_p99"] = *plan.p99;
    json["instructions"] = plan.cost, json["usual_instructions"] = plan.default_cost;
    if (plan.default_error)
        json["usual_predicted_flip"] = *plan.default_error;
    if (plan.area_lights) {
        Json& row = json["area_lights"] = area_json(plan.area_lights->chosen);
        if (plan.area_lights->cheaper)
            row["next_cheaper"] = area_json(*plan.area_lights->cheaper);
        if (plan.area_lights->better)
            row["next_better"] = area_json(*plan.area_lights->better);
    }
    json["materials"] = Json::array();
    for (const PlannedMaterial& m : plan.materials) {
        Json row = {{"name", m.name}, {"share", m.share}};
        row.update(step_json(m.chosen));
        if (m.cheaper)
            row["next_cheaper"] = step_json(*m.cheaper);
        if (m.better)
            row["next_better"] = step_json(*m.better);
        for (const PlanStep& step : m.all)
            row["settings"].push_back(step_json(step));
        json["materials"].push_back(std::move(row));
    }
    return json_text(json, 2) + "\n";
}

Result<PlannedFrame> read_plan(const std::string& path, const PlanSubject& subject, std::size_t materials)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostBytes);
    BN_TRY(bytes);
    const Json json = Json::parse(bytes->begin(), bytes->end(), nullptr, false);
    if (!json.is_object() || !json.contains("format"))
        return malformed(path, "", "is no plan");
    if (json["format"] != kFormat)
        return malformed(path, "/format", fmt::format("only format {} is known", kFormat));
    for (const auto& [name, value] : members(subject)) {
        const std::string place = fmt::format("/{}", name);
        if (!json.contains(name) || !json[name].is_string())
            return malformed(path, place, "is no text");
        if (json[name] == value)
            continue;
        const std::string both = fmt::format("the plan is for {}, not for {}", json[name].get<std::string>(), value);
        return malformed(path, place,
                         std::string_view(name) == "content" ? "the scene's content, its environment or an option differs" : both);
    }
    if (!json.contains("materials") || !json["materials"].is_array() || json["materials"].size() != materials)
        return malformed(path, "/materials", fmt::format("is no list of {} materials", materials));
    PlannedFrame frame;
    if (json.contains("area_lights"))
        BN_TRY(read_area_lights(json["area_lights"], path, frame));
    for (std::size_t i = 0; i < materials; ++i) {
        const Json& row = json["materials"][i];
        const bool whole = row.is_object() && row.contains("technique") && row["technique"].is_string() && row.contains("samples") &&
                           row["samples"].is_number_unsigned() && row["samples"].get<std::uint64_t>() <= 65536;
        if (!whole)
            return malformed(path, fmt::format("/materials/{}", i), "needs a technique and samples");
        frame.by_material.push_back({row["technique"].get<std::string>(), static_cast<int>(row["samples"].get<std::uint64_t>())});
    }
    return frame;
}

} // namespace burnish
