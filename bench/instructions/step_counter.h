// Counts the instructions that this thread executes. For machines without other tools: valgrind knows no AVX-512, and
// virtual machines often have no counters. The processor traps after each instruction (the trap flag of x86-64), and a
// signal handler counts. Traps are slow, so frames are small. A repeated string instruction counts once, whatever its
// length.
#pragma once

#include <cstdint>
#include <functional>

namespace burnish {

// Returns the number of instructions in `work`, which runs on this thread alone; 0 where the processor is not x86-64.
// Not reentrant: takes over SIGTRAP during the call.
uint64_t count_steps(const std::function<void()>& work);

} // namespace burnish
