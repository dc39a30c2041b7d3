// Figures of a render: times over frames and the JSON that --stats writes.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/options/options.h"
#include "apps/report/json.h"

namespace burnish {

struct RenderFigures {
    std::string device;
    int threads = 0;
    std::vector<double> frame_ms; // in the order rendered
    FrameStats frame;             // of the last frame
    std::uint64_t hash = 0;       // of the linear pixels
    std::uint64_t nan_pixels = 0; // pixels with a NaN or Inf channel
    double load_ms = 0.0;         // scene file to draw tables
    double bake_ms = 0.0;         // environment: baked, or read from the cache
    double prepare_ms = 0.0;      // renderer made from the tables: texture pyramids and the like
    std::string env;              // its name
    bool environment_from_cache = false;
    Json key_lights;                   // see key_lights_json()
    std::vector<std::string> warnings; // as they were said, or would have been without --quiet
};

double median(std::vector<double> values);
double percentile_95(std::vector<double> values); // nearest rank

std::string hash_text(std::uint64_t hash); // 16 hexadecimal digits
std::uint64_t peak_memory_bytes();         // largest resident size of this process so far
std::uint64_t program_hash();              // of this program's own bytes: what it made is not what another build makes

Json stats_json(const RenderOptions& options, const RenderFigures& figures);

} // namespace burnish
