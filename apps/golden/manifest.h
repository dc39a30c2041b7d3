// Manifests for `burnish golden`: pictures to make, and their limits.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct GoldenLimits {                     // largest differences; none: no value may differ
    std::optional<double> flip, flip_p99; // FLIP's mean and 99th percentile
    std::optional<double> pattern;        // patterns' RMS
    std::optional<double> z;              // pixel share that the z-test rejects, by the golden's variance
    std::optional<double> operations;     // to draw a scene once, as --count-operations tells; no limit on the picture
    bool exact() const { return !flip && !flip_p99 && !pattern && !z; }
};

enum class GoldenKind { scene, command, picture }; // drawn by burnish, drawn by another program, there already

struct GoldenRow {
    std::string name;
    GoldenKind kind = GoldenKind::picture;
    std::vector<std::string> command;               // words for the program to run; for scenes: `burnish render` without the output
    std::map<std::string, std::string> environment; // variables that the program gets besides its own
    std::string picture;                            // file that the command writes or that is there; scenes: empty
    std::string extension;                          // the picture's, with its dot
    std::string golden;                             // file to compare with
    std::string mask;                               // picture whose black pixels do not count; empty: none
    double seconds = 300.0;                         // a program's time limit
    bool hash_alone = false;                        // the golden is the picture's hash, as text
    GoldenLimits limits;
};

struct GoldenManifest {
    std::string folder; // where programs run; the manifest's paths are relative to this folder
    std::vector<GoldenRow> rows;
};

// Errors: ExitCode::bad_input with the first mistake's JSON path, or with line and column where the text is no JSON.
Result<GoldenManifest> read_manifest(const std::string& path);
// Makes a row from each picture below two folders, by its relative path. From two patterns, makes a row for each name part that '*' covers.
// Folders may hold further files. mask: a picture for all rows, a picture folder by the rows' names, or empty.
Result<GoldenManifest> manifest_of_pairs(const std::string& expected, const std::string& actual, const GoldenLimits& limits,
                                         const std::string& mask);

// Returns 16 hexadecimal digits over all that decides the rows: a change in any member changes them.
std::string manifest_hash(const GoldenManifest& manifest);

// Returns the name for use in file names: bytes other than letters, digits, '.', '-' and '_' become %XX.
std::string file_stem(const std::string& name);

} // namespace burnish
