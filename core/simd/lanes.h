// Lane types of the current instruction set. BN_ISA is the set's name in isa_list.h, or one of three sets with one lane:
// oracle (double precision), counted (counts its work) or mutated (kernels with mistakes).
//   real     kLanes floating-point numbers      (scalar: float itself; oracle: double itself)
//   integer  kLanes 32-bit integers, wrapping   (scalar and oracle: int32_t itself)
//   mask     kLanes booleans                     (scalar and oracle: bool itself)
// All names live in burnish::BN_ISA_NS, so that copies for different instruction sets never meet in the linker.
//
// Every instruction set gives equal bits. Operations are + - * / sqrt, comparisons, conversions and integer arithmetic,
// without fma and reciprocal approximations. max(a,b) is a > b ? a : b and min(a,b) is a < b ? a : b, for NaN and -0
// too. Only the sign and payload of a NaN from arithmetic may differ, because compilers commute operands.
//
// Beside the operators (real: + - * / and comparisons; integer: + - * & | ^ ~ and comparisons; mask: & |):
//   splat(float) lit(double) int_lit(int) iota()             the same in every lane; 0, 1, 2...
//   shl(i,n) shr(i,n) shr_logical(i,n)                       n in [0,31], one count for all lanes
//   count_bits4(i)                                           number of set bits; i in [0,15]
//   both either not_ any all none to_bits mask_from_bits     masks; lane 0 is bit 0
//   select(m,a,b) min max clamp abs sqrt floor ceil          select computes both sides
//   to_real to_int round_to_int bits_of real_from_bits       to_int truncates; NaN and overflow give INT_MIN
//   load store load_int store_int load_first store_first     unaligned. load_first reads n lanes, 0 elsewhere;
//                                                            store_first writes n lanes
//   gather gather_int table_value table_int                  element index[lane]. A table has 16 readable entries,
//                                                            index in [0,15]
//   compress_store_int(to, i, m)                             packs the lanes of m; returns their number. May
//                                                            write kLanes places
//   expand_load expand_load_int(from, m)                     the inverse
//   load_rows(from, more) store_rows(to, more, x)            lanes 0-7 at the first address, lanes 8-15 at the second
//   store_triples(to, more, r, g, b)                         RGB triples: lanes 0-7 to `to`, lanes 8-15 to `more`
//   stream_lines(to, from, n) stream_fence                   writes n floats past the caches, n a multiple of 16,
//                                                            each address a multiple of 64 bytes. Other threads
//                                                            may read them after the fence
//   load_triples_int                                         consecutive triples; element k goes to out[k]
//   reduce_min reduce_max reduce_add                         lane k with lane k + n/2, then n/4...: the result
//                                                            depends on the width
//   load_records16 store_records16 load_quads store_quads    array-of-struct access: see lanes_scalar.h
//   blend_records blend_records_low blend_quad load_pairs
//   texel_zero texel_add plan_texels texel_values            bilinear accumulation of RGBA half texels: see
//   load_texel_pair                                          lanes_scalar.h
//   wide: + - * /, wide_lit to_wide, to_real                 a double in each lane
// Gather indices are signed. Texel indices are unsigned 32-bit. Indices of 64-byte records stay below 2^29, of 16-byte
// records below 2^31.
#pragma once

#define BN_INLINE static inline __attribute__((always_inline))

#ifndef BN_ISA
#define BN_ISA scalar
#endif

// BN_ISA_NS: bn_<name>; BN_ISA_NAME: the name as text.
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
