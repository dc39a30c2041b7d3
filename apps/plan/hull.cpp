#include "apps/plan/hull.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace burnish {
namespace {

// A step along a hull, to its point `to`.
struct Step {
    std::size_t hull, to;
    double cost, error; // changes: cost rises, error falls
};

// Returns all steps, the steepest first. Steps of one hull stay in order, since a hull is convex.
std::vector<Step> steps_of(const std::vector<std::vector<PlanPoint>>& hulls)
{
    std::vector<Step> steps;
    for (std::size_t h = 0; h < hulls.size(); ++h)
        for (std::size_t i = 1; i < hulls[h].size(); ++i)
            steps.push_back({h, i, hulls[h][i].cost - hulls[h][i - 1].cost, hulls[h][i].error - hulls[h][i - 1].error});
    std::stable_sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.error * b.cost < b.error * a.cost; });
    return steps;
}

// Takes steps while `wanted` returns true for the summed cost and error, and the cost after the next step.
std::vector<std::size_t> climb(const std::vector<std::vector<PlanPoint>>& hulls,
                               const std::function<bool(double cost, double error, double next_cost)>& wanted)
{
    std::vector<std::size_t> at(hulls.size(), 0);
    double cost = 0.0, error = 0.0;
    for (const std::vector<PlanPoint>& hull : hulls)
        cost += hull.front().cost, error += hull.front().error;
    for (const Step& step : steps_of(hulls)) {
        if (!wanted(cost, error, cost + step.cost))
            break;
        at[step.hull] = std::max(at[step.hull], step.to), cost += step.cost, error += step.error;
    }
    return at;
}

} // namespace

std::vector<PlanPoint> lower_hull(std::vector<PlanPoint> points)
{
    std::stable_sort(points.begin(), points.end(),
                     [](const PlanPoint& a, const PlanPoint& b) { return a.cost != b.cost ? a.cost < b.cost : a.error < b.error; });
    std::vector<PlanPoint> hull;
    for (const PlanPoint& p : points) {
        if (!hull.empty() && p.error >= hull.back().error)
            continue; // a cheaper setting is as good
        // Drop points above the line to the new one
        while (hull.size() > 1) {
            const PlanPoint &a = hull[hull.size() - 2], &b = hull.back();
            if ((b.error - a.error) * (p.cost - a.cost) < (p.error - a.error) * (b.cost - a.cost))
                break;
            hull.pop_back();
        }
        hull.push_back(p);
    }
    return hull;
}

std::vector<std::size_t> within_error(const std::vector<std::vector<PlanPoint>>& hulls, double error)
{
    return climb(hulls, [=](double, double sum, double) { return sum > error; });
}

std::vector<std::size_t> within_cost(const std::vector<std::vector<PlanPoint>>& hulls, double cost)
{
    return climb(hulls, [=](double, double, double next_cost) { return next_cost <= cost; });
}

} // namespace burnish
