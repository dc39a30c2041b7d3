// A double in each lane, for the few values beyond single precision: lower half of the lanes, then upper half. Part of
// lanes_avx2.h.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

struct wide {
    __m256d lo, hi;
};
BN_INLINE wide operator+(wide a, wide b)
{
    return {_mm256_add_pd(a.lo, b.lo), _mm256_add_pd(a.hi, b.hi)};
}
BN_INLINE wide operator-(wide a, wide b)
{
    return {_mm256_sub_pd(a.lo, b.lo), _mm256_sub_pd(a.hi, b.hi)};
}
BN_INLINE wide operator*(wide a, wide b)
{
    return {_mm256_mul_pd(a.lo, b.lo), _mm256_mul_pd(a.hi, b.hi)};
}
BN_INLINE wide operator/(wide a, wide b)
{
    return {_mm256_div_pd(a.lo, b.lo), _mm256_div_pd(a.hi, b.hi)};
}
BN_INLINE wide wide_lit(double x)
{
    return {_mm256_set1_pd(x), _mm256_set1_pd(x)};
}
BN_INLINE wide to_wide(integer i)
{
    return {_mm256_cvtepi32_pd(_mm256_castsi256_si128(i.v)), _mm256_cvtepi32_pd(_mm256_extracti128_si256(i.v, 1))};
}
BN_INLINE wide to_wide(real x)
{
    return {_mm256_cvtps_pd(_mm256_castps256_ps128(x.v)), _mm256_cvtps_pd(_mm256_extractf128_ps(x.v, 1))};
}
BN_INLINE real to_real(wide x)
{
    return {_mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(x.lo)), _mm256_cvtpd_ps(x.hi), 1)};
}

} // namespace BN_ISA_NS
} // namespace burnish
