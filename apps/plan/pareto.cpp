#include "apps/plan/pareto.h"

#include <algorithm>
#include <cstdint>

namespace burnish {
namespace {

// A picture of the materials so far: the point of the last one, and the picture of those before.
struct Picture {
    double cost = 0.0, error = 0.0;
    std::uint32_t before = 0, point = 0;
};

// Keeps what no other one beats, by rising cost and falling error.
template <class T> std::vector<T> unbeaten(std::vector<T> all)
{
    std::stable_sort(all.begin(), all.end(), [](const T& a, const T& b) { return a.cost != b.cost ? a.cost < b.cost : a.error < b.error; });
    std::vector<T> front;
    for (const T& p : all)
        if (front.empty() || p.error < front.back().error)
            front.push_back(p);
    return front;
}

// Drops pictures whose error is nearly a cheaper one's, until few enough are left. The least error stays.
void thin(std::vector<Picture>& front)
{
    for (double share = 1e-4; front.size() > kMostPictures; share *= 2.0) {
        std::vector<Picture> kept;
        for (std::size_t i = 0; i < front.size(); ++i)
            if (kept.empty() || i + 1 == front.size() || front[i].error < kept.back().error * (1.0 - share))
                kept.push_back(front[i]);
        front = std::move(kept);
    }
}

// Returns the fronts of the first material, of the first two, and so on.
std::vector<std::vector<Picture>> front_of_pictures(const std::vector<std::vector<PlanPoint>>& fronts)
{
    std::vector<std::vector<Picture>> made = {{Picture()}};
    for (const std::vector<PlanPoint>& front : fronts) {
        std::vector<Picture> all;
        for (std::uint32_t b = 0; b < made.back().size(); ++b)
            for (std::uint32_t p = 0; p < front.size(); ++p)
                all.push_back({made.back()[b].cost + front[p].cost, made.back()[b].error + front[p].error, b, p});
        made.push_back(unbeaten(std::move(all)));
        thin(made.back());
    }
    return made;
}

// Returns the points of a picture of all materials.
std::vector<std::size_t> points_of(const std::vector<std::vector<Picture>>& made, std::size_t picture)
{
    std::vector<std::size_t> at(made.size() - 1);
    for (std::size_t m = made.size() - 1; m > 0; --m) {
        at[m - 1] = made[m][picture].point;
        picture = made[m][picture].before;
    }
    return at;
}

} // namespace

std::vector<PlanPoint> pareto_front(std::vector<PlanPoint> points)
{
    return unbeaten(std::move(points));
}

std::vector<std::size_t> within_error(const std::vector<std::vector<PlanPoint>>& fronts, double error)
{
    const std::vector<std::vector<Picture>> made = front_of_pictures(fronts);
    const std::vector<Picture>& all = made.back();
    const auto found = std::find_if(all.begin(), all.end(), [=](const Picture& p) { return p.error <= error; });
    return points_of(made, found == all.end() ? all.size() - 1 : static_cast<std::size_t>(found - all.begin()));
}

std::vector<std::size_t> within_cost(const std::vector<std::vector<PlanPoint>>& fronts, double cost)
{
    const std::vector<std::vector<Picture>> made = front_of_pictures(fronts);
    const std::vector<Picture>& all = made.back();
    const auto found = std::find_if(all.rbegin(), all.rend(), [=](const Picture& p) { return p.cost <= cost; });
    return points_of(made, found == all.rend() ? 0 : static_cast<std::size_t>(all.rend() - found) - 1);
}

} // namespace burnish
