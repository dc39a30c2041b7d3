#include "apps/pieces/share.h"

#include <charconv>
#include <cstdlib>
#include <fmt/core.h>
#include <optional>

#include "apps/cli/report.h"

namespace burnish {
namespace {

constexpr std::uint64_t kMostShares = 1'000'000'000;

std::optional<std::uint64_t> whole(const std::string& text)
{
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value <= kMostShares ? std::optional(value) : std::nullopt;
}

// Variables of an engine. first, last, step: of an array's indices. count: the number of tasks or processes. Null: the engine does not
// tell.
struct Engine {
    const char *index, *first, *last, *step, *count;
};
// Array tasks come before processes: each task of an array is one process too.
constexpr Engine kEngines[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP", "SLURM_ARRAY_TASK_COUNT"},
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE", nullptr},
    {"OMPI_COMM_WORLD_RANK", nullptr, nullptr, nullptr, "OMPI_COMM_WORLD_SIZE"},
    {"PMI_RANK", nullptr, nullptr, nullptr, "PMI_SIZE"},
    {"SLURM_PROCID", nullptr, nullptr, nullptr, "SLURM_NTASKS"},
    {"JOB_COMPLETION_INDEX", nullptr, nullptr, nullptr, nullptr}};

// Returns the share that an engine tells. asked: the number of shares, where the user says it.
Result<Share> share_of(const Engine& engine, std::uint64_t index, std::optional<std::uint64_t> asked, ReadVariable read)
{
    const auto number = [&](const char* name) {
        const char* const text = name ? read(name) : nullptr;
        return text ? whole(text) : std::nullopt;
    };
    const std::uint64_t first = number(engine.first).value_or(0), step = number(engine.step).value_or(1);
    const std::optional<std::uint64_t> last = number(engine.last), told = number(engine.count);
    if (step == 0 || index < first || (index - first) % step != 0)
        return usage_error("--shard", fmt::format("auto: {} is {}, which is none of its array", engine.index, index));
    const std::optional<std::uint64_t> of_array = last && *last >= first ? std::optional((*last - first) / step + 1) : std::nullopt;
    if (!asked && told && of_array && *told != *of_array)
        return usage_error("--shard", fmt::format("auto: the array has {} tasks of {} indices; --take needs no index", *told, *of_array));
    const std::optional<std::uint64_t> count = asked ? asked : told ? told : of_array;
    if (!count)
        return usage_error("--shard", fmt::format("auto: {} tells the index alone; auto/N says how many shares there are", engine.index));
    const Share share = {(index - first) / step, *count};
    if (share.index >= share.count)
        return usage_error("--shard", fmt::format("auto: {} is {}, and there are {} shares", engine.index, index, share.count));
    return share;
}

} // namespace

Result<Share> parse_share(const std::string& text, ReadVariable read)
{
    const std::size_t slash = text.find('/');
    const std::string before = text.substr(0, slash), after = slash == std::string::npos ? "" : text.substr(slash + 1);
    const std::optional<std::uint64_t> count = whole(after);
    if (slash != std::string::npos && (!count || *count == 0))
        return usage_error("--shard", fmt::format("'{}': the number of shares must be 1 or more", text));
    if (before != "auto") {
        const std::optional<std::uint64_t> index = whole(before);
        if (!index || !count)
            return usage_error("--shard", fmt::format("'{}' must be I/N, auto or auto/N", text));
        if (*index < 1 || *index > *count)
            return usage_error("--shard", fmt::format("'{}': the share must lie in 1..{}", text, *count));
        return Share{*index - 1, *count};
    }
    std::string names;
    for (const Engine& engine : kEngines) {
        const char* const said = read(engine.index);
        const std::optional<std::uint64_t> index = said ? whole(said) : std::nullopt; // Grid Engine says "undefined" outside arrays
        if (index)
            return share_of(engine, *index, count, read);
        names += std::string(names.empty() ? "" : ", ") + engine.index;
    }
    return usage_error("--shard", "auto: no engine tells an index; looked for " + names);
}

Result<Share> parse_share(const std::string& text)
{
    return parse_share(text, [](const char* name) -> const char* { return std::getenv(name); });
}

} // namespace burnish
