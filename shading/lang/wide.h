// Doubles that all lanes share, for assembly that needs more than float precision. Provides uniform_wide, wide_of(x) for a
// float or an int, wide_min, wide_max; float(w) and int(w) convert back. A GLSL stage that defines BN_WIDE requires
// doubles; without BN_WIDE, floats replace them for devices that have none.
#ifndef BN_WIDE_H
#define BN_WIDE_H

#include "shading/lang/lang.h"

#ifdef __cplusplus
BN_KERNELS_BEGIN

using uniform_wide = double;
BN_FN double wide_of(float x)
{
    return static_cast<double>(x);
}
BN_FN double wide_of(int x)
{
    return static_cast<double>(x);
}

BN_KERNELS_END
#elif defined(BN_WIDE)
#define uniform_wide precise double
#define wide_of(x) double(x)
#else
#define uniform_wide precise float
#define wide_of(x) float(x)
#endif

BN_KERNELS_BEGIN

BN_FN uniform_wide wide_min(uniform_wide a, uniform_wide b)
{
    return a < b ? a : b;
}
BN_FN uniform_wide wide_max(uniform_wide a, uniform_wide b)
{
    return a > b ? a : b;
}

BN_KERNELS_END

#endif
