// A float that counts: what the lane types are made of where a kernel's work is counted instead of timed. Floating-point
// + - * / and square roots are operations; negation, comparisons, selections, conversions and integer arithmetic are not. Bytes are those
// that lane loads, gathers and texel fetches ask for.
#pragma once
#include <cstdint>

namespace burnish {
inline namespace bn_counted {

struct LaneCounts {
    std::uint64_t operations, bytes;
};
static LaneCounts lane_counts = {}; // of this source file

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
