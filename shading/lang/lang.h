// The kernel language: the common subset of C++ and GLSL 4.6 in which every technique is written once. Kernels include this file
// and other kernels, nothing else. One text becomes SIMD C++ (real = 8 or 16 lanes), scalar C++, double C++ and SPIR-V, and all
// float versions give the same bits.
//
// A kernel file:
//     #ifndef BN_NAME_K_H ... #endif       include guard (glslc knows no #pragma once); no other preprocessor line but #include
//     BN_KERNELS_BEGIN ... BN_KERNELS_END  around everything
//     BN_FN real3 name(real x, real3 n)    values in, values out; several results are a struct
// Types: real real2 real3 real4, integer (32 bits, wraps), mask; structs of these. `int` and `bool` for what is uniform (loop
// counters, options). Members .x .y .z .w, no swizzles.
// Literals lit(1.0), int_lit(3), uniform values splat(f); vectors vec2_of(x,y) vec3_of(x,y,z) vec4_of(x,y,z,w) vec3_all(x)...
// Operators: + - * / between reals; between vectors component by component; vector with real; unary -; < <= > >= == != between
// reals or integers give a mask; integers + - * & | ^ ~ and shl shr shr_logical with a uniform count.
// Functions: select(m,a,b) min max clamp abs sqrt floor ceil, also (but for floor, ceil, sqrt) on vectors; both either not_;
// to_real to_int round_to_int (defined for |x| < 2^31) bits_of real_from_bits; table_value table_int on a real_table or
// int_table of at most 16 entries; pairs_at(table, index), two pairs of floats that follow each other in a pair_table; texel_zero texel_add
// texel_value on a texel_buffer; texel_cell_value on one that holds three planes, for a cell: four pairs of rows, whose left texels lie at
// first + pair[k] and `row` further in each plane, with weights w<column><row>. Everything else is in kernels/math.k.h.
//
// Rules:
//  - no if, ?:, && or || on a varying value: select(). Both sides are computed: clamp denominators, keep sqrt arguments >= 0.
//  - `for` with uniform bounds only; `if` on uniform values only.
//  - no fma, no pow/exp/sin/dot/normalize/mix of GLSL: math.k.h has them (k_dot3, k_exp2...). No global constants: lit() in place.
//  - every float expression ends in a variable or result of type real, so that GLSL's `precise` reaches it: name the
//    value before comparing, converting or passing it.
//  - no overloads, references, templates, enum, array initialisers or default arguments of your own; no reserved word of either
//    language as a name (half, input, output, sample, filter, buffer, shared, patch, flat, common, active, near, far, and, or),
//    no member called length.
//  - keep values that matter above 1e-30: GPUs may flush subnormals.
// Assembly, what a technique, a surface or a light makes of kernels, is text in the same language (NAME.t.h). It knows the frame and
// fetches: shading/lang/stage.h. Beside what kernels have there are
//  - uniform_real, a float that all lanes share, with literals 0.5f and float(i);
//  - BN_STAGE instead of BN_FN for what is long and seldom asked for, which lanes then call;
//  - BN_IN(T) x for structs that are large, BN_INOUT(T) x for those that a function changes; void functions, early returns on what is
//    uniform;
//  - any_wide, in double precision: a wide of each lane or, in C++ where all share it, a double; wide_like(w, 1.0) is a number of the same
//    kind; few GPUs are fast at it and some have none, so it is for what a pass can do without;
//  - any_lane(m) no_lane(m), to leave out what no lane needs, and most_of_lanes(x), a bound for loops whose count varies: what a lane
//    does not need must then leave its result as it is.
#ifndef BN_LANG_H
#define BN_LANG_H

#ifdef __cplusplus
#include "shading/lang/cxx.h"
#else
#include "shading/lang/glsl.h"
#endif

#endif
