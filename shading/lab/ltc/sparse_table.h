// A table with fitted nodes around given lobes only. It shows the accuracy of resolutions that would take too long to bake in full.
#pragma once
#include <cstddef>
#include <map>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/grid.h"

namespace burnish::ltc {

// GGX lobes. Every node is fitted alone from its natural matrix; the interpolant is not fitted.
class SparseTable {
  public:
    SparseTable(const Grid& grid, const std::vector<Place>& places, const Jobs& jobs);
    Matrix lookup(const Place& place) const; // must be one of the places
    std::size_t nodes() const { return entries_.size(); }

  private:
    Grid grid_;
    std::map<std::size_t, Matrix> entries_; // by node
};

} // namespace burnish::ltc
