#include "bench/micro/limits.h"

#include "shading/lang/lang.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

float multiply_add(int steps, float factor)
{
    real chain[kMultiplyAddChains];
    for (int k = 0; k < kMultiplyAddChains; ++k)
        chain[k] = splat(1.0f + static_cast<float>(k));
    const real by = splat(factor), and_ = splat(1.0f - factor);
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < kMultiplyAddChains; ++k)
            chain[k] = chain[k] * by + and_;
    for (int k = 1; k < kMultiplyAddChains; ++k)
        chain[0] = chain[0] + chain[k];
    float lanes[kLanes];
    store(lanes, chain[0]);
    return lanes[0];
}

template <class Operation> BN_INLINE void each(const LaneLoopInput& in, const Operation& operation)
{
    for (int i = 0; i < kLaneLoopCount; i += kLanes)
        store(in.out + i, operation(load(in.a + i), load(in.b + i), i));
}

constexpr LaneLoop kLoops[] = {
    {"load_store", [](const LaneLoopInput& in) { each(in, [](real a, real, int) { return a; }); }},
    {"add", [](const LaneLoopInput& in) { each(in, [](real a, real b, int) { return a + b; }); }},
    {"multiply", [](const LaneLoopInput& in) { each(in, [](real a, real b, int) { return a * b; }); }},
    {"divide", [](const LaneLoopInput& in) { each(in, [](real a, real b, int) { return a / b; }); }},
    {"sqrt", [](const LaneLoopInput& in) { each(in, [](real a, real, int) { return sqrt(a); }); }},
    {"max", [](const LaneLoopInput& in) { each(in, [](real a, real b, int) { return max(a, b); }); }},
    {"select", [](const LaneLoopInput& in) { each(in, [](real a, real b, int) { return select(a < b + lit(0.75), a, b); }); }},
    {"floor", [](const LaneLoopInput& in) { each(in, [](real a, real, int) { return floor(a); }); }},
    {"to_int_and_back", [](const LaneLoopInput& in) { each(in, [](real a, real, int) { return to_real(to_int(a)); }); }},
    {"integer_multiply",
     [](const LaneLoopInput& in) { each(in, [](real a, real b, int) { return real_from_bits(bits_of(a) * bits_of(b)); }); }},
    {"gather", [](const LaneLoopInput& in) { each(in, [&in](real, real, int i) { return gather(in.a, load_int(in.index + i)); }); }},
    {"compress",
     [](const LaneLoopInput& in) {
         for (int i = 0; i < kLaneLoopCount; i += kLanes)
             compress_store_int(reinterpret_cast<std::int32_t*>(in.out) + i, load_int(in.index + i), load(in.a + i) < lit(1.5));
     }},
    {"texel_add",
     [](const LaneLoopInput& in) {
         for (int i = 0; i < kLaneLoopCount; i += kLanes) {
             const integer at = load_int(in.index + i);
             const real w = load(in.b + i);
             real out[4];
             texel_values(texel_add(texel_zero(), in.texels, at, at, w, w, w, w), out);
             store(in.out + i, out[0] + out[1] + out[2]);
         }
     }},
};

constexpr LimitFns kFns = {kLanes, multiply_add, kLoops, sizeof kLoops / sizeof kLoops[0]};

} // namespace

BN_DEFINE_FNS(LimitFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
