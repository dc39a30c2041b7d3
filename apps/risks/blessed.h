// The blessed table: what each entry measured when someone last looked and agreed. A page in Markdown, which people and the program read.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace burnish {

inline constexpr int kTableVersion = 3; // of what the figures mean: raise it when steps, pictures or measures change

struct BlessedRow {
    double onset = 2.0, worst = 0.0, flicker = 0.0, cure_worst = 0.0; // as in MeasuredEntry (apps/lab/atlas/measure.h)
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
} // namespace burnish
