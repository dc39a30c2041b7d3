// How far a table's lobes are from those that they stand for.
#pragma once
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/table.h"

namespace burnish::ltc {

inline constexpr int kLights = 6; // under which a lobe is judged: ceiling, wall, square, strip, half plane, low wall

// One lobe and the errors of what a table has for it.
struct Judged {
    Place place;
    double l1 = 0.0, best_l1 = 0.0;      // of the table; of the transformed cosine fitted to this very lobe
    double pair_l1 = 0.0;                // of the sum of two fitted to it where best_l1 is above kFarOff; else best_l1
    double light_relative[kLights] = {}; // |difference| over the greater of the light and 0.02
    double light_absolute[kLights] = {}; // of the lobe's parts that six quads light, each in [0,1]
    double all_relative = 0.0;           // of nD
    double grazing_absolute = 0.0;       // of fD
};

// `count` lobes without random numbers: theta to 85 degrees, alpha from 0.05, half evenly and half by its logarithm, lambda from 0.1; the
// first `on_nodes` of them on nodes of a grid of 8. `from`: the first point of the sequence.
std::vector<Place> judged_places(std::size_t count, std::size_t on_nodes, std::size_t from);

// The same with theta from 75 to 89 degrees.
std::vector<Place> grazing_places(std::size_t count);

inline constexpr double kFarOff = 0.3; // L1

// cosines: 0: of the table alone; 1: each lobe is fitted alone, too, what no table can surpass; 2: also by the sum of two.
std::vector<Judged> judge(const Table& table, const std::vector<Place>& places, int cosines, const Jobs& jobs);

// The same of any matrices for them, of GGX lobes and without their albedos.
std::vector<Judged> judge_matrices(const std::vector<Place>& places, const std::vector<Matrix>& matrices, const Jobs& jobs);

// The part of a lobe that a convex quad fills, corners from the shading point: by a transformed cosine `near` it, and samples of what both
// differ by.
double light_of_quad(const Lobe& lobe, const Matrix& near, const std::vector<Vec>& quad, const Rule& rule);

// How far samples of the light of a lobe's quads scatter: the deviation of one over their mean, by density. What of the lobe lies where its
// transformed cosine is 0 samples of that never find.
enum Sampler { kByCosine, kByVisibleNormals, kByArea };
inline constexpr int kSamplers = 3;
struct Sampled {
    Place place;
    double unseen = 0.0;                    // part of the lobe
    double furnace[kSamplers] = {};         // deviation under even light; of kByArea 0
    double lights[kSamplers][kLights] = {}; // of a quad with less than kLeastSampled of the lobe: -1
};
inline constexpr double kLeastSampled = 0.02;
std::vector<Sampled> judge_sampling(const Table& table, const std::vector<Place>& places, const Jobs& jobs);

struct Spread {
    double mean = 0.0, median = 0.0, p95 = 0.0, most = 0.0;
};
Spread spread_of(std::vector<double> values); // of none: zeros

// L1 in the middle of every cell, [theta][phi][alpha][lambda].
std::vector<double> l1_of_cells(const Table& table, const Jobs& jobs);

// Of `probes` lookups in the usable range, those whose matrix has no positive determinant.
std::size_t broken_lookups(const Table& table, std::size_t probes, const Jobs& jobs);

} // namespace burnish::ltc
