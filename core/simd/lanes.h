// Lane types of the instruction set that this file is compiled for: BN_ISA is its name in isa_list.h, or oracle (double precision) or
// counted (counts its work), both one lane.
//   real     kLanes floating-point numbers      (scalar: float itself; oracle: double itself)
//   integer  kLanes 32-bit integers, wrapping   (scalar and oracle: int32_t itself)
//   mask     kLanes truth values                (scalar and oracle: bool itself)
// Everything lives in burnish::BN_ISA_NS, so that copies of different instruction sets never meet in the
// linker. Same bits in every instruction set: only + - * / sqrt, comparisons, conversions and integer
// operations are used, no fma, no reciprocal approximations; max(a,b) is a > b ? a : b and min(a,b) is a < b
// ? a : b, in NaN and -0 too. The one freedom left is the sign and payload of a NaN that arithmetic makes
// (compilers commute operands); that a result is NaN is promised.
//
// Besides operators (real: + - * / and comparisons; integer: + - * & | ^ ~ and comparisons; mask: & |):
//   splat(float) lit(double) int_lit(int) iota()             the same in every lane; 0, 1, 2...
//   shl(i,n) shr(i,n) shr_logical(i,n)                       n in [0,31], one count for all lanes
//   count_bits4(i)                                           of integers in [0,15]: how many bits are set
//   both either not_ any all none to_bits mask_from_bits     masks; lane 0 is bit 0
//   select(m,a,b) min max clamp abs sqrt floor ceil          both sides of a select are computed
//   to_real to_int round_to_int bits_of real_from_bits       to_int truncates; NaN and out of range become
//                                                            INT_MIN
//   load store load_int store_int load_first store_first     unaligned; _first: n lanes, the others read 0 and
//                                                            stay unwritten
//   gather gather_int table_value table_int                  element index[lane]; tables: 16 readable entries,
//                                                            index in [0,15]
//   compress_store_int(to, i, m)                             lanes of m to consecutive places; gives their number.
//                                                            All kLanes places may be written
//   expand_load expand_load_int(from, m)                     the reverse
//   store_triples(to, more, r, g, b)                         RGB of lanes 0-7 to `to`, of lanes 8-15 to `more`
//   stream_lines(to, from, n) stream_fence                   n floats, a multiple of 16, each at a multiple of 64 bytes,
//                                                            past the caches; others may read them after the fence
//   load_triples_int                                         consecutive triples, the k-th of each to out[k]
//   reduce_min reduce_max reduce_add                         lane k with lane k + n/2, then n/4...: depends on
//                                                            the width
//   load_records16 store_records16 load_quads store_quads    array-of-struct access: see lanes_scalar.h
//   blend_records blend_records_low blend_quad load_pairs
//   texel_zero texel_add plan_texels texel_values            bilinear accumulation of RGBA half texels: see
//   load_texel_pair                                          lanes_scalar.h
//   wide: + - * /, wide_lit to_wide, to_real                 a double by lane
// Indices of gathers are signed; those of texels are unsigned 32-bit, those of records of 64 bytes below 2^29,
// of 16 bytes below 2^31.
#pragma once

#define BN_INLINE static inline __attribute__((always_inline))

#ifndef BN_ISA
#define BN_ISA scalar
#endif

// BN_ISA_NS: bn_<name>; BN_ISA_NAME: the name as text
#define BN_JOINED_(a, b) a##b
#define BN_JOINED(a, b) BN_JOINED_(a, b)
#define BN_TEXT_(x) #x
#define BN_TEXT(x) BN_TEXT_(x)
#define BN_ISA_NS BN_JOINED(bn_, BN_ISA)
#define BN_ISA_NAME BN_TEXT(BN_ISA)
// clang-format off
#define BN_LANES_FILE BN_TEXT(core/simd/BN_JOINED(lanes_, BN_ISA).h)
// clang-format on
#include BN_LANES_FILE
