// Operations that each wide instruction set builds from its own operations: the last include of lanes_avx2.h and
// lanes_avx512.h.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

BN_INLINE real& operator+=(real& a, real b)
{
    return a = a + b;
}
BN_INLINE real& operator-=(real& a, real b)
{
    return a = a - b;
}
BN_INLINE real& operator*=(real& a, real b)
{
    return a = a * b;
}
BN_INLINE real& operator/=(real& a, real b)
{
    return a = a / b;
}
BN_INLINE integer& operator+=(integer& a, integer b)
{
    return a = a + b;
}
BN_INLINE integer& operator-=(integer& a, integer b)
{
    return a = a - b;
}
BN_INLINE integer& operator*=(integer& a, integer b)
{
    return a = a * b;
}
BN_INLINE integer& operator&=(integer& a, integer b)
{
    return a = a & b;
}
BN_INLINE integer& operator|=(integer& a, integer b)
{
    return a = a | b;
}
BN_INLINE integer& operator^=(integer& a, integer b)
{
    return a = a ^ b;
}
BN_INLINE mask operator&(mask a, mask b)
{
    return both(a, b);
}
BN_INLINE mask operator|(mask a, mask b)
{
    return either(a, b);
}
BN_INLINE mask& operator&=(mask& a, mask b)
{
    return a = both(a, b);
}
BN_INLINE mask& operator|=(mask& a, mask b)
{
    return a = either(a, b);
}
BN_INLINE real clamp(real x, real lo, real hi)
{
    return min(max(x, lo), hi);
}
BN_INLINE integer clamp(integer x, integer lo, integer hi)
{
    return min(max(x, lo), hi);
}

} // namespace BN_ISA_NS
} // namespace burnish
