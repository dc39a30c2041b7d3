// Lane types of the instruction set that this file is compiled for (BN_ISA: 0 scalar, 1 AVX2, 2 AVX-512, 3 the double oracle):
//   real     kLanes floating-point numbers      (scalar: float itself; oracle: double itself)
//   integer  kLanes 32-bit integers, wrapping   (scalar and oracle: int32_t itself)
//   mask     kLanes truth values                (scalar and oracle: bool itself)
// Everything lives in burnish::BN_ISA_NS, so that copies of different instruction sets never meet in the linker.
// Same bits in every instruction set: only + - * / sqrt, comparisons, conversions and integer operations are used, no fma, no
// reciprocal approximations; max(a,b) is a > b ? a : b and min(a,b) is a < b ? a : b, in NaN and -0 too.
#pragma once

#ifndef BN_ISA
#define BN_ISA 0
#endif

#if BN_ISA == 0
#define BN_ISA_NS bn_scalar
#include "core/simd/lanes_scalar.h"
#elif BN_ISA == 1
#define BN_ISA_NS bn_avx2
#include "core/simd/lanes_avx2.h"
#elif BN_ISA == 2
#define BN_ISA_NS bn_avx512
#include "core/simd/lanes_avx512.h"
#elif BN_ISA == 3
#define BN_ISA_NS bn_double
#include "core/simd/lanes_scalar.h"
#endif
