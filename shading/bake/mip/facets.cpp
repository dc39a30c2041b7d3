#include "shading/bake/mip/facets.h"

#include <algorithm>
#include <cmath>

#include "shading/bake/mip/kept_light.h"
#include "shading/bake/mip/mean_fns.h"

namespace burnish {
namespace {

struct FlatNormal {
    double x, y;
};

struct Group {
    std::vector<FlatNormal> normals;
    double x = 0.0, y = 0.0;             // mean
    double xx = 0.0, yy = 0.0, xy = 0.0; // sums of squares about the mean

    void measure()
    {
        x = y = xx = yy = xy = 0.0;
        for (const FlatNormal& n : normals)
            x += n.x, y += n.y;
        x /= static_cast<double>(normals.size()), y /= static_cast<double>(normals.size());
        for (const FlatNormal& n : normals) {
            const double dx = n.x - x, dy = n.y - y;
            xx += dx * dx, yy += dy * dy, xy += dx * dy;
        }
    }
    double spread() const { return xx + yy; }
};

// Splits a group. Keeps one half in `group`, returns the other.
Group split(Group& group)
{
    const double half = 0.5 * (group.xx - group.yy), length = std::sqrt(half * half + group.xy * group.xy);
    double along_x = 1.0, along_y = 0.0; // direction of largest spread
    if (length > 0.0 && half >= 0.0)
        along_x = length + half, along_y = group.xy;
    else if (length > 0.0)
        along_x = group.xy, along_y = length - half;
    const auto above = [&](const FlatNormal& n) { return (n.x - group.x) * along_x + (n.y - group.y) * along_y > 0.0; };
    Group rest;
    const auto middle = std::stable_partition(group.normals.begin(), group.normals.end(), above);
    rest.normals.assign(middle, group.normals.end());
    group.normals.erase(middle, group.normals.end());
    return rest;
}

} // namespace

std::vector<Facet> facets_of(const MipSource& source, double alike)
{
    const std::vector<float> points = spread_points(source);
    const std::size_t stride = mip::row_stride(kSpreadPoints);
    std::vector<Group> groups(1);
    for (std::size_t i = 0; i < kSpreadPoints; ++i)
        groups[0].normals.push_back({static_cast<double>(points[i]), static_cast<double>(points[stride + i])});
    groups[0].measure();
    while (static_cast<int>(groups.size()) < kMostFacets) {
        const auto widest =
            std::max_element(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.spread() < b.spread(); });
        if (widest->spread() < alike * kSpreadPoints)
            break;
        Group rest = split(*widest);
        if (rest.normals.empty() || widest->normals.empty())
            break;
        widest->measure(), rest.measure();
        groups.push_back(std::move(rest));
    }
    std::vector<Facet> facets;
    for (const Group& g : groups) {
        const double count = static_cast<double>(g.normals.size());
        facets.push_back({static_cast<float>(g.x), static_cast<float>(g.y), static_cast<float>(count / kSpreadPoints),
                          static_cast<float>(g.spread() / count)});
    }
    return facets;
}

} // namespace burnish
