// How an entry of the atlas breaks: its path walked, its figures, and what kind of failure it is.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/lab/atlas/darkroom.h"
#include "apps/report/json.h"

namespace burnish {

inline constexpr double kGone = 0.5; // an error is gone where less than this share of it is left

struct AtlasStep {
    double s = 0.0; // [0,1]
    std::string values;
    double error = 0.0;               // mean FLIP (HDR; LDR of what a display shows) over what shows the scene
    std::optional<double> cure_error; // the same of the cure; nothing where none is known or was looked at
    double noise = 0.0;               // of the truth, mean HDR-FLIP
    double change = 0.0;              // mean FLIP from the step before, less that of the truth; 0 of the first step
};

struct MeasuredEntry {
    std::string id;
    std::vector<AtlasStep> steps;
    std::string kind;                // "precision", "sampling", "filtering", "approximation"; "none" where nothing exceeds the threshold
    double onset = 2.0;              // the first s beyond the threshold; above 1: none
    double worst = 0.0;              // the largest error
    double flicker = 0.0;            // mean change
    double cure_worst = 0.0;         // the cure's largest error; 0 where none is known
    double noise = 0.0;              // the largest
    std::optional<double> in_double; // the error at the worst step, drawn in double; nothing where the program has no such lanes
    double remedy = 0.0; // the share of the worst step's error that is left in double, with 64 times the samples, or beside a truth
                         // that filters alike: of those that were asked for, what is nearest to kGone
};

// From steps to figures; but for kind and remedy.
void summarise(const AtlasEntry& entry, MeasuredEntry& measured);

// The entry's pictures: a column a step, rows as below. 8-bit sRGB.
enum class AtlasRow { truth, test, error, cure, cure_error };
inline constexpr int kAtlasRows = 5;

struct WalkedEntry {
    MeasuredEntry measured;
    Image strip;
    bool stopped = false; // by a signal, with nothing to be used
};
Result<WalkedEntry> walk_entry(const AtlasEntry& entry, const AtlasWalk& walk, Darkroom& room);

} // namespace burnish
