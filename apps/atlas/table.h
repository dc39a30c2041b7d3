// The blessed table: what each entry measured when someone last looked and agreed. A page in Markdown, which people and the program read.
#pragma once
#include <map>
#include <string>

#include "apps/atlas/measure.h"

namespace burnish {

inline constexpr int kTableVersion = 3; // of what the figures mean: raise it when steps, pictures or measures change

struct BlessedRow {
    double onset = 2.0, worst = 0.0, flicker = 0.0, cure_worst = 0.0; // as in MeasuredEntry
    std::optional<double> in_double;
    std::string kind;
};

struct BlessedTable {
    int version = kTableVersion;
    std::map<std::string, std::map<std::string, BlessedRow>> walks; // by name of the walk, then by id
};

Result<BlessedTable> parse_table(const std::string& text, const std::string& file);
// One row of a table that is known to be good; nothing where it is not there.
std::optional<BlessedRow> find_row(const std::string& text, const char* walk, const std::string& id);
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
