// The outcome of `burnish race`: what a frame costs the tile renderer and Vulkan's CPU devices.
#pragma once
#include <string>
#include <vector>

#include "core/scene/draw_tables.h"
#include "raster/frame/frame.h"

namespace burnish {

inline constexpr const char* kRaceShaders[] = {"own", "lean"};

struct RaceRow {
    std::string scene, technique, device; // device: as the driver calls it
    std::string shader;                   // own: the kernels' text; lean: as an engine would write it
    int samples = 1, msaa = 1;
    double tile_ms = 0.0, device_ms = 0.0;         // medians of wall time
    double tile_cpu_ms = 0.0, device_cpu_ms = 0.0; // medians of the process' CPU time
    double flip_mean = 0.0;                        // of the device's picture against the tile renderer's, away from silhouettes
    double flip_whole = 0.0;                       // with them
    double silhouettes = 0.0;                      // their share of the pixels
    std::string error;                             // not empty: nothing was timed, and why
    double ratio() const { return device_cpu_ms / tile_cpu_ms; }
};

struct RaceReport {
    std::string processor, isa, version;
    int threads = 0, width = 0, height = 0, runs = 0;
    std::vector<RaceRow> rows;
    std::vector<std::string> notes; // about devices, one line each
};

inline constexpr double kMaxRaceFlip = 0.01;  // above, the pictures are not the same work
inline constexpr double kMaxWholeFlip = 0.02; // with silhouettes, of which each has its own
bool same_picture(const RaceRow& row);
double geomean_ratio(const RaceReport& report, const std::string& shader); // of the rows with the same picture; 0 where there is none

// Pixels whose samples see more than one draw, or one and the sky, 1 each; none with one sample a pixel. Where in such a pixel a fragment
// is shaded is each renderer's own: at a centroid of the device's choice, in the middle, at the mean of what is covered. frame: with
// triangle ids.
std::vector<std::uint8_t> silhouettes_of(const Frame& frame, int msaa, const DrawTables& tables);
// `test` against `reference`: the row's three figures.
void compare_pictures(const Image& reference, const Image& test, const std::vector<std::uint8_t>& silhouettes, const Jobs& jobs,
                      RaceRow& row);

std::string race_table(const RaceReport& report);
std::string race_json(const RaceReport& report);
std::string race_csv(const RaceReport& report); // of the rows

} // namespace burnish
