// Judges an entry's measurements against the golden figures.
#pragma once
#include <string>

#include "apps/lab/atlas/golden_figures.h"
#include "apps/lab/atlas/measure.h"

namespace burnish {

enum class Verdict { unknown, held, better, worse, uncured }; // unknown: not in the table
struct Judged {
    Verdict verdict = Verdict::held;
    std::string why; // one line, the reason for a verdict other than `held`
};
// `row`: null if the table has no row for the entry.
Judged judge(const AtlasEntry& entry, const MeasuredEntry& measured, const GoldenFigures* row);
const char* verdict_name(Verdict verdict);

GoldenFigures row_of(const MeasuredEntry& measured);

} // namespace burnish
