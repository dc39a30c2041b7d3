// A table of transformed cosines from nothing: every node fitted, then the interpolant, then what keeps its matrices valid.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/table.h"

namespace burnish::ltc {

struct BakeOptions {
    Grid grid;
    Model model = Model::ggx;
    int samples_a_cell = 8;                     // of the fit of the interpolant
    int steps = 12;                             // of it, taken or not; 0: the nodes as they are fitted
    Norm norm = Norm::l1;                       // of the nodes' fits; others begin as the document's do, see fit_chain()
    bool align = true;                          // else each matrix is turned as its own singular vectors have it
    bool symmetry = true;                       // what has to be zero or equal is made so; else every node is fitted by itself
    int rule = 15;                              // of directions that nodes are fitted by: see Rule
    std::string checkpoint;                     // a file to go on from and to keep up to date; empty: none
    const std::atomic<bool>* stop = nullptr;    // set by another thread or a signal: end soon, with everything in the checkpoint
    std::function<void(std::size_t)> advance{}; // so much of bake_units() is done
};

std::size_t bake_units(const BakeOptions& options); // of the whole work

struct Baked {
    Table table;
    double node_l1 = 0.0, fit_l1_before = 0.0, fit_l1 = 0.0; // mean over nodes; of the interpolant's samples before its fit and after
    std::size_t weak_lookups = 0, probes = 0;                // whose determinant stayed below the guard's bound
};

// Bytes do not depend on threads, or on where the work was interrupted. Nothing where it was stopped. A checkpoint of other options, or a
// damaged one, is an Error.
Result<std::optional<Baked>> bake_table(const BakeOptions& options, const Jobs& jobs);

// The node fits alone, as entries hold them: of one azimuth, width and ratio for all theta. By L1 from the natural matrix; by the other
// norms from the plain one, an ellipse about the mirror direction. From the neighbour's fit too, and the nearer one by the norm is taken.
struct Chain {
    std::vector<Matrix> entries;
    std::vector<double> l1;
};
Chain fit_chain(const BakeOptions& options, int phi, int alpha, int lambda);

} // namespace burnish::ltc
