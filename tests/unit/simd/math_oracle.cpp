// The math kernels with real = double (BN_ISA oracle): their error is that of the fits alone.
#include "tests/unit/simd/ops.h"

#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {
double exp2_fn(double a, double)
{
    return k_exp2(a);
}
double log2_fn(double a, double)
{
    return k_log2(a);
}
double pow_fn(double a, double b)
{
    return k_pow(a, b);
}
double sin_fn(double a, double)
{
    return k_sin(a);
}
double cos_fn(double a, double)
{
    return k_cos(a);
}
double atan2_fn(double a, double b)
{
    return k_atan2(a, b);
}
double acos_fn(double a, double)
{
    return k_acos(a);
}
const OracleFn kFns[] = {{"exp2", exp2_fn}, {"log2", log2_fn},   {"pow", pow_fn},  {"sin", sin_fn},
                         {"cos", cos_fn},   {"atan2", atan2_fn}, {"acos", acos_fn}};
const OracleList kList = {kFns, static_cast<int>(sizeof(kFns) / sizeof(kFns[0]))};
} // namespace

BN_DEFINE_FNS(OracleList, kList)
} // namespace BN_ISA_NS
} // namespace burnish
