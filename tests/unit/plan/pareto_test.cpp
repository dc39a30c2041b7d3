#include "apps/plan/pareto.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace burnish {
namespace {

using Points = std::vector<PlanPoint>;

double sum(const std::vector<Points>& fronts, const std::vector<std::size_t>& at, double PlanPoint::*member)
{
    double total = 0.0;
    for (std::size_t h = 0; h < fronts.size(); ++h)
        total += fronts[h][at[h]].*member;
    return total;
}

Points random_points(std::mt19937& random, int count)
{
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Points points;
    for (int i = 0; i < count; ++i)
        points.push_back({unit(random), unit(random), static_cast<std::size_t>(i)});
    return points;
}

TEST(pareto, has_a_point_as_good_as_any)
{
    std::mt19937 random(7);
    for (int round = 0; round < 1000; ++round) {
        const Points points = random_points(random, 1 + round % 12), front = pareto_front(points);
        ASSERT_FALSE(front.empty());
        for (std::size_t i = 1; i < front.size(); ++i) {
            EXPECT_GT(front[i].cost, front[i - 1].cost);
            EXPECT_LT(front[i].error, front[i - 1].error);
        }
        for (const PlanPoint& p : points)
            EXPECT_TRUE(
                std::any_of(front.begin(), front.end(), [&](const PlanPoint& f) { return f.cost <= p.cost && f.error <= p.error; }));
    }
}

TEST(pareto, of_equal_points_is_one)
{
    EXPECT_EQ(pareto_front({{1, 1, 3}, {1, 1, 4}}).size(), 1u);
    const Points same_error = pareto_front({{2, 0.5, 0}, {1, 0.5, 1}});
    ASSERT_EQ(same_error.size(), 1u);
    EXPECT_EQ(same_error[0].setting, 1u); // the cheaper one
}

// Returns the least cost over all choices of points with a summed error of `error` or less.
double exhaustive(const std::vector<Points>& all, std::size_t from, double error)
{
    if (from == all.size())
        return error >= 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    double least = std::numeric_limits<double>::infinity();
    for (const PlanPoint& p : all[from])
        least = std::min(least, p.cost + exhaustive(all, from + 1, error - p.error));
    return least;
}

TEST(pareto, choices_hold_the_bound_at_the_least_cost)
{
    std::mt19937 random(11);
    for (int round = 0; round < 300; ++round) {
        std::vector<Points> all, fronts;
        for (int m = 0; m < 5; ++m) {
            all.push_back(random_points(random, 6));
            fronts.push_back(pareto_front(all.back()));
        }
        const double error = std::uniform_real_distribution<double>(0.9, 2.0)(random);
        const std::vector<std::size_t> at = within_error(fronts, error);
        const double least = exhaustive(all, 0, error);
        if (std::isinf(least)) {
            for (std::size_t h = 0; h < fronts.size(); ++h)
                EXPECT_EQ(at[h] + 1, fronts[h].size()) << "not the least error";
            continue;
        }
        EXPECT_LE(sum(fronts, at, &PlanPoint::error), error);
        EXPECT_NEAR(sum(fronts, at, &PlanPoint::cost), least, 1e-12);
    }
}

TEST(pareto, many_materials_stay_near_the_best)
{
    std::mt19937 random(19);
    std::vector<Points> fronts;
    double mean = 0.0;
    for (int m = 0; m < 200; ++m) {
        fronts.push_back(pareto_front(random_points(random, 13)));
        mean += 0.5 * (fronts.back().front().error + fronts.back().back().error);
    }
    const std::vector<std::size_t> at = within_error(fronts, mean);
    EXPECT_LE(sum(fronts, at, &PlanPoint::error), mean);
    // No single step back holds the bound and saves more than the front's grain
    for (std::size_t m = 0; m < fronts.size(); ++m)
        if (at[m] > 0) {
            const PlanPoint &now = fronts[m][at[m]], &before = fronts[m][at[m] - 1];
            const bool holds = sum(fronts, at, &PlanPoint::error) - now.error + before.error <= mean;
            EXPECT_FALSE(holds && now.cost - before.cost > 0.01 * sum(fronts, at, &PlanPoint::cost));
        }
}

TEST(pareto, a_larger_cost_never_errs_more)
{
    std::mt19937 random(17);
    for (int round = 0; round < 200; ++round) {
        std::vector<Points> fronts;
        for (int m = 0; m < 4; ++m)
            fronts.push_back(pareto_front(random_points(random, 7)));
        double least = 0.0, error = 10.0;
        for (const Points& front : fronts)
            least += front.front().cost;
        for (double cost = 0.0; cost < 4.5; cost += 0.05) {
            const std::vector<std::size_t> at = within_cost(fronts, cost);
            EXPECT_LE(sum(fronts, at, &PlanPoint::cost), std::max(cost, least));
            EXPECT_LE(sum(fronts, at, &PlanPoint::error), error);
            error = sum(fronts, at, &PlanPoint::error);
        }
        for (std::size_t h = 0; h < fronts.size(); ++h)
            EXPECT_EQ(within_cost(fronts, 10.0)[h] + 1, fronts[h].size());
    }
}

TEST(pareto, a_smaller_bound_never_costs_less_or_errs_more)
{
    std::mt19937 random(13);
    for (int round = 0; round < 200; ++round) {
        std::vector<Points> fronts;
        for (int m = 0; m < 4; ++m)
            fronts.push_back(pareto_front(random_points(random, 7)));
        double cost = 0.0, error = 10.0;
        for (double bound = 3.0; bound > 0.0; bound -= 0.05) {
            const std::vector<std::size_t> at = within_error(fronts, bound);
            EXPECT_GE(sum(fronts, at, &PlanPoint::cost), cost);
            EXPECT_LE(sum(fronts, at, &PlanPoint::error), error);
            cost = sum(fronts, at, &PlanPoint::cost), error = sum(fronts, at, &PlanPoint::error);
        }
    }
}

} // namespace
} // namespace burnish
