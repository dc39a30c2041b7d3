// The golden figures: each entry's agreed measurements. A Markdown page, read by people and by the program.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace burnish {

inline constexpr int kTableVersion = 3; // version of the figures' meaning: raise it when steps, pictures or measures change

struct GoldenFigures {
    double onset = 2.0, worst = 0.0, flicker = 0.0, cure_worst = 0.0; // as in MeasuredEntry (apps/lab/atlas/measure.h)
    std::optional<double> in_double;
    std::string kind;
};

struct GoldenTable {
    int version = kTableVersion;
    std::map<std::string, std::map<std::string, GoldenFigures>> walks; // by walk name, then by id
};

Result<GoldenTable> parse_table(const std::string& text, const std::string& file);
std::string table_text(const GoldenTable& table); // rows in entry order; rows without an entry are dropped

} // namespace burnish
