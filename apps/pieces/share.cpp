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

// Variables of an engine. last: the largest index or, without `counts`, the number of processes. Null: the engine does not tell.
struct Engine {
    const char *index, *first, *last, *step;
    bool counts; // `last` is an index, to be taken with `first` and `step`
};
// Array tasks come before processes: each task of an array is one process too.
constexpr Engine kEngines[] = {{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP", true},
                               {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE", true},
                               {"OMPI_COMM_WORLD_RANK", nullptr, "OMPI_COMM_WORLD_SIZE", nullptr, false},
                               {"PMI_RANK", nullptr, "PMI_SIZE", nullptr, false},
                               {"SLURM_PROCID", nullptr, "SLURM_NTASKS", nullptr, false},
                               {"JOB_COMPLETION_INDEX", nullptr, nullptr, nullptr, false}};

// Returns the share that an engine tells. asked: the number of shares, where the user says it.
Result<Share> share_of(const Engine& engine, std::uint64_t index, std::optional<std::uint64_t> asked, ReadVariable read)
{
    const auto number = [&](const char* name) {
        const char* const text = name ? read(name) : nullptr;
        return text ? whole(text) : std::nullopt;
    };
    const std::uint64_t first = number(engine.first).value_or(engine.first ? 1 : 0), step = number(engine.step).value_or(1);
    const std::optional<std::uint64_t> last = number(engine.last);
    if (step == 0 || index < first || (index - first) % step != 0)
        return usage_error("--shard", fmt::format("auto: {} is {}, which is none of its array", engine.index, index));
    std::optional<std::uint64_t> count = asked;
    if (!count && last && engine.counts && *last >= first)
        count = (*last - first) / step + 1;
    else if (!count && last && !engine.counts)
        count = *last;
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
