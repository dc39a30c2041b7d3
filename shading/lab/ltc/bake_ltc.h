// Bakes a table of linearly transformed cosines: fits every node, then the interpolant, then keeps its matrices valid.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/table.h"
#include "shading/lab/ltc/node_fit.h"

namespace burnish::ltc {

// Nodes that differ in theta alone.
struct Chain {
    std::vector<Matrix> entries;
    std::vector<double> l1;
};

struct BakeOptions {
    Grid grid;
    Model model = Model::ggx;
    int samples_a_cell = 8;                     // for the interpolant's fit
    int steps = 12;                             // in that fit, accepted or not; 0: keep the nodes' fits
    Norm norm = Norm::l1;                       // for node fits; norms other than l1 start as the paper does, see fit_chain()
    bool align = true;                          // else each matrix takes the rotation of its singular vectors
    bool symmetry = true;                       // enforces zeros and equal entries; else every node is fitted by itself
    int rule = 15;                              // directions for node fits: see Rule
    std::string checkpoint;                     // file to resume from and to update; empty: none
    const std::atomic<bool>* stop = nullptr;    // set by another thread or a signal: end soon, with all progress in the checkpoint
    std::function<void(std::size_t)> advance{}; // reports finished units, out of bake_units()
    std::vector<Chain> fitted{};                // all chains, as fit_chains() made them before; empty: none
};

std::size_t bake_units(const BakeOptions& options);  // total work
std::uint64_t bake_key(const BakeOptions& options);  // hash of what decides the table
std::size_t bake_chains(const BakeOptions& options); // runs of nodes that are fitted one after the other

struct Baked {
    Table table;
    double node_l1 = 0.0, fit_l1_before = 0.0, fit_l1 = 0.0; // mean over nodes; over the interpolant's samples before and after its fit
    std::size_t weak_lookups = 0, probes = 0;                // lookups with a determinant below the guard's bound
};

// Bakes a table. The bytes depend neither on threads nor on interruptions. Returns nothing if stopped. A checkpoint with other options, or
// a damaged one, is an Error.
Result<std::optional<Baked>> bake_table(const BakeOptions& options, const Jobs& jobs);

// Fits the nodes of one azimuth, width and ratio, for all theta. Entries are as stored. L1 fits start from the natural matrix; other norms
// start from the plain one, an ellipse about the mirror direction. A second fit starts from the neighbour's fit, and the better one by the
// norm is kept.
Chain fit_chain(const BakeOptions& options, int phi, int alpha, int lambda);
// Fits chains [first, first + count) of bake_chains(). Chains that follow from others by symmetry are empty.
std::vector<Chain> fit_chains(const BakeOptions& options, std::size_t first, std::size_t count, const Jobs& jobs);

} // namespace burnish::ltc
