// Judges an entry's measurements against the blessed figures, and writes the page of blessed figures.
#pragma once
#include <string>

#include "apps/lab/atlas/measure.h"
#include "apps/risks/blessed.h"

namespace burnish {

std::string table_text(const BlessedTable& table); // rows in entry order; rows without an entry are dropped

enum class Verdict { unknown, held, better, worse, uncured }; // unknown: not in the table
struct Judged {
    Verdict verdict = Verdict::held;
    std::string why; // one line, the reason for a verdict other than `held`
};
// `row`: null if the table has no row for the entry.
Judged judge(const AtlasEntry& entry, const MeasuredEntry& measured, const BlessedRow* row);
const char* verdict_name(Verdict verdict);

BlessedRow row_of(const MeasuredEntry& measured);

} // namespace burnish
