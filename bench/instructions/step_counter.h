// Counts the instructions that this thread executes, where no other tool here can: valgrind knows no AVX-512, and virtual machines often
// have no counters. The processor traps after each instruction (the trap flag of x86-64) and a signal handler counts: 2 to 11 microseconds
// each, so frames are small. A repeated string instruction counts once, whatever its length.
#pragma once

#include <cstdint>
#include <functional>

namespace burnish {

// The instructions of `work`, which runs on this thread alone; nothing (0) where the processor is no x86-64. Not reentrant: SIGTRAP is its
// own meanwhile.
uint64_t count_steps(const std::function<void()>& work);

} // namespace burnish
