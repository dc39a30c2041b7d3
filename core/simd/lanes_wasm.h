// WebAssembly's lanes: SIMD128, strict, never relaxed.
#pragma once
namespace burnish {
inline namespace BN_ISA_NS {
inline constexpr int kLanes = 8;
}
} // namespace burnish
#include "core/simd/lanes_portable.h"
