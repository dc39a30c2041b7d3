// Fits all entries of a table at once, so that the interpolant is near the lobes, not the nodes alone.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/grid.h"
#include "shading/lab/ltc/node_fit.h"

namespace burnish::ltc {

// Returns the k-th point in the four-dimensional sequence by Roberts (2018), in [0,1)^4. Any number of points is evenly spread.
std::array<double, 4> spread_point(std::size_t k);

// Levenberg-Marquardt steps, in Gauss-Newton form, on all entries at once.
class InterpolantFit {
  public:
    struct State {
        std::vector<Matrix> entries;
        double cost = 0.0; // weighted mean L1 of the samples for `entries`
        double mu = 0.05;
    };

    // Places samples. a_cell: samples per cell. Nodes are samples too, with less weight, which keeps them valid.
    InterpolantFit(const Grid& grid, Model model, int a_cell, const Jobs& jobs);

    // Starts from entries with the grid's symmetries.
    State begin(std::vector<Matrix> entries);
    // Tries one step, and takes it if the cost falls. Returns true if taken. The result depends on the state alone.
    bool step(State& state);
    // Checks `probes` interpolated matrices in the usable range. A determinant below `part` of that from `safe` is too flat: entries
    // around it blend towards `safe`, each by its squared weight there. Repeats until all are fine or blending stops helping. Returns the
    // number of flat probes that remain.
    std::size_t guard(std::vector<Matrix>& entries, const std::vector<Matrix>& safe, double part, std::size_t probes) const;

  private:
    struct Sample {
        Place place;
        double weight;
        Corners corners;
    };
    struct Equations { // for one sample, in its interpolated entry
        std::array<double, 81> hessian;
        std::array<double, 9> gradient;
        double l1;
    };
    void measure(const std::vector<Matrix>& entries);
    std::vector<double> solve(double mu) const;
    std::vector<Matrix> moved(const std::vector<Matrix>& entries, const std::vector<double>& by) const;

    Grid grid_;
    Model model_;
    const Jobs* jobs_;
    Rule rule_, albedo_rule_;
    std::vector<Sample> samples_;
    std::vector<double> albedo_;
    std::vector<std::int32_t> variable_; // by node and element; -1: fixed at 0
    std::size_t variables_ = 0;
    std::vector<std::vector<Corner>> touched_; // by node: samples and the node's weight in them
    std::vector<Equations> equations_;
    double cost_ = 0.0;
};

} // namespace burnish::ltc
