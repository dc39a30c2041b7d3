#include "shading/lab/ltc/sparse_table.h"

#include "shading/lab/ltc/node_fit.h"

namespace burnish::ltc {
namespace {

Matrix fitted_alone(const Grid& grid, std::size_t node)
{
    static const Rule rule(14), albedo_rule(17);
    const std::array<int, 4> i = grid.indices(node);
    const std::size_t own = i[0] == 0 ? grid.node(0, 0, i[2], i[3]) : node; // along the normal, one lobe serves all azimuths
    const Place place = grid.place(own);
    const Mask zero = grid.zero(own);
    Matrix m = fit_lobe(LobePoints(normalised_lobe(place, albedo_rule), rule), natural_matrix(place), zero).m;
    m = in_natural_gauge(m, place);
    for (std::size_t e = 0; e < 9; ++e)
        if (zero >> e & 1u)
            m[e] = 0.0;
    return grid.held(m, place);
}

} // namespace

SparseTable::SparseTable(const Grid& grid, const std::vector<Place>& places, const Jobs& jobs) : grid_(grid)
{
    for (const Place& place : places)
        for (const Corner& corner : grid.corners(place))
            if (corner.weight > 0.0)
                entries_[corner.node] = {};
    std::vector<std::pair<const std::size_t, Matrix>*> all;
    for (auto& entry : entries_)
        all.push_back(&entry);
    jobs.parallel_for(all.size(), [&](std::size_t k, int) { all[k]->second = fitted_alone(grid_, all[k]->first); });
}

Matrix SparseTable::lookup(const Place& place) const
{
    Matrix sum{};
    for (const Corner& corner : grid_.corners(place))
        if (corner.weight > 0.0)
            for (std::size_t e = 0; e < 9; ++e)
                sum[e] += corner.weight * entries_.at(corner.node)[e];
    return grid_.shown(sum, place);
}

} // namespace burnish::ltc
