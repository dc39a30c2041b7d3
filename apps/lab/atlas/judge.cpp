#include "apps/lab/atlas/judge.h"

#include <algorithm>
#include <fmt/core.h>

namespace burnish {
namespace {

constexpr double kNear = 0.05; // relative to worst: a smaller change counts as held
constexpr const char* kNothing = "-";

constexpr const char* kHead = R"(# Where methods break

Figures of the atlas' entries (apps/risks/atlas.def), written by `burnish atlas --bless --table apps/risks/golden_figures.txt`.
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

} // namespace

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

GoldenFigures row_of(const MeasuredEntry& m)
{
    return {m.onset, m.worst, m.flicker, m.cure_worst, m.in_double, m.kind};
}

Judged judge(const AtlasEntry& entry, const MeasuredEntry& m, const GoldenFigures* row)
{
    if (entry.cure[0] && m.cure_worst > entry.threshold)
        return {Verdict::uncured, fmt::format("the cure's error is {:.4f}, above {:g}", m.cure_worst, entry.threshold)};
    if (!row)
        return {Verdict::unknown, "no figures of it are blessed"};
    const double step = m.steps.size() > 1 ? 1.0 / static_cast<double>(m.steps.size() - 1) : 1.0, onset = std::min(m.onset, 1.0 + step),
                 golden_onset = std::min(row->onset, 1.0 + step), slack = 1.01 * step; // golden figures are rounded
    const double room = kNear * row->worst + 5e-5;
    if (onset < golden_onset - slack)
        return {Verdict::worse, fmt::format("breaks at {:.4f}, the golden onset is {:.4f}", onset, golden_onset)};
    if (m.worst > row->worst + room)
        return {Verdict::worse, fmt::format("is off by {:.4f}, the golden error is {:.4f}", m.worst, row->worst)};
    if (onset > golden_onset + slack)
        return {Verdict::better, fmt::format("breaks at {:.4f}, the golden onset is {:.4f}", onset, golden_onset)};
    if (m.worst < row->worst - room)
        return {Verdict::better, fmt::format("is off by {:.4f}, the golden error is {:.4f}", m.worst, row->worst)};
    if (m.kind == "none" && row->kind != "none")
        return {Verdict::better, fmt::format("breaks no more, the golden figures have a failure of {}", row->kind)};
    return {};
}

const char* verdict_name(Verdict verdict)
{
    constexpr const char* kNames[] = {"not blessed", "held", "better", "worse", "cure fails"};
    return kNames[static_cast<std::size_t>(verdict)];
}

} // namespace burnish
