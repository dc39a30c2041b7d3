// Converts between IEEE half and float in integer arithmetic: exact on every processor, without F16C. Internal linkage
// keeps copies for different instruction sets apart in the linker.
#pragma once
#include <cstdint>

namespace burnish {

#define BN_HALF_INLINE static inline __attribute__((always_inline))

inline constexpr float kHalfMax = 65504.0f;

// Converts exactly, subnormals included. A signalling NaN becomes quiet, as with F16C.
BN_HALF_INLINE float half_to_float(std::uint16_t half)
{
    const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16;
    const std::uint32_t magnitude = half & 0x7fffu;
    std::uint32_t bits;
    if (magnitude >= 0x7c00u) { // Inf, NaN
        bits = 0x7f800000u | ((magnitude & 0x3ffu) << 13);
        if (magnitude > 0x7c00u)
            bits |= 0x00400000u;
    } else if (magnitude >= 0x0400u) {
        bits = (magnitude << 13) + (112u << 23); // change the exponent's bias from 15 to 127
    } else {
        // Subnormal: compute magnitude * 2^-24 by float arithmetic on normal numbers only.
        const float value = __builtin_bit_cast(float, (magnitude << 13) + (113u << 23)) - 6.103515625e-5f;
        bits = __builtin_bit_cast(std::uint32_t, value);
    }
    return __builtin_bit_cast(float, bits | sign);
}

// Rounds to nearest even and saturates: overflow and Inf become +-65504, so that filters never meet an Inf that no
// texel held. NaN stays NaN (quiet, without its payload).
BN_HALF_INLINE std::uint16_t float_to_half(float value)
{
    const std::uint32_t bits = __builtin_bit_cast(std::uint32_t, value);
    const std::uint32_t sign = (bits >> 16) & 0x8000u;
    const std::uint32_t magnitude = bits & 0x7fffffffu;
    std::uint32_t half;
    if (magnitude > 0x7f800000u) {
        half = 0x7e00u;
    } else if (magnitude >= 0x477fe000u) { // >= 65504
        half = 0x7bffu;
    } else if (magnitude >= 0x38800000u) { // >= 2^-14, normal halves
        half = (magnitude - (112u << 23) + 0xfffu + ((magnitude >> 13) & 1u)) >> 13;
    } else {
        // Add 1/2: the half's last place, 2^-24, meets the float's last place, and the addition rounds to nearest even.
        const float shifted = __builtin_bit_cast(float, magnitude) + 0.5f;
        half = __builtin_bit_cast(std::uint32_t, shifted) - 0x3f000000u;
    }
    return static_cast<std::uint16_t>(half | sign);
}

#undef BN_HALF_INLINE

} // namespace burnish
