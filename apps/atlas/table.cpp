#include "apps/atlas/table.h"

#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <iterator>
#include <optional>

#include "apps/cli/parse.h"

namespace burnish {
namespace {

constexpr double kNear = 0.05;   // of worst: nearer than this share it is held
constexpr double kUnsure = 0.05; // so near to kGone what is left says nothing of the kind, for references are noisy
constexpr const char* kVersionMark = "Version ";
constexpr const char* kNothing = "-";

constexpr const char* kHead = R"(# Where methods break

What each entry of the atlas (apps/atlas/atlas.def) measured when it was blessed: the first place on its path, from 0 to 1, at which the error is
above the entry's threshold; the largest error; how much more it changes from step to step than the truth does; the error where it is largest,
shaded in double; the largest error of the cure, where one is known; and what kind of failure it is. `burnish atlas --bless --table
apps/atlas/blessed.md` writes this page, `burnish atlas` holds what it measures to it: the onset within a step, the largest error within 5 %, and
the kind. The kind is found, not written: precision, where doubles leave less than half of the error; sampling, where 64 times the samples do; filtering,
where a truth that filters textures alike does; else approximation.

)";

std::string trimmed(const std::string& text)
{
    const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::optional<double> figure_of(const std::string& cell, double none)
{
    if (cell == kNothing)
        return none;
    double value = 0.0;
    const std::from_chars_result read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return read.ec == std::errc() && read.ptr == cell.data() + cell.size() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string cell_of(double value, bool there)
{
    return there ? fmt::format("{:.4f}", value) : kNothing;
}

// "| id | onset | worst | flicker | double | cure | kind |"; nothing where it is no such row.
std::optional<std::pair<std::string, BlessedRow>> row_in(const std::string& line)
{
    std::vector<std::string> cells = split(line, '|');
    if (cells.size() != 9)
        return std::nullopt;
    for (std::string& cell : cells)
        cell = trimmed(cell);
    BlessedRow row;
    const std::optional<double> onset = figure_of(cells[2], 2.0), worst = figure_of(cells[3], 0.0), flicker = figure_of(cells[4], 0.0),
                                in_double = figure_of(cells[5], 0.0), cure = figure_of(cells[6], 0.0);
    if (!onset || !worst || !flicker || !in_double || !cure)
        return std::nullopt;
    if (*onset < 0.0 || *onset > 2.0 || *worst < 0.0 || *in_double < 0.0 || *cure < 0.0)
        return std::nullopt;
    row.onset = *onset, row.worst = *worst, row.flicker = *flicker, row.cure_worst = *cure, row.kind = cells[7];
    if (cells[5] != kNothing)
        row.in_double = *in_double;
    return std::pair{cells[1], row};
}

} // namespace

Result<BlessedTable> parse_table(const std::string& text, const std::string& file)
{
    BlessedTable table;
    table.version = 0;
    std::string walk;
    for (const std::string& line : split(text, '\n')) {
        if (line.rfind(kVersionMark, 0) == 0) {
            const std::string number = line.substr(std::string(kVersionMark).size());
            std::from_chars(number.data(), number.data() + number.size(), table.version);
        } else if (line.rfind("## ", 0) == 0) {
            walk = line.substr(3);
        } else if (line.rfind("| ", 0) == 0 && line.rfind("| entry ", 0) != 0 && line.rfind("| ---", 0) != 0) {
            const auto row = row_in(line);
            if (table.version != 0 && table.version != kTableVersion)
                continue; // whose figures mean something else
            if (!row || walk.empty())
                return Error{ExitCode::bad_input, file, "", fmt::format("'{}' is no row of blessed figures", line)};
            table.walks[walk][row->first] = row->second;
        }
    }
    if (table.version == 0)
        return Error{ExitCode::bad_input, file, "", "does not hold blessed figures of the atlas"};
    return table;
}

std::optional<BlessedRow> find_row(const std::string& text, const char* walk, const std::string& id)
{
    const std::size_t begin = text.find(fmt::format("\n## {}\n", walk)),
                      end = text.find("\n## ", begin == std::string::npos ? begin : begin + 1);
    const std::size_t at = begin == std::string::npos ? begin : text.find(fmt::format("\n| {} |", id), begin);
    if (at == std::string::npos || at > end)
        return std::nullopt;
    const auto row = row_in(text.substr(at + 1, text.find('\n', at + 1) - at - 1));
    return row ? std::optional(row->second) : std::nullopt;
}

std::string table_text(const BlessedTable& table)
{
    std::string text = fmt::format("{}{}{}\n", kHead, kVersionMark, table.version);
    for (const AtlasWalk& walk : {kQuickWalk, kFullWalk}) {
        const auto rows = table.walks.find(walk.name);
        if (rows == table.walks.end() || rows->second.empty())
            continue;
        text += fmt::format(
            "\n## {}\n\n| entry | onset | worst | flicker | double | cure | kind |\n| --- | --- | --- | --- | --- | --- | --- |\n",
            walk.name);
        for (const AtlasEntry& entry : atlas_entries())
            if (const auto found = rows->second.find(entry.id); found != rows->second.end()) {
                const BlessedRow& row = found->second;
                text += fmt::format("| {} | {} | {:.4f} | {:.4f} | {} | {} | {} |\n", entry.id, cell_of(row.onset, row.onset <= 1.0),
                                    row.worst, row.flicker, cell_of(row.in_double.value_or(0.0), row.in_double.has_value()),
                                    cell_of(row.cure_worst, entry.cure[0] != 0), row.kind);
            }
    }
    return text;
}

BlessedRow row_of(const MeasuredEntry& m)
{
    return {m.onset, m.worst, m.flicker, m.cure_worst, m.in_double, m.kind};
}

Judged judge(const AtlasEntry& entry, const MeasuredEntry& m, const BlessedRow* row)
{
    if (entry.cure[0] && m.cure_worst > entry.threshold)
        return {Verdict::uncured, fmt::format("the cure's error is {:.4f}, above {:g}", m.cure_worst, entry.threshold)};
    if (!row)
        return {Verdict::unknown, "no figures of it are blessed"};
    const double step = m.steps.size() > 1 ? 1.0 / static_cast<double>(m.steps.size() - 1) : 1.0, onset = std::min(m.onset, 1.0 + step),
                 blessed = std::min(row->onset, 1.0 + step), slack = 1.01 * step; // blessed figures are rounded
    const double room = kNear * row->worst + 5e-5;
    if (onset < blessed - slack)
        return {Verdict::worse, fmt::format("breaks at {:.4f}, blessed is {:.4f}", onset, blessed)};
    if (m.worst > row->worst + room)
        return {Verdict::worse, fmt::format("is off by {:.4f}, blessed is {:.4f}", m.worst, row->worst)};
    if (onset > blessed + slack)
        return {Verdict::better, fmt::format("breaks at {:.4f}, blessed is {:.4f}", onset, blessed)};
    if (m.worst < row->worst - room)
        return {Verdict::better, fmt::format("is off by {:.4f}, blessed is {:.4f}", m.worst, row->worst)};
    if (m.kind == "none" && row->kind != "none")
        return {Verdict::better, fmt::format("breaks no more, blessed is a failure of {}", row->kind)};
    if (m.kind != row->kind && std::abs(m.remedy - kGone) > kUnsure)
        return {Verdict::worse, fmt::format("is a failure of {}, blessed is {}", m.kind, row->kind)};
    return {};
}

const char* verdict_name(Verdict verdict)
{
    constexpr const char* kNames[] = {"not blessed", "held", "better", "worse", "cure fails"};
    return kNames[static_cast<std::size_t>(verdict)];
}

} // namespace burnish
