// Prunes a stage for given specialization constants and known numbers in buffers. Drivers inline every function before they fold constants,
// and know no buffer, so a pruned stage saves them work. Branches on known values go first, then functions without a caller.
#pragma once
#include <cstdint>
#include <vector>

namespace burnish {

// A 32-bit integer in a storage buffer of set 0 that has one value while the stage is used. In a buffer that is an array of structures, all
// elements have the value.
struct KnownNumber {
    std::uint32_t binding, offset; // offset: in bytes, within the buffer or an element
    std::int32_t value;
};

// Returns the stage under these constants, still to be specialized. words: SPIR-V of one of our stages. constants: values of constant_id
// 0, 1, 2...; further constants keep their defaults. Every remaining instruction is unchanged, so the results have equal bits. Returns the
// words unchanged if they are no module, or if their control flow is not understood (phis in loops).
std::vector<std::uint32_t> pruned(const std::vector<std::uint32_t>& words, const std::vector<std::int32_t>& constants,
                                  const std::vector<KnownNumber>& numbers = {});

} // namespace burnish
