// What values of specialization constants leave of a stage. Drivers inline every function before they fold constants: on lavapipe that
// was nearly three quarters of what a frame of known pipelines cost. Here branches on constants go first, then the functions that nothing
// calls.
#pragma once
#include <cstdint>
#include <vector>

namespace burnish {

// words: SPIR-V of one of our stages. constants: values of constant_id 0, 1, 2...; those beyond keep their defaults.
// The same stage under these constants, still to be specialized: every instruction that stays is as it was, so its bits are. Words
// that are no module or hold a control flow that is not understood (phis of loops) come back as they are.
std::vector<std::uint32_t> pruned(const std::vector<std::uint32_t>& words, const std::vector<std::int32_t>& constants);

} // namespace burnish
