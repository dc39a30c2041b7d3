// Instruction sets for lane code, from narrow to wide. A new set is one line here and core/simd/lanes_<name>.h. C++
// reads the list through BN_EACH_ISA; isa.cmake and lint.odr read its lines:
//   BN_ON_<machine>(X(name, use, runs, flags, of))
// machine: any, x86_64, aarch64 or wasm32, the target of the build; any_scalar, x86_64_avx2 and x86_64_avx512 exist unless
// BN_ISA_SET leaves them out. use: "program" compiles every file of bn_isa_objects; "tests" compiles only on a test's request, and
// options do not know the set. runs: true where this processor and its system can run the set (core/simd/cpu.h). flags:
// follow the flags of the rest of the program; -O1 or -O2 where more optimisation only costs compile time.
#pragma once

// clang-format off
#define BN_EACH_ISA(X, of)                                                                                   \
    BN_ON_any_scalar(X(scalar, program, true, "-O1", of))                                                    \
    BN_ON_x86_64_avx2(X(avx2, program, cpu_has_avx2(), "-march=x86-64-v3", of))                              \
    BN_ON_x86_64_avx512(X(avx512, program, cpu_has_avx512(), "-march=x86-64-v4 -mprefer-vector-width=512", of)) \
    BN_ON_x86_64(X(portable8, tests, true, "-O1", of))                                      \
    BN_ON_wasm32(X(wasm, program, true, "-O2", of))                                                          \
    BN_ON_aarch64(X(portable8, program, true, "-O1 -DBN_PORTABLE_CALLS", of))                                \
    BN_ON_any(X(portable16, tests, true, "-O1", of))
// Not instruction sets, but compiled like them: a double in each lane (bn_oracle_objects), counting floats
// (bn_counted_objects), and kernels with mistakes (apps/lab/conform).
#define BN_EACH_TWIN(X, of)                                                                                  \
    X(oracle, tests, true, "-O1", of)                                                                        \
    X(counted, tests, true, "-O1", of)                                                                       \
    X(mutated, tests, true, "-O1", of)
// clang-format on

#define BN_ON_any(row) row
#ifndef BN_WITHOUT_scalar
#define BN_ON_any_scalar(row) row
#else
#define BN_ON_any_scalar(row)
#endif
#ifdef __x86_64__
#define BN_ON_x86_64(row) row
#else
#define BN_ON_x86_64(row)
#endif
#if defined(__x86_64__) && !defined(BN_WITHOUT_avx2)
#define BN_ON_x86_64_avx2(row) row
#else
#define BN_ON_x86_64_avx2(row)
#endif
#if defined(__x86_64__) && !defined(BN_WITHOUT_avx512)
#define BN_ON_x86_64_avx512(row) row
#else
#define BN_ON_x86_64_avx512(row)
#endif
#ifdef __wasm__
#define BN_ON_wasm32(row) row
#else
#define BN_ON_wasm32(row)
#endif
#ifdef __aarch64__
#define BN_ON_aarch64(row) row
#else
#define BN_ON_aarch64(row)
#endif
