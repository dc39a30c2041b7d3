// Measures how an entry of the atlas breaks: walks its path, computes the errors and classifies the failure.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/lab/atlas/picture_cache.h"
#include "apps/report/json.h"

namespace burnish {

struct AtlasStep {
    double s = 0.0; // [0,1]
    std::string values;
    double error = 0.0;               // mean FLIP (HDR; LDR for displayed pictures) or pattern, over pixels that show the scene
    std::optional<double> cure_error; // error of the cure; none if there is no cure or no measurement
    double noise = 0.0;               // the reference's noise, mean HDR-FLIP
    double change = 0.0;              // mean FLIP from the previous step, minus the reference's; 0 in the first step
};

struct MeasuredEntry {
    std::string id;
    std::vector<AtlasStep> steps;
    std::string kind;                // "precision", "sampling", "filtering", "approximation"; "none" if no error exceeds the threshold
    double onset = 2.0;              // the first s above the threshold; above 1: none
    double worst = 0.0;              // the largest error
    double flicker = 0.0;            // mean change
    double cure_worst = 0.0;         // the cure's largest error; 0 without a cure
    double noise = 0.0;              // the largest noise
    std::optional<double> in_double; // the error at the worst step, in double precision; none if the program has no such lanes
};

// Computes all figures from the steps, except the kind.
void summarise(const AtlasEntry& entry, MeasuredEntry& measured);

// Rows in the entry's picture strip, one column a step; 8-bit sRGB.
enum class AtlasRow { reference, test, error, cure, cure_error };
inline constexpr int kAtlasRows = 5;

struct WalkedEntry {
    MeasuredEntry measured;
    Image strip;
    bool stopped = false; // by a signal; the results are unusable
};
Result<WalkedEntry> walk_entry(const AtlasEntry& entry, const AtlasWalk& walk, PictureCache& cache);

} // namespace burnish
