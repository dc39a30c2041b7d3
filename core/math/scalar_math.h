// Transcendental functions in double with equal bits on every machine. They use only + - * / sqrt and exact scaling,
// where IEEE 754 fixes every bit. The Taylor series cut off less than half a unit in the last place; their coefficients
// come from the definition. Relative error: a few 1e-16. For tables and geometry made once, not for inner loops.
#pragma once
#include <cmath>

namespace burnish {

inline constexpr double kPi = 3.14159265358979323846;

namespace scalar_math_detail {

// pi/2 in three parts. The first two have 33 bits, so that k * part is exact for |k| < 2^20.
inline constexpr double kHalfPiHigh = 0x1.921fb544p+0;
inline constexpr double kHalfPiMid = 0x1.0b4611a6p-34;
inline constexpr double kHalfPiLow = 0x1.3198a2e037073p-69;
// ln 2 in two parts; the first has 32 bits.
inline constexpr double kLn2High = 0x1.62e42feep-1;
inline constexpr double kLn2Low = 0x1.a39ef35793c76p-33;

// Returns sin(x + rest) for x in [-pi/4, pi/4] and a rest below half a unit in x's last place.
inline double sin_core(double x, double rest)
{
    const double x2 = x * x;
    double s = 0.0;
    for (int k = 19; k >= 3; k -= 2)
        s = (1.0 - s) * x2 / static_cast<double>(k * (k - 1));
    return x - (x * s - rest);
}

inline double cos_core(double x, double rest)
{
    const double x2 = x * x;
    double s = 0.0;
    for (int k = 20; k >= 4; k -= 2)
        s = (1.0 - s) * x2 / static_cast<double>(k * (k - 1));
    // cos x = 1 - x^2/2 (1 - s). The last line adds back the rounding error of 1 - half.
    const double half = 0.5 * x2;
    const double w = 1.0 - half;
    return w + ((1.0 - w) - half + (half * s - x * rest));
}

// Quadrant and remainder x + rest of an angle in radians, |angle| < 10^6.
struct Reduced {
    int quadrant;
    double x, rest;
};
inline Reduced reduce(double x)
{
    const double k = std::floor(x * (2.0 / kPi) + 0.5);
    const double a = x - k * kHalfPiHigh;
    const double b = a - k * kHalfPiMid;
    const double low = k * kHalfPiLow + (k * kHalfPiMid - (a - b));
    const double y = b - low;
    const double q = k - 4.0 * std::floor(k * 0.25);
    return {static_cast<int>(q), y, (b - y) - low};
}

// Returns atan(x) for 0 <= x <= 2 - sqrt(3), where the series converges fast.
inline double atan_core(double x)
{
    const double x2 = x * x;
    double s = 0.0;
    for (int k = 29; k >= 3; k -= 2)
        s = x2 * (1.0 / static_cast<double>(k) - s);
    return x - x * s;
}

} // namespace scalar_math_detail

// Returns the sine of x radians, |x| < 10^6.
inline double det_sin(double x)
{
    const scalar_math_detail::Reduced r = scalar_math_detail::reduce(x);
    const double v = (r.quadrant & 1) ? scalar_math_detail::cos_core(r.x, r.rest) : scalar_math_detail::sin_core(r.x, r.rest);
    return (r.quadrant & 2) ? -v : v;
}

inline double det_cos(double x)
{
    const scalar_math_detail::Reduced r = scalar_math_detail::reduce(x);
    const double v = (r.quadrant & 1) ? scalar_math_detail::sin_core(r.x, r.rest) : scalar_math_detail::cos_core(r.x, r.rest);
    return (r.quadrant == 1 || r.quadrant == 2) ? -v : v;
}

// Returns e^x: 0 for x <= -745, infinity for x > 709.8.
inline double det_exp(double x)
{
    if (!(x > -745.0))
        return x == x ? 0.0 : x;
    if (x > 709.8)
        return HUGE_VAL;
    const double k = std::floor(x * 1.4426950408889634 + 0.5);
    const double high = x - k * scalar_math_detail::kLn2High;
    const double low = k * scalar_math_detail::kLn2Low;
    const double r = high - low;
    double s = 0.0;
    for (int n = 15; n >= 2; --n)
        s = (1.0 + s) * r / static_cast<double>(n);
    const double e = 1.0 + (r + (r * s + ((high - r) - low)));
    return std::ldexp(e, static_cast<int>(k));
}

// Returns the natural logarithm of a finite x > 0; -infinity for x = 0.
inline double det_log(double x)
{
    if (x == 0.0)
        return -HUGE_VAL;
    int exponent = 0;
    double m = std::frexp(x, &exponent);
    if (m < 0.70710678118654752) {
        m *= 2.0;
        --exponent;
    }
    // log m = 2 artanh(s), s = (m - 1) / (m + 1). The form f - (f^2/2 - s (f^2/2 + R)) keeps the digits of f = m - 1.
    const double f = m - 1.0;
    const double s = f / (2.0 + f);
    const double s2 = s * s;
    double r = 0.0;
    for (int k = 23; k >= 3; k -= 2)
        r = s2 * (2.0 / static_cast<double>(k) + r);
    const double half = 0.5 * f * f;
    const double e = static_cast<double>(exponent);
    const double tail = s * (half + r) + e * scalar_math_detail::kLn2Low;
    return e * scalar_math_detail::kLn2High - ((half - tail) - f);
}

// Returns base^y for base >= 0. The relative error is about 1e-16 |y log(base)|.
inline double det_pow(double base, double y)
{
    if (y == 0.0)
        return 1.0;
    if (base == 0.0)
        return y > 0.0 ? 0.0 : HUGE_VAL;
    return det_exp(y * det_log(base));
}

inline double det_atan(double x)
{
    const double a = std::fabs(x);
    double v = 0.0;
    const double t = a > 1.0 ? 1.0 / a : a;
    if (t > 0.26794919243112270647) { // 2 - sqrt(3): rotate by pi/6
        const double root3 = 1.73205080756887729353;
        v = kPi / 6.0 + (t * root3 < 1.0 ? -scalar_math_detail::atan_core((1.0 - t * root3) / (root3 + t))
                                         : scalar_math_detail::atan_core((t * root3 - 1.0) / (root3 + t)));
    } else {
        v = scalar_math_detail::atan_core(t);
    }
    if (a > 1.0)
        v = 0.5 * kPi - v;
    return x < 0.0 ? -v : v;
}

// Returns the angle of (x, y) in [-pi, pi]; 0 for (0, 0).
inline double det_atan2(double y, double x)
{
    if (x == 0.0)
        return y > 0.0 ? 0.5 * kPi : y < 0.0 ? -0.5 * kPi : 0.0;
    const double a = det_atan(y / x);
    return x > 0.0 ? a : y < 0.0 ? a - kPi : a + kPi;
}

// Returns the arc cosine in [0, pi]. Clamps x to [-1, 1].
inline double det_acos(double x)
{
    const double c = x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x;
    return det_atan2(std::sqrt((1.0 - c) * (1.0 + c)), c);
}

inline double det_asin(double x)
{
    const double c = x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x;
    return det_atan2(c, std::sqrt((1.0 - c) * (1.0 + c)));
}

} // namespace burnish
