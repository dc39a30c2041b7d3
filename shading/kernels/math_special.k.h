// Exponential, logarithm and inverse error function with full relative precision near zero and for large arguments.
#ifndef BN_MATH_SPECIAL_K_H
#define BN_MATH_SPECIAL_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Returns e^x, relative error at most 3e-7 for x in [-86, 88]; 0 below -86, the value at 88 above. Subtracts a multiple of
// ln 2 in two parts, the first with 12 bits (Cody and Waite 1980).
BN_FN real k_exp(real x)
{
    real clamped = min(max(x, lit(-86.0)), lit(88.0));
    integer n = round_to_int(clamped * lit(1.4426950408889634));
    real whole = to_real(n);
    real r = (clamped - whole * lit(0.693359375)) - whole * lit(-0.00021219444005469057);
    real value = k_exp2_fraction(r * lit(1.4426950408889634)) * k_power_of_two(n);
    return select(x >= lit(-86.0), value, lit(0.0));
}

// Returns e^x - 1, relative error at most 4e-7 for x in [-86, 88]. Near 0 uses the Taylor series; its remainder is below
// 1e-9 of the value.
BN_FN real k_expm1(real x)
{
    real c = min(max(x, lit(-0.35)), lit(0.35));
    real p = lit(2.48015873015873016e-5);
    p = p * c + lit(1.98412698412698413e-4);
    p = p * c + lit(0.00138888888888888889);
    p = p * c + lit(0.00833333333333333333);
    p = p * c + lit(0.04166666666666666667);
    p = p * c + lit(0.16666666666666666667);
    p = p * c + lit(0.5);
    real close = c + c * c * p;
    real distant = k_exp(x) - lit(1.0);
    return select(abs(x) < lit(0.35), close, distant);
}

// Returns ln(1 + x), relative error at most 5e-7 for x in (-1, 1e30]. x <= -1 counts as the next number above -1. For 1 + x
// in [0.7, 1.42] uses the series of 2 atanh(s), s = x / (2 + x), which never rounds 1 + x. The series' remainder is below
// 3e-9 of the value.
BN_FN real k_log1p(real x)
{
    real safe = max(x, lit(-0.99999994));
    real c = min(max(safe, lit(-0.3)), lit(0.42));
    real s = c / (lit(2.0) + c);
    real z = s * s;
    real p = lit(0.22222222222222222);
    p = p * z + lit(0.28571428571428571);
    p = p * z + lit(0.4);
    p = p * z + lit(0.66666666666666667);
    real close = s * (lit(2.0) + p * z);
    real distant = k_log2(lit(1.0) + safe) * lit(0.69314718055994531);
    return select(both(safe > lit(-0.3), safe < lit(0.42)), close, distant);
}

// Returns the inverse error function on (-1, 1), relative error at most 1e-6. Clamps |x| below 1, so |result| <= 3.9. Giles
// 2010, "Approximating the erfinv function", single precision.
BN_FN real k_erfinv(real x)
{
    real c = min(max(x, lit(-0.99999994)), lit(0.99999994));
    real w = k_log2((lit(1.0) - c) * (lit(1.0) + c)) * lit(-0.69314718055994531);
    real inner = min(w, lit(5.0)) - lit(2.5);
    real p = lit(2.81022636e-08);
    p = p * inner + lit(3.43273939e-07);
    p = p * inner + lit(-3.5233877e-06);
    p = p * inner + lit(-4.39150654e-06);
    p = p * inner + lit(0.00021858087);
    p = p * inner + lit(-0.00125372503);
    p = p * inner + lit(-0.00417768164);
    p = p * inner + lit(0.246640727);
    p = p * inner + lit(1.50140941);
    real outer = sqrt(max(w, lit(5.0))) - lit(3.0);
    real q = lit(-0.000200214257);
    q = q * outer + lit(0.000100950558);
    q = q * outer + lit(0.00134934322);
    q = q * outer + lit(-0.00367342844);
    q = q * outer + lit(0.00573950773);
    q = q * outer + lit(-0.0076224613);
    q = q * outer + lit(0.00943887047);
    q = q * outer + lit(1.00167406);
    q = q * outer + lit(2.83297682);
    return c * select(w < lit(5.0), p, q);
}

BN_KERNELS_END

#endif
