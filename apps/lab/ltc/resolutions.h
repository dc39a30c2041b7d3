// Estimates the gain of finer LTC tables: KT, Heitz, Dupuy, Narayanan 2022, figure 12.
#pragma once
#include <string>
#include <vector>

#include "apps/report/drawing.h"
#include "apps/report/json.h"
#include "core/jobs/jobs.h"
#include "shading/lab/ltc/quality.h"

namespace burnish {

struct LtcResolution {
    std::string name;                  // row name: "this table", "8 nodes", ..., "exact"
    ltc::Spread l1, light_relative;    // over the lobes, common to all rows
    std::vector<double> pixels, apart; // the drawn ball: lighting over radiance, and its distance from GGX lighting; empty: not drawn
    double mean_apart = 0.0;           // over the ball
};

struct LtcResolutions {
    std::size_t lobes = 0;
    std::vector<double> reference; // the ball, rows from the top; NaN: outside it
    std::vector<LtcResolution> rows;
};

// Compares, for GGX: the given table, tables with 8, 12, 16 and 64 nodes an axis, and the nearest cosine of each lobe. Fits only the
// nodes around the tested lobes, each node independently. Tests lobes spread over the domain and a brushed ball under two strips; 64
// nodes on lobes alone.
LtcResolutions measure_resolutions(const ltc::Table& table, const Jobs& jobs);

std::string resolution_lines(const LtcResolutions& all); // a line a row
Json resolution_json(const LtcResolutions& all);
Drawing plot_resolutions(const LtcResolutions& all);

} // namespace burnish
