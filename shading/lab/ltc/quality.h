// Errors of a table's lobes against the exact lobes.
#pragma once
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/table.h"
#include "shading/lab/ltc/lobe.h"

namespace burnish::ltc {

inline constexpr int kLights = 6; // test lights for a lobe: ceiling, wall, square, strip, half plane, low wall

// A lobe, and the table's errors for it.
struct Judged {
    Place place;
    double l1 = 0.0, best_l1 = 0.0;      // with the table; with a transformed cosine fitted to this very lobe
    double pair_l1 = 0.0;                // with a fitted pair if best_l1 is above kFarOff; else best_l1
    double light_relative[kLights] = {}; // |difference| over the greater of the light and 0.02
    double light_absolute[kLights] = {}; // for the lobe's shares in six quads, each in [0,1]
    double all_relative = 0.0;           // in nD
    double grazing_absolute = 0.0;       // in fD
};

// Returns `count` lobes without random numbers: theta to 85 degrees, alpha from 0.05, half even and half logarithmic, lambda from 0.1. The
// first `on_nodes` lie on nodes of a grid with size 8. from: the first point in the sequence.
std::vector<Place> judged_places(std::size_t count, std::size_t on_nodes, std::size_t from);

// Returns such lobes with theta from 75 to 89 degrees.
std::vector<Place> grazing_places(std::size_t count);

inline constexpr double kFarOff = 0.3; // L1

// Judges a table. cosines: 0: the table alone; 1: also fits each lobe alone, a bound for any table; 2: also fits a pair of cosines.
std::vector<Judged> judge(const Table& table, const std::vector<Place>& places, int cosines, const Jobs& jobs);

// Judges any matrices for GGX lobes, without albedos.
std::vector<Judged> judge_matrices(const std::vector<Place>& places, const std::vector<Matrix>& matrices, const Jobs& jobs);

// Returns the lobe's share in a convex quad, corners from the shading point: the share through a transformed cosine `near` it, plus
// samples of the difference.
double light_of_quad(const Lobe& lobe, const Matrix& near, const std::vector<Vec>& quad, const Rule& rule);

// Scatter of samples for a lobe's light from quads: one sample's standard deviation over their mean, by sampling density. Samples by
// cosine never find the lobe's part where the transformed cosine is 0.
enum Sampler { kByCosine, kByVisibleNormals, kByArea };
inline constexpr int kSamplers = 3;
struct Sampled {
    Place place;
    double unseen = 0.0;                    // share of the lobe
    double furnace[kSamplers] = {};         // standard deviation under constant light; 0 for kByArea
    double lights[kSamplers][kLights] = {}; // -1 for a quad with less than kLeastSampled of the lobe
};
inline constexpr double kLeastSampled = 0.02;
std::vector<Sampled> judge_sampling(const Table& table, const std::vector<Place>& places, const Jobs& jobs);

struct Spread {
    double mean = 0.0, median = 0.0, p95 = 0.0, most = 0.0;
};
Spread spread_of(std::vector<double> values); // zeros for an empty list

// Returns L1 at the centre of every cell, [theta][phi][alpha][lambda].
std::vector<double> l1_of_cells(const Table& table, const Jobs& jobs);

// Counts lookups with no positive determinant, among `probes` in the usable range.
std::size_t broken_lookups(const Table& table, std::size_t probes, const Jobs& jobs);

} // namespace burnish::ltc
