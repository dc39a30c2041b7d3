// Chooses one setting for each material, so that a picture's error holds a bound at the least cost. A picture's mean error is the sum of
// its materials' parts, and so is its cost. The pictures that no other one beats in both are the Pareto front of all choices. Adding one
// material after another makes the front (the multiple-choice knapsack by dynamic programming; Dudzinski and Walukiewicz 1987, "Exact
// Methods for the Knapsack Problem and its Generalizations").
#pragma once
#include <cstddef>
#include <vector>

namespace burnish {

struct PlanPoint {
    double cost = 0.0, error = 0.0; // the material's parts of the picture's cost and mean error, at least 0
    std::size_t setting = 0;        // index of the caller's
};

// Returns the points that no other one beats in cost and error, by rising cost and falling error. Expects at least one point.
std::vector<PlanPoint> pareto_front(std::vector<PlanPoint> points);

// Returns a point of each material's front.
// within_error: the cheapest with a summed error of `error` or less. Where no choice reaches it: the least errors. within_cost: the least
// summed error with a summed cost of `cost` or less. Where no choice reaches it: the cheapest. Both pick from one front of pictures, which
// depends on no bound. So a smaller error never costs less, and a larger cost never errs more. Many materials have a front with at most
// kMostPictures points: points whose errors are alike fall out.
inline constexpr std::size_t kMostPictures = 4096;
std::vector<std::size_t> within_error(const std::vector<std::vector<PlanPoint>>& fronts, double error);
std::vector<std::size_t> within_cost(const std::vector<std::vector<PlanPoint>>& fronts, double cost);

} // namespace burnish
