#include "tests/unit/models/model_fns.h"

#define BN_MODEL_TEXTS
#include "shading/models.def"
#include "shading/surface/covariance.k.h"
#include "shading/surface/energy.k.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"
#include "shading/techniques/filtered_is.k.h"
#include "shading/techniques/major_axis.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

// Arguments of the kLanes points from k on; the last point fills up.
void load_lanes(int n, int k, const double* in, int count, real* out)
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

void store_lanes(int n, int k, const real* in, int count, double* out)
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

// kernel(a, r): results r of arguments a, lanes at a time.
template <int kIn, int kOut, class Kernel> void run_lanes(int n, const double* in, double* out, Kernel kernel)
{
    for (int k = 0; k < n; k += kLanes) {
        real a[kIn], r[kOut];
        load_lanes(n, k, in, kIn, a);
        kernel(a, r);
        store_lanes(n, k, r, kOut, out);
    }
}

real3 vec3_at(const real* a)
{
    return vec3_of(a[0], a[1], a[2]);
}

struct RandomNumbers {
    real x, y, z;
    operator real2() const { return vec2_of(x, y); }
    operator real3() const { return vec3_of(x, y, z); }
};

real number_of(mask m)
{
    return select(m, lit(1.0), lit(0.0));
}

// p of models without parameters, whose functions have none.
struct no_params {};

// A model's function with p, without p where it takes none, or 0 where there is no such function.
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
    r[0] = s.wi.x, r[1] = s.wi.y, r[2] = s.wi.z;
    r[3] = s.weight, r[4] = s.pdf, r[5] = s.o_dot_h, r[6] = number_of(s.valid);
}

constexpr int kWo = test::kMaxParams, kWi = test::kMaxParams + 3;

// a is unused where a model has no parameters.
#define BN_MODEL(id, summary, params, laws, settings)                                                                                      \
    void run_##id##_eval(int n, const double* in, double* out)                                                                             \
    {                                                                                                                                      \
        run_lanes<test::kModelInputs, 1>(                                                                                                  \
            n, in, out, [](const real* a, real* r) { r[0] = BN_CALL(id##_eval, params, vec3_at(a + kWo), vec3_at(a + kWi)); });            \
    }                                                                                                                                      \
    void run_##id##_pdf(int n, const double* in, double* out)                                                                              \
    {                                                                                                                                      \
        run_lanes<test::kModelInputs, 1>(                                                                                                  \
            n, in, out, [](const real* a, real* r) { r[0] = BN_CALL(id##_pdf, params, vec3_at(a + kWo), vec3_at(a + kWi)); });             \
    }                                                                                                                                      \
    void run_##id##_half_pdf(int n, const double* in, double* out)                                                                         \
    {                                                                                                                                      \
        run_lanes<test::kModelInputs, 1>(                                                                                                  \
            n, in, out, [](const real* a, real* r) { r[0] = BN_CALL(id##_half_pdf, params, vec3_at(a + kWo), vec3_at(a + kWi)); });        \
    }                                                                                                                                      \
    void run_##id##_sample(int n, const double* in, double* out)                                                                           \
    {                                                                                                                                      \
        run_lanes<test::kModelInputs, test::kSampleOutputs>(n, in, out, [](const real* a, real* r) {                                       \
            put_sample(BN_CALL(id##_sample, params, vec3_at(a + kWo), RandomNumbers{a[kWi], a[kWi + 1], a[kWi + 2]}), r);                  \
        });                                                                                                                                \
    }
#include "shading/models.def"

#define BN_MODEL(id, summary, params, laws, settings) {#id, run_##id##_eval, run_##id##_pdf, run_##id##_half_pdf, run_##id##_sample},
constexpr test::ModelFns kModels[] = {
#include "shading/models.def"
};

void put_covariance(slope_covariance s, real* r)
{
    r[0] = s.xx, r[1] = s.yy, r[2] = s.xy;
}
void put_vec3(real3 v, real* r)
{
    r[0] = v.x, r[1] = v.y, r[2] = v.z;
}

#define BN_TEST_FN(id, inputs, outputs, body)                                                                                              \
    void run_##id(int n, const double* in, double* out)                                                                                    \
    {                                                                                                                                      \
        run_lanes<inputs, outputs>(n, in, out, [](const real* a, real* r) { body; });                                                      \
    }
#include "tests/unit/models/other_list.def"
#undef BN_TEST_FN

#define BN_TEST_FN(id, inputs, outputs, body) {#id, inputs, outputs, run_##id},
constexpr test::OtherFn kOthers[] = {
#include "tests/unit/models/other_list.def"
};
#undef BN_TEST_FN

constexpr test::IsaFns kFns = {BN_ISA_NAME, kModels, static_cast<int>(sizeof kModels / sizeof kModels[0]), kOthers,
                               static_cast<int>(sizeof kOthers / sizeof kOthers[0])};

} // namespace

BN_DEFINE_FNS(test::IsaFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
