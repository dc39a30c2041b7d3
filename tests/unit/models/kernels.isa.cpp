// Every reflection model and its helper functions.
#include "tests/unit/lanes/run_lanes.h"
#include "tests/unit/models/model_fns.h"

#define BN_MODEL_TEXTS
#include "shading/models.def"
#include "shading/surface/covariance.k.h"
#include "shading/surface/energy.k.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"
#include "shading/surface/tensor.k.h"
#include "shading/techniques/filtered_is.k.h"
#include "shading/techniques/major_axis.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

struct RandomNumbers {
    real x, y, z;
    operator real2() const { return vec2_of(x, y); }
    operator real3() const { return vec3_of(x, y, z); }
};

// Stands for p in models without parameters, whose functions take none.
struct no_params {};

// Calls a model's function with p, or without p if it takes none. Returns 0 if there is no such function.
#define BN_CALL(fn, ...)                                                                                                                   \
    [](auto p, auto... rest) {                                                                                                             \
        if constexpr (requires { fn(p, rest...); })                                                                                        \
            return fn(p, rest...);                                                                                                         \
        else if constexpr (requires { fn(rest...); })                                                                                      \
            return fn(rest...);                                                                                                            \
        else                                                                                                                               \
            return lit(0.0);                                                                                                               \
    }(__VA_ARGS__)

void put_sample(bsdf_sample s, real* r)
{
    put_vec3(s.wi, r);
    r[3] = s.weight, r[4] = s.pdf, r[5] = s.o_dot_h, r[6] = number_of(s.valid);
}
void put_covariance(slope_covariance s, real* r)
{
    r[0] = s.xx, r[1] = s.yy, r[2] = s.xy;
}

void put_tensor(lobe_tensor t, real* r)
{
    r[0] = t.a, r[1] = t.b, r[2] = t.c;
}
slope_covariance covariance_at(const real* a)
{
    return {a[0], a[1], a[2]};
}
lobe_tensor tensor_at(const real* a)
{
    return {a[0], a[1], a[2]};
}
space_covariance space_at(const real* a)
{
    return {a[0], a[1], a[2], a[3], a[4], a[5]};
}

constexpr int kWo = test::kMaxParams, kWi = test::kMaxParams + 3;

constexpr test::Kernel kKernels[] = {
#include "tests/unit/models/kernels.def"
};

} // namespace

BN_DEFINE_KERNELS(kKernels)

} // namespace BN_ISA_NS
} // namespace burnish
