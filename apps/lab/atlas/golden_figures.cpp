#include "apps/lab/atlas/golden_figures.h"

#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <iterator>

#include "apps/cli/parse.h"
#include "apps/lab/atlas/entries.h"

namespace burnish {
namespace {

constexpr const char* kVersionMark = "Version ";
constexpr const char* kNothing = "-";

constexpr const char* kHead = R"(# Where methods break

Figures of the atlas' entries (apps/lab/atlas/atlas.def), written by `burnish atlas --bless --table apps/lab/atlas/golden_figures.txt`.
`burnish atlas` holds what it measures to two of them: the onset, which may come later, and the largest error, which may fall.

- onset: the first place on the entry's path, from 0 to 1, where the error is above the entry's threshold.
- worst: the largest error.
- flicker: how much more the error changes from step to step than the reference does.
- double: the error at the worst place, shaded in double.
- cure: the largest error with the cure, where one is known.
- kind: precision: doubles leave less than half of the error. Sampling: 64 times the samples do. Filtering: a reference that filters textures alike does. Else approximation.

)";

std::string cell_of(double value, bool there)
{
    return there ? fmt::format("{:.4f}", value) : kNothing;
}

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

// Reads "| id | onset | worst | flicker | double | cure | kind |". None for other lines.
std::optional<std::pair<std::string, GoldenFigures>> row_in(const std::string& line)
{
    std::vector<std::string> cells = split(line, '|');
    if (cells.size() != 9)
        return std::nullopt;
    for (std::string& cell : cells)
        cell = trimmed(cell);
    GoldenFigures row;
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

Result<GoldenTable> parse_table(const std::string& text, const std::string& file)
{
    GoldenTable table;
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
                continue; // figures of another version have another meaning
            if (!row || walk.empty())
                return Error{ExitCode::bad_input, file, "", fmt::format("'{}' is no row of golden figures", line)};
            table.walks[walk][row->first] = row->second;
        }
    }
    if (table.version == 0)
        return Error{ExitCode::bad_input, file, "", "does not hold golden figures of the atlas"};
    return table;
}

std::string table_text(const GoldenTable& table)
{
    std::string text = fmt::format("{}Version {}\n", kHead, table.version);
    for (const AtlasWalk& walk : {kQuickWalk, kFullWalk}) {
        const auto rows = table.walks.find(walk.name);
        if (rows == table.walks.end() || rows->second.empty())
            continue;
        text += fmt::format(
            "\n## {}\n\n| entry | onset | worst | flicker | double | cure | kind |\n| --- | --- | --- | --- | --- | --- | --- |\n",
            walk.name);
        for (const AtlasEntry& entry : atlas_entries())
            if (const auto found = rows->second.find(entry.id); found != rows->second.end()) {
                const GoldenFigures& row = found->second;
                text += fmt::format("| {} | {} | {:.4f} | {:.4f} | {} | {} | {} |\n", entry.id, cell_of(row.onset, row.onset <= 1.0),
                                    row.worst, row.flicker, cell_of(row.in_double.value_or(0.0), row.in_double.has_value()),
                                    cell_of(row.cure_worst, entry.cure[0] != 0), row.kind);
            }
    }
    return text;
}

} // namespace burnish
