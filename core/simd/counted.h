// A float that counts operations; replaces float in the lane types to count a kernel's work. Counts floating-point + -
// * / and square roots. Does not count negation, comparisons, selections, conversions or integer arithmetic. Counts the
// bytes that lane loads, gathers and texel fetches request.
#pragma once
#include <cstdint>

namespace burnish {
inline namespace bn_counted {

struct LaneCounts {
    std::uint64_t operations, bytes;
};
inline thread_local constinit LaneCounts lane_counts = {}; // of the thread so far

struct Counted {
    float value;
    Counted() = default;
    explicit Counted(float x) : value(x) {}
    explicit Counted(double x) : value(static_cast<float>(x)) {}
    explicit Counted(std::int32_t x) : value(static_cast<float>(x)) {}
    explicit operator float() const { return value; }
};

BN_INLINE Counted counted(float x)
{
    ++lane_counts.operations;
    return Counted(x);
}
BN_INLINE Counted operator+(Counted a, Counted b)
{
    return counted(a.value + b.value);
}
BN_INLINE Counted operator-(Counted a, Counted b)
{
    return counted(a.value - b.value);
}
BN_INLINE Counted operator*(Counted a, Counted b)
{
    return counted(a.value * b.value);
}
BN_INLINE Counted operator/(Counted a, Counted b)
{
    return counted(a.value / b.value);
}
BN_INLINE Counted operator-(Counted a)
{
    return Counted(-a.value);
}
BN_INLINE Counted& operator+=(Counted& a, Counted b)
{
    return a = a + b;
}
BN_INLINE Counted& operator-=(Counted& a, Counted b)
{
    return a = a - b;
}
BN_INLINE Counted& operator*=(Counted& a, Counted b)
{
    return a = a * b;
}
BN_INLINE Counted& operator/=(Counted& a, Counted b)
{
    return a = a / b;
}
BN_INLINE bool operator<(Counted a, Counted b)
{
    return a.value < b.value;
}
BN_INLINE bool operator<=(Counted a, Counted b)
{
    return a.value <= b.value;
}
BN_INLINE bool operator>(Counted a, Counted b)
{
    return a.value > b.value;
}
BN_INLINE bool operator>=(Counted a, Counted b)
{
    return a.value >= b.value;
}
BN_INLINE bool operator==(Counted a, Counted b)
{
    return a.value == b.value;
}
BN_INLINE bool operator!=(Counted a, Counted b)
{
    return a.value != b.value;
}

} // namespace bn_counted
} // namespace burnish
