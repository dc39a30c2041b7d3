// The outcome of `burnish race`: what a frame costs the tile renderer and Vulkan's CPU devices.
#pragma once
#include <string>
#include <vector>

namespace burnish {

struct RaceRow {
    std::string scene, technique, device; // device: as the driver calls it
    int samples = 1, msaa = 1;
    double tile_ms = 0.0, device_ms = 0.0;         // medians of wall time
    double tile_cpu_ms = 0.0, device_cpu_ms = 0.0; // medians of the process' CPU time
    double flip_mean = 0.0;                        // of the device's picture against the tile renderer's
    std::string error;                             // not empty: nothing was timed, and why
    double ratio() const { return device_cpu_ms / tile_cpu_ms; }
};

struct RaceReport {
    std::string processor, isa, version;
    int threads = 0, width = 0, height = 0, runs = 0;
    std::vector<RaceRow> rows;
    std::vector<std::string> notes; // about devices, one line each
};

inline constexpr double kMaxRaceFlip = 0.01; // above, the pictures are not the same work
bool same_picture(const RaceRow& row);
double geomean_ratio(const RaceReport& report); // of the rows with the same picture; 0 where there is none

std::string race_table(const RaceReport& report);
std::string race_json(const RaceReport& report);
std::string race_csv(const RaceReport& report); // of the rows

} // namespace burnish
