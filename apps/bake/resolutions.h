// What finer tables of transformed cosines would gain: KT, Heitz, Dupuy, Narasimhan 2022, figure 12.
#pragma once
#include <string>
#include <vector>

#include "apps/report/drawing.h"
#include "apps/report/json.h"
#include "core/jobs/jobs.h"
#include "shading/bake/ltc/quality.h"

namespace burnish {

struct LtcResolution {
    std::string name;                  // of a row: "this table", "8 nodes", ..., "exact"
    ltc::Spread l1, light_relative;    // over lobes, the same for all rows
    std::vector<double> pixels, apart; // of the drawn ball, light over radiance, and its distance from GGX's; empty: not drawn
    double mean_apart = 0.0;           // over the ball
};

struct LtcResolutions {
    std::size_t lobes = 0;
    std::vector<double> reference; // of the ball, rows from the top; NaN: beside it
    std::vector<LtcResolution> rows;
};

// The table, tables of 8, 12, 16 and 64 nodes along an axis of which only those around the lobes are fitted, each alone, and the nearest
// cosine to each lobe: on lobes spread over all, and as a brushed ball under two strips; 64 on the lobes only. Of GGX.
LtcResolutions measure_resolutions(const ltc::Table& table, const Jobs& jobs);

std::string resolution_lines(const LtcResolutions& all); // a line a row
Json resolution_json(const LtcResolutions& all);
Drawing plot_resolutions(const LtcResolutions& all);

} // namespace burnish
