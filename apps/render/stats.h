// Statistics of a render: frame times, and the JSON written by --stats.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/options/options.h"
#include "apps/plan/probe.h"
#include "apps/report/json.h"
#include "raster/tile/tile_types.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

struct PlanFigures {
    std::optional<double> budget, budget_p99, budget_ms; // mean HDR-FLIP; its 99th percentile; milliseconds of processor time
    double predicted = 0.0;                              // mean HDR-FLIP
    std::optional<double> predicted_p99;
    double instructions = 0.0, default_instructions = 0.0; // for shading, by the plan and by the default technique
    std::optional<double> predicted_ms;
};

struct RenderFigures {
    std::string device;
    int threads = 0;
    std::vector<double> frame_ms; // in rendering order
    FrameStats frame;             // the last frame
    std::uint64_t hash = 0;       // hash over linear pixels
    std::uint64_t nan_pixels = 0; // pixels with a NaN or Inf channel
    double load_ms = 0.0;         // from scene file to draw tables
    double bake_ms = 0.0;         // environment: baked, or read from the cache
    double prepare_ms = 0.0;      // renderer made from the tables, texture pyramids included
    std::string env;              // environment name
    bool environment_from_cache = false;
    std::vector<ExtractedLight> extracted_lights; // as the turned environment has them
    bool planned = false;                         // drawn by a plan
    std::optional<AreaLightsSetting> area_lights; // chosen by the plan
    std::optional<PlanFigures> plan;              // of --budget
    std::optional<LaneWork> work;                 // of one frame, with --count-operations
    std::vector<std::string> warnings;            // as they were said, or would have been without --quiet
};

double median(std::vector<double> values);
double percentile_95(std::vector<double> values); // nearest rank

std::string hash_text(std::uint64_t hash); // 16 hexadecimal digits
std::uint64_t peak_memory_bytes();         // peak resident size of this process

Json stats_json(const RenderOptions& options, const RenderFigures& figures);

} // namespace burnish
