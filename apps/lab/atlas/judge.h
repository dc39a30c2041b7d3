// What an entry measures against the figures that were blessed, and the page that holds these.
#pragma once
#include <string>

#include "apps/lab/atlas/measure.h"
#include "apps/risks/blessed.h"

namespace burnish {

std::string table_text(const BlessedTable& table); // rows in the order of the entries; those of none are left out

enum class Verdict { unknown, held, better, worse, uncured }; // unknown: not in the table
struct Judged {
    Verdict verdict = Verdict::held;
    std::string why; // one line, of what is not held
};
// `row`: null where the table has none.
Judged judge(const AtlasEntry& entry, const MeasuredEntry& measured, const BlessedRow* row);
const char* verdict_name(Verdict verdict);

BlessedRow row_of(const MeasuredEntry& measured);

} // namespace burnish
