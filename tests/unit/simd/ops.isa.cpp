#include "tests/unit/simd/ops.h"

#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

BN_INLINE void put(std::uint32_t* out, real x)
{
    store_int(out, bits_of(x));
}
BN_INLINE void put(std::uint32_t* out, integer i)
{
    store_int(out, i);
}
BN_INLINE void put(std::uint32_t* out, mask m)
{
    store_int(out, select(m, int_lit(1), int_lit(0)));
}

// Defines f_<name>: out = expression of reals a, b, c, integers i, j and masks m, q.
#define BN_OP(name, expression)                                                                                                            \
    void f_##name(const OpInput& in, std::uint32_t* out)                                                                                   \
    {                                                                                                                                      \
        for (int k = 0; k < in.count; k += kLanes) {                                                                                       \
            [[maybe_unused]] const real a = load(in.a + k), b = load(in.b + k), c = load(in.c + k);                                        \
            [[maybe_unused]] const integer i = load_int(in.i + k), j = load_int(in.j + k);                                                 \
            [[maybe_unused]] const mask m = (i & int_lit(1)) != int_lit(0), q = (j & int_lit(2)) != int_lit(0);                            \
            put(out + k, expression);                                                                                                      \
        }                                                                                                                                  \
    }
#define BN_EXACT(name, expression) BN_OP(name, expression)
#define BN_ARITHMETIC(name, expression) BN_OP(name, expression)
#include "tests/unit/simd/ops.def"
#undef BN_EXACT
#undef BN_ARITHMETIC

#define BN_EXACT(name, expression) {#name, false, f_##name},
#define BN_ARITHMETIC(name, expression) {#name, true, f_##name},
const Op kOps[] = {
#include "tests/unit/simd/ops.def"
};

void load_first_fn(const float* from, int n, float* out)
{
    store(out, load_first(from, n));
}
void load_first_int_fn(const std::int32_t* from, int n, std::int32_t* out)
{
    store_int(out, load_first(from, n));
}
void store_first_fn(float* to, const float* x, int n)
{
    store_first(to, load(x), n);
}
void store_first_int_fn(std::int32_t* to, const std::int32_t* x, int n)
{
    store_first(to, load_int(x), n);
}
int compress_fn(std::int32_t* to, const std::int32_t* x, std::uint32_t bits)
{
    return compress_store_int(to, load_int(x), mask_from_bits(bits));
}
void expand_fn(const float* from, const std::int32_t* ints, std::uint32_t bits, float* x, std::int32_t* i)
{
    const mask m = mask_from_bits(bits);
    store(x, expand_load(from, m));
    store_int(i, expand_load_int(ints, m));
}
void stream_fn(float* to, const float* from, int n)
{
    stream_lines(to, from, n);
    stream_fence();
}
void triples_fn(float* first, float* second, const float* r, const float* g, const float* b)
{
    store_triples(first, second, load(r), load(g), load(b));
}
std::uint32_t mask_facts_fn(std::uint32_t bits)
{
    const mask m = mask_from_bits(bits);
    return to_bits(m) | (any(m) ? 1u << 16 : 0u) | (all(m) ? 1u << 17 : 0u) | (none(m) ? 1u << 18 : 0u);
}
void iota_fn(std::int32_t* out)
{
    store_int(out, iota());
}
void gather_fn(const float* base, const std::int32_t* index, float* out)
{
    store(out, gather(base, load_int(index)));
}
void gather_int_fn(const std::int32_t* base, const std::int32_t* index, std::int32_t* out)
{
    store_int(out, gather_int(base, load_int(index)));
}
void table_fn(const float* reals, const std::int32_t* ints, const std::int32_t* index, float* x, std::int32_t* i)
{
    store(x, table_value(reals, load_int(index)));
    store_int(i, table_int(ints, load_int(index)));
}
void reduce_fn(const float* x, float out[3])
{
    float lanes[kMaxLanes];
    store(lanes, reduce_min(load(x)));
    out[0] = lanes[kLanes - 1];
    store(lanes, reduce_max(load(x)));
    out[1] = lanes[kLanes - 1];
    store(lanes, reduce_add(load(x)));
    out[2] = lanes[kLanes - 1];
}
void records_fn(const void* base, const std::int32_t* index, std::int32_t* out)
{
    integer fields[16];
    load_records16(base, load_int(index), fields);
    for (int f = 0; f < 16; ++f)
        store_int(out + f * kLanes, fields[f]);
}
void store_records_fn(void* base, const std::int32_t* fields)
{
    integer r[16];
    for (int f = 0; f < 16; ++f)
        r[f] = load_int(fields + f * kLanes);
    store_records16(base, r);
}
void quads_fn(const void* base, const std::int32_t* index, std::int32_t* out)
{
    integer fields[4];
    load_quads(base, load_int(index), fields);
    for (int f = 0; f < 4; ++f)
        store_int(out + f * kLanes, fields[f]);
}
void store_quads_fn(void* base, const std::int32_t* fields, int n)
{
    const integer r[4] = {load_int(fields), load_int(fields + kLanes), load_int(fields + 2 * kLanes), load_int(fields + 3 * kLanes)};
    store_quads(base, r, n);
}
void triples_int_fn(const std::int32_t* from, std::int32_t* out)
{
    integer r[3];
    load_triples_int(from, r);
    for (int k = 0; k < 3; ++k)
        store_int(out + k * kLanes, r[k]);
}
void wide_fn(const std::int32_t* i, const float* a, const float* b, float* out)
{
    const wide n = to_wide(load_int(i));
    store(out, to_real(n / to_wide(load(a)) - to_wide(load(b)) * n + wide_lit(0.1)));
}
#define BN_BLEND(name, function, fields)                                                                                                   \
    void name(const Blend& in, float* out)                                                                                                 \
    {                                                                                                                                      \
        real c[fields];                                                                                                                    \
        function(in.base, load_int(in.i0), load_int(in.i1), load_int(in.i2), load(in.b0), load(in.b1), load(in.b2), c);                    \
        for (int f = 0; f < fields; ++f)                                                                                                   \
            store(out + f * kLanes, c[f]);                                                                                                 \
    }
BN_BLEND(blend16_fn, blend_records, 16)
BN_BLEND(blend8_fn, blend_records_low, 8)
BN_BLEND(blend4_fn, blend_quad, 4)
void texel_fn(const Texels& in, float* out)
{
    texel_acc acc = texel_zero();
    for (int s = 0; s < in.steps * kLanes; s += kLanes)
        acc = texel_add(acc, in.texels, load_int(in.row0 + s), load_int(in.row1 + s), load(in.w00 + s), load(in.w10 + s), load(in.w01 + s),
                        load(in.w11 + s));
    const real4 value = texel_value(acc);
    store(out, value.x);
    store(out + kLanes, value.y);
    store(out + 2 * kLanes, value.z);
    store(out + 3 * kLanes, value.w);
}

const LaneFns kFns = {BN_ISA_NAME,    kLanes,
                      kOps,           static_cast<int>(sizeof(kOps) / sizeof(kOps[0])),
                      load_first_fn,  load_first_int_fn,
                      store_first_fn, store_first_int_fn,
                      compress_fn,    expand_fn,
                      stream_fn,      triples_fn,
                      mask_facts_fn,  iota_fn,
                      gather_fn,      gather_int_fn,
                      table_fn,       reduce_fn,
                      records_fn,     store_records_fn,
                      quads_fn,       store_quads_fn,
                      triples_int_fn, wide_fn,
                      blend16_fn,     blend8_fn,
                      blend4_fn,      texel_fn};

} // namespace

BN_DEFINE_FNS(LaneFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
