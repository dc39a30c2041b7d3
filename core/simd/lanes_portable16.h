// Sixteen lanes without intrinsics, so that tests run 16-lane code on every processor. Each operation is a call, which
// keeps compile times to seconds.
#pragma once
#define BN_PORTABLE_CALLS
namespace burnish {
inline namespace BN_ISA_NS {
inline constexpr int kLanes = 16;
}
} // namespace burnish
#include "core/simd/lanes_portable.h"
