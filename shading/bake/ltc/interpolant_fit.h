// The entries of a table as one fit: what is the nearest to the lobes is the interpolant, not the nodes alone.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/grid.h"

namespace burnish::ltc {

// The k-th point of the sequence of Roberts (2018) in four dimensions, in [0,1)^4: evenly spread for every number of points.
std::array<double, 4> spread_point(std::size_t k);

// Levenberg-Marquardt steps of Gauss-Newton type on all entries at once.
class InterpolantFit {
  public:
    struct State {
        std::vector<Matrix> entries;
        double cost = 0.0; // mean L1 of the samples, by their weights; of `entries`
        double mu = 0.05;
    };

    // `a_cell`: samples in every cell; nodes are samples too, of less weight, which keeps them valid.
    InterpolantFit(const Grid& grid, Model model, int a_cell, const Jobs& jobs);

    // From entries with the grid's symmetries.
    State begin(std::vector<Matrix> entries);
    // One step, taken where it lowers the cost. True if it was taken. A function of the state alone.
    bool step(State& state);
    // Looks at `probes` interpolated matrices in the usable range, and blends the entries around one whose determinant is below `part` of
    // what `safe` gives there towards `safe`, each by its weight there squared, until there is none or it does not help. Returns how many
    // probes are left.
    std::size_t guard(std::vector<Matrix>& entries, const std::vector<Matrix>& safe, double part, std::size_t probes) const;

  private:
    struct Sample {
        Place place;
        double weight;
        Corners corners;
    };
    struct Equations { // of one sample, in its interpolated entry
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
    std::vector<std::int32_t> variable_; // of node and element; -1: held at 0
    std::size_t variables_ = 0;
    std::vector<std::vector<Corner>> touched_; // of a node: samples and its weight in them
    std::vector<Equations> equations_;
    double cost_ = 0.0;
};

} // namespace burnish::ltc
