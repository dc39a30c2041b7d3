// Chooses one setting for each material, so that a picture's error holds a bound at the least cost. A picture's mean error is the sum of
// its materials' parts. So the best choices lie on each material's lower convex hull of (cost, error), and are reached by its steepest
// steps (Lagrange multipliers; Everett 1963, "Generalized Lagrange Multiplier Method for Solving Problems of Optimum Allocation of
// Resources").
#pragma once
#include <cstddef>
#include <vector>

namespace burnish {

struct PlanPoint {
    double cost = 0.0, error = 0.0; // the material's parts of the picture's cost and mean error, at least 0
    std::size_t setting = 0;        // index of the caller's
};

// Returns the lower convex hull, by rising cost and falling error. The first point is the cheapest, the last one has the least error.
// Expects at least one point.
std::vector<PlanPoint> lower_hull(std::vector<PlanPoint> points);

// Return a point of each hull.
// within_error: the cheapest with a summed error of `error` or less. The chosen errors never rise as `error` falls. Where no choice reaches
// it: the least errors. within_cost: the least summed error with a summed cost of `cost` or less. Where no choice reaches it: the cheapest.
std::vector<std::size_t> within_error(const std::vector<std::vector<PlanPoint>>& hulls, double error);
std::vector<std::size_t> within_cost(const std::vector<std::vector<PlanPoint>>& hulls, double cost);

} // namespace burnish
