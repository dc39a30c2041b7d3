// Every lane operation as a function over arrays, compiled once for each instruction set from ops.isa.cpp.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish {

inline constexpr int kMaxLanes = 16;

struct OpInput {
    const float *a, *b, *c;
    const std::int32_t *i, *j;
    int count; // a multiple of kMaxLanes
};

struct Op {
    const char* name;
    bool any_nan; // arithmetic that makes NaN: payloads may differ
    void (*run)(const OpInput& in, std::uint32_t* out);
};

struct Blend {
    const float* base;
    const std::int32_t *i0, *i1, *i2;
    const float *b0, *b1, *b2;
};

struct Texels {
    const std::uint16_t* texels;
    const std::int32_t *row0, *row1; // steps * lanes
    const float *w00, *w10, *w01, *w11;
    int steps;
};

// Functions that do not fit Op. One call works on `lanes` lanes. Result arrays are field-major: [field][lane].
struct LaneFns {
    const char* isa;
    int lanes;
    const Op* ops;
    int op_count;
    void (*load_first)(const float* from, int n, float* out);
    void (*load_first_int)(const std::int32_t* from, int n, std::int32_t* out);
    void (*store_first)(float* to, const float* x, int n);
    void (*store_first_int)(std::int32_t* to, const std::int32_t* x, int n);
    int (*compress)(std::int32_t* to, const std::int32_t* x, std::uint32_t bits);
    void (*expand)(const float* from, const std::int32_t* ints, std::uint32_t bits, float* x, std::int32_t* i);
    void (*stream)(float* to, const float* from, int n);
    void (*triples)(float* first, float* second, const float* r, const float* g, const float* b);
    std::uint32_t (*mask_facts)(std::uint32_t bits); // to_bits, and any, all, none in bits 16, 17, 18
    void (*iota)(std::int32_t* out);
    void (*gather)(const float* base, const std::int32_t* index, float* out);
    void (*gather_int)(const std::int32_t* base, const std::int32_t* index, std::int32_t* out);
    void (*table)(const float* reals, const std::int32_t* ints, const std::int32_t* index, float* x, std::int32_t* i);
    void (*reduce)(const float* x, float out[3]); // min, max, add
    void (*records)(const void* base, const std::int32_t* index, std::int32_t* out);
    void (*store_records)(void* base, const std::int32_t* fields);
    void (*quads)(const void* base, const std::int32_t* index, std::int32_t* out);
    void (*store_quads)(void* base, const std::int32_t* fields, int n);
    void (*triples_int)(const std::int32_t* from, std::int32_t* out);
    void (*wide)(const std::int32_t* i, const float* a, const float* b, float* out); // i / a - b * i + 0.1, in doubles
    void (*blend16)(const Blend& in, float* out);
    void (*blend8)(const Blend& in, float* out);
    void (*blend4)(const Blend& in, float* out);
    void (*texel)(const Texels& in, float* out);
};

BN_DECLARE_FNS(LaneFns);

} // namespace burnish
