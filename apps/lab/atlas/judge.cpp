#include "apps/lab/atlas/judge.h"

#include <algorithm>
#include <fmt/core.h>

namespace burnish {
namespace {

constexpr double kNear = 0.05; // relative to worst: a smaller change counts as held

} // namespace

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
