// Checkpoint of a table's bake. Little-endian: 8 bytes "bnltcp1\n"; uint64 key of the options, chains, steps, 1 if the common fit has
// begun; float64 cost, mu, cost before; per node float64 L1, then nine float64 for the node's own matrix; if the common fit has begun,
// nine float64 per node for it; uint64 xxHash64 of all bytes before.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/lab/ltc/interpolant_fit.h"

namespace burnish::ltc {

std::size_t chains_of(const Grid& grid); // runs of nodes that differ in theta alone

// All progress of a bake.
struct BakeProgress {
    explicit BakeProgress(const Grid& grid) : all_chains(chains_of(grid)), l1(grid.nodes()), nodes(grid.nodes()) {}
    std::uint64_t all_chains; // in the whole table
    std::uint64_t chains = 0, steps = 0;
    std::vector<double> l1;        // by node
    std::vector<Matrix> nodes;     // each fitted alone
    InterpolantFit::State state{}; // common fit; no entries: not begun
    double cost_before = 0.0;
};

std::vector<std::uint8_t> bake_checkpoint_bytes(std::uint64_t key, const BakeProgress& p);

// Parses a checkpoint into `to`, which must have the grid's number of nodes. Another key, damage, or more than `steps` steps is an Error,
// and `to` stays unchanged.
Status parse_bake_checkpoint(const std::vector<std::uint8_t>& bytes, const std::string& path, std::uint64_t key, std::uint64_t steps,
                             BakeProgress& to);

} // namespace burnish::ltc
