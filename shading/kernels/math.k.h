// Mathematics of the kernel language: vector algebra, elementary functions, hashes. Every float version gives the same
// bits. The polynomials are minimax fits (Remez exchange in 40 digits, weighted for the error stated at each). Argument
// reductions follow Cody and Waite 1980, "Software Manual for the Elementary Functions". Stated errors are bounds for
// float; tests/unit/simd checks them against double libm.
#ifndef BN_MATH_K_H
#define BN_MATH_K_H
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

BN_FN real k_dot2(real2 a, real2 b)
{
    return a.x * b.x + a.y * b.y;
}
BN_FN real k_dot3(real3 a, real3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
BN_FN real3 k_cross(real3 a, real3 b)
{
    return vec3_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
BN_FN real k_length3(real3 a)
{
    return sqrt(k_dot3(a, a));
}
// Normalizes a vector. Zero and tiny vectors are safe: |a|^2 counts as at least 1e-30, so they keep their direction and
// stay shorter than 1.
BN_FN real2 k_normalize2(real2 a)
{
    return a * (lit(1.0) / sqrt(max(k_dot2(a, a), lit(1e-30))));
}
BN_FN real3 k_normalize3(real3 a)
{
    return a * (lit(1.0) / sqrt(max(k_dot3(a, a), lit(1e-30))));
}

// Interpolates linearly. Exact at t = 0, within rounding at t = 1.
BN_FN real k_mix(real a, real b, real t)
{
    return a + (b - a) * t;
}
BN_FN real3 k_mix3(real3 a, real3 b, real t)
{
    return a + (b - a) * t;
}
BN_FN real k_saturate(real x)
{
    return min(max(x, lit(0.0)), lit(1.0));
}

// Returns 2^n for n in [-126, 127].
BN_FN real k_power_of_two(integer n)
{
    return real_from_bits(shl(n + int_lit(127), 23));
}

// Returns 2^f for f in [-1/2, 1/2]; relative fit error 2e-9.
BN_FN real k_exp2_fraction(real f)
{
    real p = lit(0.00015353363775035465);
    p = p * f + lit(0.0013398874480771807);
    p = p * f + lit(0.0096184373506186335);
    p = p * f + lit(0.055503324709063027);
    p = p * f + lit(0.24022647913690564);
    p = p * f + lit(0.69314720285522877);
    return lit(1.0) + p * f;
}

// Returns 2^x, error at most 2 ulp for x in [-125, 127.5). Below -125, and for NaN, returns 0; from 127.5 on, the value at
// 127.5.
BN_FN real k_exp2(real x)
{
    real clamped = min(max(x, lit(-125.0)), lit(127.49999));
    integer n = round_to_int(clamped);
    real value = k_exp2_fraction(clamped - to_real(n)) * k_power_of_two(n);
    return select(x >= lit(-125.0), value, lit(0.0));
}

// log2(x) = whole + fraction, whole an integer, fraction in [-1/2, 1/2].
struct k_log2_parts {
    real whole;
    real fraction;
};

// Splits log2(x); x is clamped to [2^-126, 2^126]. m = x / 2^whole lies in [sqrt(1/2), sqrt(2)]. Then log2(m) = 2/ln2
// atanh(s), s = (m-1)/(m+1), as a polynomial in s^2 (relative fit error 3e-9).
BN_FN k_log2_parts k_log2_split(real x)
{
    real safe = min(max(x, lit(1.1754943508222875e-38)), lit(8.5070591730234616e+37));
    integer n = shr(bits_of(safe) - int_lit(0x3f3504f3), 23);
    real m = safe * k_power_of_two(-n);
    real s = (m - lit(1.0)) / (m + lit(1.0));
    real z = s * s;
    real p = lit(0.43096633853382163);
    p = p * z + lit(0.57675372260089756);
    p = p * z + lit(0.96179827887211364);
    k_log2_parts parts;
    parts.whole = to_real(n);
    parts.fraction = s * (lit(2.8853900817779268) + p * z);
    return parts;
}

// Returns the base-2 logarithm, error at most 4 ulp for x in [2^-126, 2^126]. Clamps x outside; NaN counts as 2^-126.
BN_FN real k_log2(real x)
{
    k_log2_parts parts = k_log2_split(x);
    return parts.whole + parts.fraction;
}

// Returns x^y for x > 0, relative error at most 1e-6 while |y| <= 8 and the result lies in [1e-30, 1e30]. Splits y in two
// parts, the upper with 12 bits, so that the integer part of y times x's exponent is subtracted without rounding. x <= 0
// counts as 2^-126, so 0^y is 0 (y > 1) but 0^0 = 1.
BN_FN real k_pow(real x, real y)
{
    k_log2_parts parts = k_log2_split(x);
    real y_high = real_from_bits(bits_of(y) & int_lit(-4096));
    real y_low = y - y_high;
    real coarse = min(max(y_high * parts.whole, lit(-300.0)), lit(300.0));
    integer n = round_to_int(coarse);
    real rest = (coarse - to_real(n)) + (y_low * parts.whole + y * parts.fraction);
    integer k = round_to_int(min(max(rest, lit(-300.0)), lit(300.0)));
    real value = k_exp2_fraction(min(max(rest - to_real(k), lit(-0.5)), lit(0.5)));
    integer exponent = n + k;
    value = value * k_power_of_two(min(max(exponent, int_lit(-125)), int_lit(126)));
    return select(exponent < int_lit(-125), lit(0.0), value);
}

struct k_sin_cos_pair {
    real sine;
    real cosine;
};

// Returns sine and cosine of x rad, absolute error at most 1e-7 for |x| <= 2 pi, 2e-7 up to |x| = 1000. Subtracts pi/2 in
// three parts; the first two have 11 bits. Fit errors 4e-9.
BN_FN k_sin_cos_pair k_sin_cos(real x)
{
    integer n = round_to_int(x * lit(0.63661977236758134));
    real quarter = to_real(n);
    real r = ((x - quarter * lit(1.5703125)) - quarter * lit(0.0004837512969970703125)) - quarter * lit(7.5497899548918821692e-8);
    real z = r * r;
    real ps = lit(-0.00019517298980896842);
    ps = ps * z + lit(0.0083321781463035934);
    ps = ps * z + lit(-0.16666654943708026);
    real s = r + r * z * ps;
    real pc = lit(2.4438451600030313e-5);
    pc = pc * z + lit(-0.0013887367515908313);
    pc = pc * z + lit(0.041666646866450277);
    real c = lit(1.0) - lit(0.5) * z + z * z * pc;
    mask odd = (n & int_lit(1)) != int_lit(0);
    mask sine_negative = (n & int_lit(2)) != int_lit(0);
    mask cosine_negative = ((n + int_lit(1)) & int_lit(2)) != int_lit(0);
    real swapped_s = select(odd, c, s);
    real swapped_c = select(odd, s, c);
    k_sin_cos_pair result;
    result.sine = select(sine_negative, -swapped_s, swapped_s);
    result.cosine = select(cosine_negative, -swapped_c, swapped_c);
    return result;
}
BN_FN real k_sin(real x)
{
    k_sin_cos_pair pair = k_sin_cos(x);
    return pair.sine;
}
BN_FN real k_cos(real x)
{
    k_sin_cos_pair pair = k_sin_cos(x);
    return pair.cosine;
}

// Returns the angle of (x, y) in [0, pi] rad for y >= 0, like k_atan2().
BN_FN real k_atan2_above(real y, real x)
{
    real ax = abs(x);
    real larger = max(max(ax, y), lit(1e-30));
    real smaller = min(ax, y);
    // Above 22.5 degrees turn by 45: atan(q) = pi/4 + atan((q - 1) / (q + 1)).
    real turned_limit = lit(0.41421356237309505) * larger;
    mask turned = smaller > turned_limit;
    real t = select(turned, smaller - larger, smaller) / select(turned, smaller + larger, larger);
    real z = t * t;
    real p = lit(0.079025999217853709);
    p = p * z + lit(-0.13824454415681935);
    p = p * z + lit(0.19971879383034761);
    p = p * z + lit(-0.33332756671804893);
    real angle = t + t * z * p;
    angle = select(turned, lit(0.78539816339744831) + angle, angle);
    angle = select(y > ax, lit(1.5707963267948966) - angle, angle);
    return select(x < lit(0.0), lit(3.1415926535897932) - angle, angle);
}

// Returns the angle of (x, y) in [-pi, pi] rad, error at most 3e-7, for max(|x|, |y|) >= 1e-30; 0 at the origin. Ignores
// the sign of zero: y = -0 counts as 0.
BN_FN real k_atan2(real y, real x)
{
    real angle = k_atan2_above(abs(y), x);
    return select(y < lit(0.0), -angle, angle);
}

// Returns the arc cosine in [0, pi] rad, error at most 3e-7. Clamps x to [-1, 1]. Beyond 1/2, acos(x) = 2 asin(sqrt((1 - x)
// / 2)).
BN_FN real k_acos(real x)
{
    real a = min(abs(x), lit(1.0));
    mask steep = a > lit(0.5);
    real steep_z = lit(0.5) * (lit(1.0) - a);
    real z = select(steep, steep_z, a * a);
    real s = select(steep, sqrt(steep_z), a);
    real p = lit(0.043763032432731088);
    p = p * z + lit(0.023142290287740341);
    p = p * z + lit(0.04570778615960923);
    p = p * z + lit(0.07493077194723087);
    p = p * z + lit(0.16666821529362399);
    real arc_sine = s + s * z * p;
    real positive = select(steep, lit(2.0) * arc_sine, lit(1.5707963267948966) - arc_sine);
    return select(x < lit(0.0), lit(3.1415926535897932) - positive, positive);
}

// Hashes 32 bits, bijectively: xorshift and multiply, constants from Wellons 2018, "Prospecting for Hash Functions"
// (lowbias32).
BN_FN integer k_hash_u32(integer i)
{
    integer h = i ^ shr_logical(i, 16);
    h = h * int_lit(0x7feb352d);
    h = h ^ shr_logical(h, 15);
    h = h * int_lit(-2073254261); // 0x846ca68b
    return h ^ shr_logical(h, 16);
}
// Returns the upper 24 bits of i as a number in [0, 1).
BN_FN real k_unit_from_bits(integer i)
{
    return to_real(shr_logical(i, 8)) * lit(5.9604644775390625e-8);
}
BN_FN integer k_reverse_bits(integer i)
{
    integer r = shl(i, 16) | shr_logical(i, 16);
    r = shl(r & int_lit(0x00ff00ff), 8) | (shr_logical(r, 8) & int_lit(0x00ff00ff));
    r = shl(r & int_lit(0x0f0f0f0f), 4) | (shr_logical(r, 4) & int_lit(0x0f0f0f0f));
    r = shl(r & int_lit(0x33333333), 2) | (shr_logical(r, 2) & int_lit(0x33333333));
    return shl(r & int_lit(0x55555555), 1) | (shr_logical(r, 1) & int_lit(0x55555555));
}
// Returns the radical inverse of i in base 2 (van der Corput), in [0, 1), to 24 bits.
BN_FN real k_radical_inverse2(integer i)
{
    return k_unit_from_bits(k_reverse_bits(i));
}

BN_KERNELS_END
#endif
