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
// Returns one row of a valid table, or none if the row is missing.
std::optional<GoldenFigures> find_row(const std::string& text, const char* walk, const std::string& id);
} // namespace burnish
