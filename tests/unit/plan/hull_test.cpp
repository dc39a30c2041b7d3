#include "apps/plan/hull.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace burnish {
namespace {

using Points = std::vector<PlanPoint>;

double sum(const std::vector<Points>& hulls, const std::vector<std::size_t>& at, double PlanPoint::*member)
{
    double total = 0.0;
    for (std::size_t h = 0; h < hulls.size(); ++h)
        total += hulls[h][at[h]].*member;
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

TEST(hull, leaves_no_point_below_it)
{
    std::mt19937 random(7);
    for (int round = 0; round < 1000; ++round) {
        const Points points = random_points(random, 1 + round % 12), hull = lower_hull(points);
        ASSERT_FALSE(hull.empty());
        for (std::size_t i = 1; i < hull.size(); ++i) {
            EXPECT_GT(hull[i].cost, hull[i - 1].cost);
            EXPECT_LT(hull[i].error, hull[i - 1].error);
        }
        for (const PlanPoint& p : points) {
            EXPECT_GE(p.cost, hull.front().cost);
            EXPECT_GE(p.error, hull.back().error);
            for (std::size_t i = 1; i < hull.size(); ++i) {
                const PlanPoint &a = hull[i - 1], &b = hull[i];
                EXPECT_GE((p.error - a.error) * (b.cost - a.cost), (b.error - a.error) * (p.cost - a.cost) - 1e-12);
            }
        }
    }
}

TEST(hull, of_equal_points_is_one)
{
    EXPECT_EQ(lower_hull({{1, 1, 3}, {1, 1, 4}}).size(), 1u);
    const Points same_error = lower_hull({{2, 0.5, 0}, {1, 0.5, 1}});
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

TEST(hull, choices_hold_the_bound_at_nearly_the_least_cost)
{
    std::mt19937 random(11);
    double chosen = 0.0, best = 0.0;
    for (int round = 0; round < 300; ++round) {
        std::vector<Points> all, hulls;
        for (int m = 0; m < 5; ++m) {
            all.push_back(random_points(random, 6));
            hulls.push_back(lower_hull(all.back()));
        }
        const double error = std::uniform_real_distribution<double>(0.9, 2.0)(random);
        const std::vector<std::size_t> at = within_error(hulls, error);
        const double least = exhaustive(all, 0, error);
        if (std::isinf(least)) {
            for (std::size_t h = 0; h < hulls.size(); ++h)
                EXPECT_EQ(at[h] + 1, hulls[h].size()) << "not the least error";
            continue;
        }
        EXPECT_LE(sum(hulls, at, &PlanPoint::error), error);
        EXPECT_GE(sum(hulls, at, &PlanPoint::cost), least - 1e-12);
        chosen += sum(hulls, at, &PlanPoint::cost), best += least;
    }
    EXPECT_LE(chosen, 1.15 * best);
}

TEST(hull, a_larger_cost_never_errs_more)
{
    std::mt19937 random(17);
    for (int round = 0; round < 200; ++round) {
        std::vector<Points> hulls;
        for (int m = 0; m < 4; ++m)
            hulls.push_back(lower_hull(random_points(random, 7)));
        double least = 0.0, error = 10.0;
        for (const Points& hull : hulls)
            least += hull.front().cost;
        for (double cost = 0.0; cost < 4.5; cost += 0.05) {
            const std::vector<std::size_t> at = within_cost(hulls, cost);
            EXPECT_LE(sum(hulls, at, &PlanPoint::cost), std::max(cost, least));
            EXPECT_LE(sum(hulls, at, &PlanPoint::error), error);
            error = sum(hulls, at, &PlanPoint::error);
        }
        for (std::size_t h = 0; h < hulls.size(); ++h)
            EXPECT_EQ(within_cost(hulls, 10.0)[h] + 1, hulls[h].size());
    }
}

TEST(hull, a_smaller_bound_never_costs_less_or_errs_more)
{
    std::mt19937 random(13);
    for (int round = 0; round < 200; ++round) {
        std::vector<Points> hulls;
        for (int m = 0; m < 4; ++m)
            hulls.push_back(lower_hull(random_points(random, 7)));
        double cost = 0.0, error = 10.0;
        for (double bound = 3.0; bound > 0.0; bound -= 0.05) {
            const std::vector<std::size_t> at = within_error(hulls, bound);
            EXPECT_GE(sum(hulls, at, &PlanPoint::cost), cost);
            EXPECT_LE(sum(hulls, at, &PlanPoint::error), error);
            cost = sum(hulls, at, &PlanPoint::cost), error = sum(hulls, at, &PlanPoint::error);
        }
    }
}

} // namespace
} // namespace burnish
