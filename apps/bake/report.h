// What a table of transformed cosines is worth, as figures and as a drawing.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "apps/report/drawing.h"
#include "apps/report/json.h"
#include "core/jobs/jobs.h"
#include "shading/bake/ltc/quality.h"

namespace burnish {

// Figures of a list of lobes, or of a part of one.
struct LtcFigures {
    const char* name; // "all", "grazing", ...
    std::size_t lobes = 0;
    ltc::Spread l1, best_l1, with_pairs, light_relative, light_absolute, all_relative, grazing_absolute;
};

// How far samples scatter, of a part of the list: see ltc::Sampled.
struct LtcSampling {
    const char* name;
    std::size_t lights = 0; // with enough light to be counted
    ltc::Spread unseen, furnace[2], deviation[ltc::kSamplers];
};

struct LtcQuality {
    std::vector<LtcFigures> parts;
    std::vector<LtcSampling> sampling;
    std::size_t probes = 0, broken = 0; // lookups, and those without a positive determinant
    std::vector<double> l1_of_cells;    // see ltc::l1_of_cells
    ltc::Grid grid;                     // whose cells they are
    int cosines = 1;
    ltc::Model model = ltc::Model::ggx;
};

// cosines: 2: also the nearest sums of two, see ltc::judge().
LtcQuality measure_ltc(const ltc::Table& table, int cosines, const Jobs& jobs);

std::string ltc_lines(const LtcQuality& quality); // a line a part, of GGX with what is known of the published table below
Json ltc_json(const LtcQuality& quality, const ltc::Table& table);

// Mean L1 over each pair of axes, darker where there is more.
Drawing plot_ltc_quality(const LtcQuality& quality);

} // namespace burnish
