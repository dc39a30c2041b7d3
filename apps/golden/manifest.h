// Manifests of `burnish golden`: pictures to make, and their limits.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct GoldenLimits {                     // largest differences; none: no value may differ
    std::optional<double> flip, flip_p99; // mean and 99th percentile of FLIP
    std::optional<double> pattern;        // RMS of patterns
    std::optional<double> z;              // share of pixels that the z-test rejects, by the golden's variance
    std::optional<double> operations;     // of drawing a scene once, as --count-operations tells; no limit on the picture
    bool exact() const { return !flip && !flip_p99 && !pattern && !z; }
};

enum class GoldenKind { scene, command, picture }; // drawn by burnish, drawn by another program, there already

struct GoldenRow {
    std::string name;
    GoldenKind kind = GoldenKind::picture;
    std::vector<std::string> command;               // words of the program to run; of scenes: `burnish render` without the output
    std::map<std::string, std::string> environment; // variables that the program gets besides its own
    std::string picture;                            // file that the command writes or that is there; scenes: empty
    std::string extension;                          // of the picture, with its dot
    std::string golden;                             // file to compare with
    std::string mask;                               // picture whose black pixels do not count; empty: none
    double seconds = 300.0;                         // time limit of a program
    bool hash_alone = false;                        // the golden is the hash of the picture, as text
    GoldenLimits limits;
};

struct GoldenManifest {
    std::string folder; // where programs run; paths of the manifest are relative to it
    std::vector<GoldenRow> rows;
};

// Errors: ExitCode::bad_input with the JSON path of the first mistake, or with line and column where the text is no JSON.
Result<GoldenManifest> read_manifest(const std::string& path);
// Makes a row of each picture below two folders, by its relative path. Of two patterns, makes a row of each part of a name that '*' covers.
// Folders may hold further files. mask: a picture for all rows, a folder of pictures by the rows' names, or empty.
Result<GoldenManifest> manifest_of_pairs(const std::string& expected, const std::string& actual, const GoldenLimits& limits,
                                         const std::string& mask);

// Returns 16 hexadecimal digits over all that decides the rows: a change of any member changes them.
std::string manifest_hash(const GoldenManifest& manifest);

// Returns the name as part of file names: bytes other than letters, digits, '.', '-' and '_' become %XX.
std::string file_stem(const std::string& name);

} // namespace burnish
