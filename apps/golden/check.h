// Makes the pictures of a manifest and judges them by their goldens.
#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "apps/golden/manifest.h"
#include "core/base/limits.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

enum class GoldenVerdict { passed, differs, missing, failed }; // missing: there is no golden; failed: there is no picture
const char* verdict_name(GoldenVerdict verdict);

struct GoldenResult {
    std::string name;
    GoldenVerdict verdict = GoldenVerdict::passed;
    std::string reason; // one sentence; empty: every value is equal
    int width = 0, height = 0;
    std::optional<double> flip, flip_p99, differing, largest; // none: not measured, zeros for equal pictures; differing: share of pixels
    double operations = 0.0;                                  // of a frame, where a limit on these is given
    std::string golden;                                       // path as bless writes it
    std::string picture;                                      // in the results' folder: the new picture
    std::string log;                                          // in the results' folder: output of the program; empty: none
    std::string golden_copy;                                  // in the results' folder: the golden, unless the row passed
    bool hash_alone = false;
    bool linear = false;        // values are linear: HDR-FLIP judges
    bool by_operations = false; // operations alone exceed their limit: a new golden changes nothing
    bool not_finite = false;    // the new picture holds NaN or Inf, and fails
    bool of_machine = false;    // not written: the machine failed, as by a full disk, rather than the row
};

// Sets the figures of a picture that equals its golden.
inline void set_equal(GoldenResult& result)
{
    result.flip = result.flip_p99 = result.differing = result.largest = 0.0;
}

struct GoldenSetting {
    std::string results; // folder; pictures, shown and logs are made below it
    std::string program; // of scene rows: this one
    Limits limits;
    const std::atomic<bool>* stop = nullptr;
};

// Makes and judges one row. Writes pictures/STEM.EXT, the new picture, and logs/STEM.txt below the results' folder, and goldens/STEM.EXT
// unless the row passed. For the page it writes shown/STEM.png, and the files of judge() where values differ.
GoldenResult check_row(const GoldenManifest& manifest, const GoldenRow& row, const GoldenSetting& setting, const Jobs& jobs);

// Returns the golden as bless writes it.
std::string golden_path(const GoldenManifest& manifest, const GoldenRow& row);

bool file_exists(const std::string& path);

// Returns 16 hexadecimal digits over a picture's size, type and values, as goldens hold that are a hash alone.
std::string golden_hash(const Image& image);

} // namespace burnish
