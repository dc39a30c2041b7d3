// Numbers on a tape that is read backward, over lanes: gradients by many numbers at once.
#pragma once
#include "shading/bake/mipnet/autodiff.h"

BN_KERNELS_BEGIN
namespace mipnet_lanes {

// A tape: all numbers so far, each with its two operands and derivatives by these. Number 0 is unused.
struct tape_node {
    real d0, d1;
    int from0, from1;
};
inline constexpr int kTapeLength = 6144; // numbers in one texel's gradient: about 1500, with sixty-four texels 3500 more
struct tape {
    tape_node* nodes;
    real *values, *adjoints;
    int count;
};
struct var {
    tape* on;
    int at;
};
BN_FN real value(const var& x)
{
    return x.on->values[x.at];
}
static __attribute__((noinline, unused)) int tape_push(tape* t, real v, int from0, real d0, int from1, real d1)
{
    if (t->count >= kTapeLength)
        __builtin_trap();
    const int at = t->count++;
    t->nodes[at] = {d0, d1, from0, from1};
    t->values[at] = v;
    t->adjoints[at] = lit(0.0);
    return at;
}
BN_FN void tape_begin(tape& t)
{
    t.count = 0;
    tape_push(&t, lit(0.0), 0, lit(0.0), 0, lit(0.0));
}
BN_FN var leaf(tape& t, real v)
{
    return {&t, tape_push(&t, v, 0, lit(0.0), 0, lit(0.0))};
}
BN_FN void seed(const var& x, real adjoint)
{
    x.on->adjoints[x.at] += adjoint;
}
BN_FN real adjoint_of(const var& x)
{
    return x.on->adjoints[x.at];
}
BN_FN var chain(real v, const var& a, real da)
{
    return {a.on, tape_push(a.on, v, a.at, da, 0, lit(0.0))};
}
BN_FN var chain(real v, const var& a, real da, const var& b, real db)
{
    return {a.on, tape_push(a.on, v, a.at, da, b.at, db)};
}
// Propagates adjoints backward over the tape.
static __attribute__((noinline, unused)) void tape_reverse(tape& t)
{
    for (int i = t.count - 1; i > 0; --i) {
        const tape_node& node = t.nodes[i];
        const real adjoint = t.adjoints[i];
        t.adjoints[node.from0] += adjoint * node.d0;
        t.adjoints[node.from1] += adjoint * node.d1;
    }
}

BN_DIFFERENTIABLE(var)

} // namespace mipnet_lanes
BN_KERNELS_END
