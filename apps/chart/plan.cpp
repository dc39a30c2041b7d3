#include "apps/chart/plan.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/core.h>

#include "apps/cli/parse.h"
#include "apps/cli/report.h"

namespace burnish {
namespace {

constexpr std::int64_t kMaxSamples = 65536; // as in `burnish render`
constexpr std::size_t kMaxValues = 64;      // in one sweep: more is a typing error
constexpr int kDefaultSamples[] = {1, 2, 4, 8, 16, 32, 64};

Error sweep_error(const std::string& reason)
{
    return usage_error("--sweep", reason);
}

template <class T> void add_once(std::vector<T>& values, T value)
{
    if (std::find(values.begin(), values.end(), value) == values.end())
        values.push_back(value);
}

Status read_numbers(const std::vector<std::string>& texts, double low, double high, std::vector<float>& into)
{
    for (const std::string& text : texts) {
        const Result<double> value = parse_number("--sweep", text, low, high);
        BN_TRY(value);
        add_once(into, static_cast<float>(*value) + 0.0f); // turns -0 into 0
    }
    return {};
}

Status read_samples(const std::vector<std::string>& texts, std::vector<int>& into)
{
    for (const std::string& text : texts) {
        const Result<std::int64_t> value = parse_integer("--sweep", text, 1, kMaxSamples);
        BN_TRY(value);
        add_once(into, static_cast<int>(*value));
    }
    return {};
}

} // namespace

Status parse_sweep(const std::string& text, Sweeps& into)
{
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        return sweep_error(fmt::format("expected a name and values such as samples=1,4,16, got '{}'", text));
    const std::string name = text.substr(0, equals);
    const std::string written = text.substr(equals + 1);
    const std::vector<std::string> values = split(written, written.find(':') == std::string::npos ? ',' : ':');
    const auto same_name = [&](const Sweeps::Named& other) { return other.option == name; };
    const bool again = name == "samples"      ? !into.samples.empty()
                       : name == "roughness"  ? !into.roughness.empty()
                       : name == "anisotropy" ? !into.anisotropy.empty()
                                              : std::any_of(into.others.begin(), into.others.end(), same_name);
    if (again)
        return sweep_error(fmt::format("{} is given twice", name));
    if (values.size() > kMaxValues)
        return sweep_error(fmt::format("{} values of {}, more than {}", values.size(), name, kMaxValues));
    if (std::find(values.begin(), values.end(), "") != values.end())
        return sweep_error(fmt::format("a value of {} is empty", name));
    if (name == "samples")
        return read_samples(values, into.samples);
    if (name == "roughness")
        return read_numbers(values, 0.0, 1.0, into.roughness);
    if (name == "anisotropy")
        return read_numbers(values, -1.0, 1.0, into.anisotropy);
    Sweeps::Named named{name, {}};
    for (const std::string& value : values)
        add_once(named.values, value);
    into.others.push_back(std::move(named));
    return {};
}

std::string describe(const Setting& setting)
{
    if (setting.budget > 0.0)
        return fmt::format("{}, budget {:g}", setting.technique, setting.budget);
    return setting.sampled ? fmt::format("{}, {} sample{}", setting.technique, setting.samples, setting.samples == 1 ? "" : "s")
                           : setting.technique;
}

Status parse_budgets(const std::string& text, std::vector<double>& into)
{
    into.clear();
    for (const std::string& part : split(text, ',')) {
        const Result<double> value = parse_number("--budget", part, 0.0, 1.0);
        BN_TRY(value);
        if (!(*value > 0.0))
            return usage_error("--budget", "0: no technique is exact; mc comes near with many samples");
        add_once(into, *value);
    }
    if (into.size() > kMaxValues)
        return usage_error("--budget", fmt::format("{} values, more than {}", into.size(), kMaxValues));
    return {};
}

std::vector<Setting> settings_of(const std::vector<std::string>& names, const std::vector<int>& samples)
{
    std::vector<Setting> settings;
    for (const std::string& name : names) {
        const TechniqueInfo& technique = *find_technique(name);
        if (technique.sampling == Sampling::none) {
            settings.push_back({name, 1, false});
            continue;
        }
        std::vector<int> asked = samples, taken;
        if (samples.empty()) {
            asked.assign(std::begin(kDefaultSamples), std::end(kDefaultSamples));
            asked.push_back(technique.default_samples);
        }
        for (const int n : asked)
            add_once(taken, effective_samples(technique, n));
        std::sort(taken.begin(), taken.end());
        for (const int n : taken)
            settings.push_back({name, n, true});
    }
    return settings;
}

std::vector<Cell> cells_of(const Sweeps& sweeps)
{
    std::vector<std::optional<float>> roughness(sweeps.roughness.begin(), sweeps.roughness.end());
    std::vector<std::optional<float>> anisotropy(sweeps.anisotropy.begin(), sweeps.anisotropy.end());
    if (roughness.empty())
        roughness.emplace_back();
    if (anisotropy.empty())
        anisotropy.emplace_back();
    std::vector<Cell> cells;
    for (const std::optional<float>& r : roughness)
        for (const std::optional<float>& a : anisotropy)
            cells.push_back({r, a});
    for (const Sweeps::Named& named : sweeps.others) { // extends each cell by each value
        std::vector<Cell> more;
        for (const Cell& cell : cells)
            for (const std::string& value : named.values) {
                more.push_back(cell);
                more.back().others.emplace_back(named.option, value);
            }
        cells = std::move(more);
    }
    return cells;
}

double cell_count(const Sweeps& sweeps)
{
    const auto values = [](const auto& list) { return static_cast<double>(std::max<std::size_t>(1, list.size())); };
    double count = values(sweeps.roughness) * values(sweeps.anisotropy);
    for (const Sweeps::Named& named : sweeps.others)
        count *= values(named.values);
    return count;
}

std::string describe(const Cell& cell)
{
    std::vector<std::string> parts;
    if (cell.roughness)
        parts.push_back(fmt::format("roughness {:g}", *cell.roughness));
    if (cell.anisotropy)
        parts.push_back(fmt::format("anisotropy {:g}", *cell.anisotropy));
    for (const auto& [option, value] : cell.others)
        parts.push_back(option + " " + value);
    return parts.empty() ? "the scene's own surfaces" : join(parts);
}

int representative_samples(const std::string& technique, const std::vector<int>& samples)
{
    int best = samples.front();
    if (technique == kPlanned)
        return best;
    const int own = find_technique(technique)->default_samples;
    for (const int n : samples)
        if (std::abs(n - own) < std::abs(best - own))
            best = n;
    return best;
}

} // namespace burnish
