// The tasks of `burnish golden`, and code that they share.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "apps/golden/check.h"
#include "apps/golden/manifest.h"
#include "apps/golden/result_folder.h"
#include "apps/pieces/pieces.h"
#include "core/base/limits.h"

namespace burnish {

enum class GoldenTask { check_rows, bless, merge };

struct GoldenArguments {
    GoldenTask task = GoldenTask::check_rows;
    std::vector<std::string> paths, rows; // rows: names, where not all are made
    std::string results = "golden-results", from, mask;
    GoldenLimits limits; // of folders and patterns, as is the mask
    PieceOptions pieces;
    int jobs = 0;
    bool live = false;    // the page draws rows that differ anew
    std::string renderer; // for the page; empty: beside the program
    Limits input;
    bool quiet = false;
    int verbosity = 0;
};

// Reads the manifest, or the names in two folders or by two patterns.
Result<GoldenManifest> manifest_at(const GoldenArguments& arguments);
// Returns the manifest's files, which no folder of results may hold.
std::vector<std::string> inputs_of(const GoldenArguments& arguments, const GoldenManifest& manifest);

// Writes the reports, also for GitHub, and puts all files into place. Returns the exit code. manifest: of rows that the page draws anew
// where differences are to be live; null: none.
int conclude_golden(std::vector<GoldenResult> results, const GoldenManifest* manifest, NewResults& fresh, const GoldenArguments& arguments,
                    Report& report);

// Run one task, and return the exit code.
int bless_goldens(const GoldenArguments& arguments, Report& report);
int merge_golden_shards(const GoldenArguments& arguments, Report& report);

} // namespace burnish
