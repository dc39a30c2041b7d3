// The lane side of the harness. kernels.isa.cpp includes this file and the texts of its kernels. In namespace burnish::BN_ISA_NS it defines
//  constexpr test::Kernel kKernels[] = {
//  #include "kernels.def"
//  };
//  BN_DEFINE_KERNELS(kKernels)
// A line of kernels.def: BN_KERNEL(id, inputs, outputs, body). The body computes results r[] from arguments a[]; t is a TexelView.
#pragma once
#include "shading/lang/lang.h"
#include "tests/unit/lanes/kernels.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Loads the arguments of kLanes points from k on. Repeats the last point in unused lanes.
BN_FN void load_lanes(int n, int k, const double* in, int count, real* out)
{
    for (int i = 0; i < count; ++i) {
#ifdef BN_ORACLE
        out[i] = in[i * n + k];
#else
        float lanes[kLanes];
        for (int lane = 0; lane < kLanes; ++lane) {
            const int at = k + lane < n ? k + lane : n - 1;
            lanes[lane] = static_cast<float>(in[i * n + at]);
        }
        out[i] = load(lanes);
#endif
    }
}

BN_FN void store_lanes(int n, int k, const real* in, int count, double* out)
{
    for (int i = 0; i < count; ++i) {
#ifdef BN_ORACLE
        out[i * n + k] = in[i];
#else
        float lanes[kLanes];
        store(lanes, in[i]);
        for (int lane = 0; lane < kLanes && k + lane < n; ++lane)
            out[i * n + k + lane] = static_cast<double>(lanes[lane]);
#endif
    }
}

// Calls kernel(a, r) with arguments a and results r, kLanes points at a time.
template <int kIn, int kOut, class Body> BN_FN void run_lanes(int n, const double* in, double* out, Body body)
{
    for (int k = 0; k < n; k += kLanes) {
        real a[kIn], r[kOut];
        load_lanes(n, k, in, kIn, a);
        body(a, r);
        store_lanes(n, k, r, kOut, out);
    }
}

BN_FN real2 vec2_at(const real* a)
{
    return vec2_of(a[0], a[1]);
}
BN_FN real3 vec3_at(const real* a)
{
    return vec3_of(a[0], a[1], a[2]);
}
BN_FN void put_vec3(real3 v, real* r)
{
    r[0] = v.x, r[1] = v.y, r[2] = v.z;
}
BN_FN real number_of(mask m)
{
    return select(m, lit(1.0), lit(0.0));
}

#define BN_KERNEL(id, inputs, outputs, ...)                                                                                                \
    {#id, inputs, outputs, []([[maybe_unused]] const test::TexelView& t, int n, const double* in, double* out) {                           \
         run_lanes<inputs, outputs>(n, in, out, [&](const real* a, real* r) { __VA_ARGS__; });                                             \
     }},

#define BN_DEFINE_KERNELS(list)                                                                                                            \
    constexpr test::IsaFns kIsaFns = {BN_ISA_NAME, list, static_cast<int>(sizeof list / sizeof list[0])};                                  \
    BN_DEFINE_FNS(test::IsaFns, kIsaFns)

} // namespace BN_ISA_NS
} // namespace burnish
