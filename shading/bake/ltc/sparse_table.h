// A table of which only the nodes around some lobes are fitted: what a resolution is worth there that nobody waits for.
#pragma once
#include <cstddef>
#include <map>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/grid.h"

namespace burnish::ltc {

// GGX lobes; every node alone, from its natural matrix, without the fit of the interpolant.
class SparseTable {
  public:
    SparseTable(const Grid& grid, const std::vector<Place>& places, const Jobs& jobs);
    Matrix lookup(const Place& place) const; // one of the places
    std::size_t nodes() const { return entries_.size(); }

  private:
    Grid grid_;
    std::map<std::size_t, Matrix> entries_; // by node
};

} // namespace burnish::ltc
