// Quality report of an LTC table: error statistics and a drawing.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "apps/report/drawing.h"
#include "apps/report/json.h"
#include "core/jobs/jobs.h"
#include "shading/lab/ltc/quality.h"

namespace burnish {

// Statistics over a lobe list, or over a part.
struct LtcFigures {
    const char* name; // "all", "grazing", ...
    std::size_t lobes = 0;
    ltc::Spread l1, best_l1, with_pairs, light_relative, light_absolute, all_relative, grazing_absolute;
};

// Sampler variance over a part: see ltc::Sampled.
struct LtcSampling {
    const char* name;
    std::size_t lights = 0; // with enough light to be counted
    ltc::Spread unseen, furnace[2], deviation[ltc::kSamplers];
};

struct LtcQuality {
    std::vector<LtcFigures> parts;
    std::vector<LtcSampling> sampling;
    std::size_t probes = 0, broken = 0; // lookups; lookups without a positive determinant
    std::vector<double> l1_of_cells;    // see ltc::l1_of_cells
    ltc::Grid grid;                     // grid of these cells
    int cosines = 1;
    ltc::Model model = ltc::Model::ggx;
};

// cosines: 2 also judges the nearest sums of two cosines, see ltc::judge().
LtcQuality measure_ltc(const ltc::Table& table, int cosines, const Jobs& jobs);

std::string ltc_lines(const LtcQuality& quality); // one line a part; for GGX also the figures known of the published table
Json ltc_json(const LtcQuality& quality, const ltc::Table& table);

// Draws mean L1 over each pair of axes, darker for larger errors.
Drawing plot_ltc_quality(const LtcQuality& quality);

} // namespace burnish
