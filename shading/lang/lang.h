// The kernel language: a common subset of C++ and GLSL 4.6. Every technique is written once in it. Kernels include this
// file and other kernels, nothing else. One text becomes SIMD C++ (real = 8 or 16 lanes), scalar C++, double C++ and
// SPIR-V. All float versions give the same bits.
//
// A kernel file:
//     #ifndef BN_NAME_K_H ... #endif       include guard (glslc knows no #pragma once); no other preprocessor line but #include
//     BN_KERNELS_BEGIN ... BN_KERNELS_END  around everything
//     BN_FN real3 name(real x, real3 n)    values in, values out; several results are a struct
// Types: real real2 real3 real4, integer (32 bits, wraps), mask; structs of these. Uniform values (loop counters, options)
// are `int` and `bool`. Members .x .y .z .w, no swizzles.
// Literals: lit(1.0), int_lit(3); uniform values: splat(f); vectors: vec2_of(x,y) vec3_of(x,y,z) vec4_of(x,y,z,w)
// vec3_all(x)...
// Operators: + - * / between reals, between vectors by component, and between a vector and a real; unary -. Comparisons <
// <= > >= == != of reals or integers give a mask. Integers have + - * & | ^ ~ and, with a uniform count, shl shr
// shr_logical.
// Functions:
//  - on reals and vectors: select(m,a,b) min max clamp abs; on reals alone: sqrt floor ceil; on masks: both either not_;
//  - conversions: to_real to_int round_to_int (defined for |x| < 2^31) bits_of real_from_bits;
//  - table_value(real_table, index), table_int(int_table, index): tables of at most 16 entries;
//  - pairs_at(pair_table, index): two consecutive pairs of floats;
//  - texel_zero texel_add texel_value: sums over a texel_buffer;
//  - texel_cell_value: the same over a texel_buffer with three planes, for one cell. A cell is four pairs of rows. Left
//    texels lie at first + pair[k] and, a row later, at first + pair[k] + row in each plane; weights are w<column><row>.
// All other functions are in kernels/math.k.h.
//
// Rules:
//  - No if, ?:, && or || on a varying value: use select(). Both sides are computed, so clamp denominators and keep sqrt
//    arguments >= 0.
//  - `for` with uniform bounds only; `if` on uniform values only.
//  - No fma and no GLSL pow, exp, sin, dot, normalize, mix: math.k.h has its own (k_dot3, k_exp2...). No global constants:
//    use lit().
//  - Every float expression ends in a variable or result of type real, so that GLSL's `precise` reaches the expression.
//    Name a value before you compare, convert or pass it.
//  - No overloads, references, templates, enums, array initialisers or default arguments. No name reserved in either
//    language (half, input, output, sample, filter, buffer, shared, patch, flat, common, active, near, far, and, or), no
//    member called length.
//  - Keep values that matter above 1e-30: GPUs may flush subnormals.
// Assembly (NAME.t.h) is text in the same language. It combines kernels into a technique, a surface or a light. Assembly
// knows the frame and fetches (shading/inputs/stage.h). It has, beyond the kernel language:
//  - uniform_real, a float that all lanes share, with literals 0.5f and float(i);
//  - BN_STAGE instead of BN_FN for long, rare functions, which lanes call instead of inlining;
//  - BN_IN(T) x for large structs, BN_INOUT(T) x for structs that a function changes; void functions; early returns on
//    uniform conditions;
//  - any_wide, double precision: a wide per lane or, in C++, a double that all lanes share. wide_like(w, 1.0) is a number
//    with w's type. Few GPUs are fast at doubles and some have none, so use them only in optional passes;
//  - any_lane(m) no_lane(m), to skip work that no lane needs; most_of_lanes(x), a bound for loops with a varying count.
//    Extra iterations must leave a lane's result unchanged.
#ifndef BN_LANG_H
#define BN_LANG_H

// BN_MUTANT(name, right, wrong) is `right`. The laboratory's copy of the kernels can take `wrong`, a mistake that engines make:
// shading/lab/conform/mutated.h lists the names.
#ifndef BN_MUTANT
#define BN_MUTANT(name, right, wrong) right
#endif

#ifdef __cplusplus
#include "shading/lang/cxx.h"
#else
#include "shading/lang/glsl.h"
#endif

#endif
