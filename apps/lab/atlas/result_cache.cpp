#include "apps/lab/atlas/result_cache.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/build.h"
#include "apps/render/stats.h"
#include "core/base/hash.h"
#include "core/base/version.h"

namespace burnish {
namespace {

Json step_json(const AtlasStep& s)
{
    return {{"s", s.s},         {"values", s.values}, {"error", s.error}, {"cure_error", s.cure_error ? Json(*s.cure_error) : Json()},
            {"noise", s.noise}, {"change", s.change}};
}

Json measured_json(const MeasuredEntry& m, bool cured)
{
    Json json = {{"onset", m.onset <= 1.0 ? Json(m.onset) : Json()},
                 {"worst", m.worst},
                 {"flicker", m.flicker},
                 {"double", m.in_double ? Json(*m.in_double) : Json()},
                 {"cure_worst", cured ? Json(m.cure_worst) : Json()},
                 {"kind", m.kind},
                 {"noise", m.noise},
                 {"steps", Json::array()}};
    for (const AtlasStep& s : m.steps)
        json["steps"].push_back(step_json(s));
    return json;
}

std::optional<double> number_or_none(const nlohmann::json& json)
{
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

double number_or_zero(const nlohmann::json& json)
{
    return json.is_null() ? 0.0 : json.get<double>();
}

} // namespace

std::string entry_key(const AtlasEntry& e, const AtlasWalk& walk)
{
    const std::string text = fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {}", program_hash(), e.id, e.words, e.with, e.geometric,
                                         e.path, static_cast<int>(e.reference), e.reference_words, e.threshold, e.cure, walk.steps,
                                         walk.side, walk.samples, walk.cure_every);
    return hash_text(hash_bytes(text.data(), text.size()));
}

std::string cached_entry_json(const MeasuredEntry& m, const std::string& key)
{
    Json json = {{"key", key}, {"id", m.id}};
    json.update(measured_json(m, true));
    return json_text(json, 1) + "\n";
}

std::optional<MeasuredEntry> parse_cached_entry(const std::string& text, const std::string& key)
{
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        if (json.at("key") != key)
            return std::nullopt;
        MeasuredEntry m;
        m.id = json.at("id").get<std::string>();
        for (const nlohmann::json& s : json.at("steps"))
            m.steps.push_back({s.at("s").get<double>(), s.at("values").get<std::string>(), s.at("error").get<double>(),
                               number_or_none(s.at("cure_error")), number_or_zero(s.at("noise")), s.at("change").get<double>()});
        m.kind = json.at("kind").get<std::string>();
        if (!json.at("double").is_null())
            m.in_double = json.at("double").get<double>();
        const AtlasEntry* entry = find_entry(m.id);
        if (!entry || m.steps.empty())
            return std::nullopt;
        summarise(*entry, m);
        return m;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

std::string path_text(const AtlasEntry& entry)
{
    return fmt::format("{}{}", entry.path, entry.geometric ? ", by equal factors" : "");
}

std::string reference_text(const AtlasEntry& entry)
{
    const std::string with = entry.reference_words[0] ? fmt::format(" with {}", entry.reference_words) : "";
    switch (entry.reference) {
    case AtlasReference::reference:
    case AtlasReference::pattern:
        return "the reference" + with;
    case AtlasReference::full:
        return "the reference with textures in full detail" + with;
    case AtlasReference::doubles:
        return "the same in double" + with;
    case AtlasReference::render:
    case AtlasReference::shown:
        break;
    }
    return "the same" + with;
}

std::string measure_text(const AtlasEntry& entry)
{
    const char* measure = "mean HDR-FLIP";
    if (entry.reference == AtlasReference::shown)
        measure = "mean LDR-FLIP, as displayed,";
    if (entry.reference == AtlasReference::pattern)
        measure = "pattern, a share of luminance,";
    return fmt::format("{} against {}", measure, reference_text(entry));
}

Json atlas_json(const std::vector<AtlasResult>& results, const AtlasWalk& walk)
{
    Json json = {{"version", version()},      {"table_version", kTableVersion},    {"walk", walk.name},       {"steps", walk.steps},
                 {"picture_side", walk.side}, {"reference_samples", walk.samples}, {"entries", Json::array()}};
    for (const AtlasResult& r : results) {
        const AtlasEntry& e = *r.entry;
        Json entry = {{"id", e.id},
                      {"group", e.group},
                      {"breaks", e.breaks},
                      {"words", e.words},
                      {"path", path_text(e)},
                      {"measure", measure_text(e)},
                      {"threshold", e.threshold},
                      {"cure", e.cure[0] ? Json(e.cure) : Json()},
                      {"verdict", verdict_name(r.judged.verdict)},
                      {"why", r.judged.why}};
        entry.update(measured_json(r.measured, e.cure[0] != 0));
        json["entries"].push_back(std::move(entry));
    }
    return json;
}

} // namespace burnish
