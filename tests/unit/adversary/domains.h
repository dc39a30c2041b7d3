// The domains of a program's kernels, and their building blocks.
#pragma once
#include <vector>

#include "tests/unit/adversary/search.h"
#include "tests/unit/models/harness.h"

namespace burnish::test {

const std::vector<Domain>& domains(); // each program defines its domains

// Each maps u in [0,1).
double straight(double u, double low, double high);
double by_factors(double u, double low, double high); // low > 0
// Returns a unit direction above the horizon: a third uniform over heights, a third down to 1e-4 above the horizon, a third near the
// normal.
Vec eye_of(double u, double v);
// Returns a unit normal with a slope of 1e-5 to 10.
Vec facet_of(double u, double v);
Vec any_direction(double u, double v);
Vec mirrored(Vec o, Vec h);
void append(std::vector<double>& to, const Vec& v);
// Maps u to a range {low, high} from Domain::of: by factors if low > 0, else linearly.
double in_range(double u, const std::vector<double>& range);
std::vector<double> ranges(const Domain& d, const double* u); // one number a range

} // namespace burnish::test
