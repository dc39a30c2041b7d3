// Prunes a stage for given specialization constants. Drivers inline every function before they fold constants, so a pruned stage saves
// them work. Branches on constants go first, then functions without a caller.
#pragma once
#include <cstdint>
#include <vector>

namespace burnish {

// Returns the stage under these constants, still to be specialized. words: SPIR-V of one of our stages. constants: values of constant_id
// 0, 1, 2...; further constants keep their defaults. Every remaining instruction is unchanged, so the results have equal bits. Returns the
// words unchanged if they are no module, or if their control flow is not understood (phis in loops).
std::vector<std::uint32_t> pruned(const std::vector<std::uint32_t>& words, const std::vector<std::int32_t>& constants);

} // namespace burnish
