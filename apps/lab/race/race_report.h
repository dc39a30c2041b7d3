// The outcome of `burnish race`: frame times for the tile renderer and for Vulkan CPU devices.
#pragma once
#include <string>
#include <vector>

#include "core/scene/draw_tables.h"
#include "raster/frame/frame.h"

namespace burnish {

inline constexpr const char* kRaceShaders[] = {"own", "lean"};

struct RaceRow {
    std::string scene, technique, device; // device: the driver's name
    std::string shader;                   // own: the shared kernels; lean: hand-written, as in an engine
    int samples = 1, msaa = 1;
    double tile_ms = 0.0, device_ms = 0.0;         // medians of wall time
    double tile_cpu_ms = 0.0, device_cpu_ms = 0.0; // medians of the process's CPU time
    double flip_mean = 0.0;                        // device's picture against the tile renderer's, without silhouettes
    double flip_whole = 0.0;                       // with silhouettes
    double silhouettes = 0.0;                      // share of the pixels on silhouettes
    std::string error;                             // not empty: the reason why nothing was timed
    double ratio() const { return device_cpu_ms / tile_cpu_ms; }
};

struct RaceReport {
    std::string processor, isa, version;
    int threads = 0, width = 0, height = 0, runs = 0;
    std::vector<RaceRow> rows;
    std::vector<std::string> notes; // about devices and scenes, one line each
};

inline constexpr double kMaxRaceFlip = 0.01;  // limit for flip_mean: above it the renderers draw different pictures
inline constexpr double kMaxWholeFlip = 0.02; // limit for flip_whole: renderers may shade silhouettes at other points
bool same_picture(const RaceRow& row);
double geomean_ratio(const RaceReport& report, const std::string& shader); // over rows with the same picture; 0 if there is none

// Returns 1 for pixels whose samples see several draws, or a draw and the background, else 0. All 0 with one sample a pixel. Renderers
// shade such pixels at different points: a device's centroid, the pixel centre, or the mean of the covered samples. frame: with triangle
// ids.
std::vector<std::uint8_t> silhouettes_of(const Frame& frame, int msaa, const DrawTables& tables);
// Compares `test` with `reference` and sets flip_mean, flip_whole and silhouettes.
void compare_pictures(const Image& reference, const Image& test, const std::vector<std::uint8_t>& silhouettes, const Jobs& jobs,
                      RaceRow& row);

std::string race_table(const RaceReport& report);
std::string race_json(const RaceReport& report);
std::string race_csv(const RaceReport& report); // rows only

} // namespace burnish
