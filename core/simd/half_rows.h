// Converts rows of floats to halves, with the bits of half.h. Without branches, so compilers turn the loops into vectors.
#pragma once
#include <cstddef>
#include <cstdint>

namespace burnish {

// Returns a or b by masks: compilers make branches of conditions around float arithmetic, which might trap.
static inline std::int32_t either_bits(bool condition, std::int32_t a, std::int32_t b)
{
    const std::int32_t mask = -static_cast<std::int32_t>(condition);
    return (a & mask) | (b & ~mask);
}

// Returns float_to_half()'s bits.
static inline std::int32_t half_bits(float value)
{
    const std::int32_t bits = __builtin_bit_cast(std::int32_t, value);
    const std::int32_t magnitude = bits & 0x7fffffff;
    const std::int32_t normal = (magnitude - (112 << 23) + 0xfff + ((magnitude >> 13) & 1)) >> 13;
    const float shifted = __builtin_bit_cast(float, magnitude) + 0.5f;
    const std::int32_t subnormal = __builtin_bit_cast(std::int32_t, shifted) - 0x3f000000;
    std::int32_t half = either_bits(magnitude >= 0x38800000, normal, subnormal);
    half = either_bits(magnitude >= 0x477fe000, 0x7bff, half);
    half = either_bits(magnitude > 0x7f800000, 0x7e00, half);
    return half | ((bits >> 16) & 0x8000);
}

// Returns half_to_float() of half_bits(), which has no infinity. half: 16 bits.
static inline float float_of_half_bits(std::int32_t half)
{
    const std::int32_t magnitude = half & 0x7fff;
    const std::int32_t normal = (magnitude << 13) + (112 << 23);
    const float shifted = __builtin_bit_cast(float, (magnitude << 13) + (113 << 23)) - 6.103515625e-5f;
    std::int32_t bits = either_bits(magnitude >= 0x0400, normal, __builtin_bit_cast(std::int32_t, shifted));
    bits = either_bits(magnitude > 0x7c00, 0x7fc00000, bits);
    return __builtin_bit_cast(float, bits | ((half & 0x8000) << 16));
}

// Converts n floats.
static inline void floats_to_halves(const float* from, std::size_t n, std::uint16_t* to)
{
    for (std::size_t i = 0; i < n; ++i)
        to[i] = static_cast<std::uint16_t>(half_bits(from[i]));
}

// Converts n floats, each less the float nearest to it among halves.
static inline void residuals_to_halves(const float* from, std::size_t n, std::uint16_t* to)
{
    for (std::size_t i = 0; i < n; ++i)
        to[i] = static_cast<std::uint16_t>(half_bits(from[i] - float_of_half_bits(half_bits(from[i]))));
}

} // namespace burnish
