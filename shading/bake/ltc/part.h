// What is kept of the bake of a table, from which it goes on. Little-endian: 8 bytes "bnltcp1\n"; uint64 key of the options, chains, steps,
// 1 where the fit of all has begun; float64 cost, mu, cost before; per node float64 L1, then nine float64 of the matrix fitted alone; where
// the fit of all has begun, nine float64 a node of it; uint64 xxHash64 of all before.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/bake/ltc/interpolant_fit.h"

namespace burnish::ltc {

std::size_t chains_of(const Grid& grid); // of nodes that differ in theta alone

// Everything that the work has so far.
struct Progressed {
    explicit Progressed(const Grid& grid) : all_chains(chains_of(grid)), l1(grid.nodes()), nodes(grid.nodes()) {}
    std::uint64_t all_chains; // of the whole table
    std::uint64_t chains = 0, steps = 0;
    std::vector<double> l1;        // of the nodes
    std::vector<Matrix> nodes;     // fitted alone
    InterpolantFit::State state{}; // of the fit of all; no entries: not begun
    double cost_before = 0.0;
};

std::vector<std::uint8_t> part_bytes(std::uint64_t key, const Progressed& p);

// Into `to`, which has the grid's number of nodes. What is of another key, damaged, or further than `steps`, is an Error, and `to` is as it
// was.
Status parse_part(const std::vector<std::uint8_t>& bytes, const std::string& path, std::uint64_t key, std::uint64_t steps, Progressed& to);

} // namespace burnish::ltc
