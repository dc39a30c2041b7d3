// A double in each lane, for the few values beyond single precision: lower half of the lanes, then upper half. Part of
// lanes_avx512.h.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

struct wide {
    __m512d lo, hi;
};
BN_INLINE wide operator+(wide a, wide b)
{
    return {_mm512_add_pd(a.lo, b.lo), _mm512_add_pd(a.hi, b.hi)};
}
BN_INLINE wide operator-(wide a, wide b)
{
    return {_mm512_sub_pd(a.lo, b.lo), _mm512_sub_pd(a.hi, b.hi)};
}
BN_INLINE wide operator*(wide a, wide b)
{
    return {_mm512_mul_pd(a.lo, b.lo), _mm512_mul_pd(a.hi, b.hi)};
}
BN_INLINE wide operator/(wide a, wide b)
{
    return {_mm512_div_pd(a.lo, b.lo), _mm512_div_pd(a.hi, b.hi)};
}
BN_INLINE wide wide_lit(double x)
{
    return {_mm512_set1_pd(x), _mm512_set1_pd(x)};
}
BN_INLINE wide to_wide(integer i)
{
    return {_mm512_cvtepi32_pd(_mm512_castsi512_si256(i.v)), _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(i.v, 1))};
}
BN_INLINE wide to_wide(real x)
{
    return {_mm512_cvtps_pd(_mm512_castps512_ps256(x.v)), _mm512_cvtps_pd(_mm512_extractf32x8_ps(x.v, 1))};
}
BN_INLINE real to_real(wide x)
{
    return {_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(x.lo)), _mm512_cvtpd_ps(x.hi), 1)};
}

} // namespace BN_ISA_NS
} // namespace burnish
