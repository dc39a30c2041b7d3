// Sixteen lanes without intrinsics, for tests: what is written for 16 lanes runs on every processor. Every operation is a call, so that
// files compile in seconds.
#pragma once
#define BN_PORTABLE_CALLS
namespace burnish {
inline namespace BN_ISA_NS {
inline constexpr int kLanes = 16;
}
} // namespace burnish
#include "core/simd/lanes_portable.h"
