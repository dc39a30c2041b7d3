#include "core/simd/half.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "core/simd/cpu.h"
#include "core/simd/half_rows.h"

namespace burnish {
namespace {

// Converts by the processor, one number at a time. Uses assembly, since this file is compiled without F16C.
float hardware_to_float(std::uint16_t half)
{
    float value;
    __asm__("vmovd %1, %%xmm0\n\tvcvtph2ps %%xmm0, %%xmm0\n\tvmovss %%xmm0, %0"
            : "=m"(value)
            : "r"(static_cast<std::uint32_t>(half))
            : "xmm0");
    return value;
}
std::uint16_t hardware_to_half(float value)
{
    std::uint32_t half;
    __asm__("vmovss %1, %%xmm0\n\tvcvtps2ph $0, %%xmm0, %%xmm0\n\tvmovd %%xmm0, %0" : "=r"(half) : "m"(value) : "xmm0");
    return static_cast<std::uint16_t>(half);
}

TEST(half, converts_to_the_float_of_its_definition)
{
    for (std::uint32_t h = 0; h < 0x10000u; ++h) {
        const int exponent = static_cast<int>(h >> 10 & 31u), fraction = static_cast<int>(h & 1023u);
        const float value = half_to_float(static_cast<std::uint16_t>(h));
        if (exponent == 31) {
            EXPECT_EQ(std::isnan(value), fraction != 0);
            EXPECT_EQ(std::isinf(value), fraction == 0);
        } else {
            const float magnitude = exponent ? std::ldexp(1024.0f + static_cast<float>(fraction), exponent - 25)
                                             : std::ldexp(static_cast<float>(fraction), -24);
            ASSERT_EQ(value, h & 0x8000u ? -magnitude : magnitude) << h;
        }
        EXPECT_EQ(std::signbit(value), (h & 0x8000u) != 0);
    }
}

TEST(half, round_trips_every_finite_half)
{
    for (std::uint32_t h = 0; h < 0x10000u; ++h)
        if ((h & 0x7c00u) != 0x7c00u) {
            ASSERT_EQ(float_to_half(half_to_float(static_cast<std::uint16_t>(h))), h);
        }
}

TEST(half, saturates_instead_of_overflowing)
{
    EXPECT_EQ(float_to_half(65504.0f), 0x7bff);
    EXPECT_EQ(float_to_half(65519.99f), 0x7bff);
    EXPECT_EQ(float_to_half(65520.0f), 0x7bff);
    EXPECT_EQ(float_to_half(-1e30f), 0xfbff);
    EXPECT_EQ(float_to_half(INFINITY), 0x7bff);
    EXPECT_EQ(float_to_half(-INFINITY), 0xfbff);
    EXPECT_EQ(float_to_half(NAN) & 0x7fff, 0x7e00);
}

TEST(half, rows_have_the_bits_of_single_numbers)
{
    std::vector<float> numbers = {0.0f, -0.0f, 65504.0f, 65519.99f, 65520.0f, INFINITY, -INFINITY, NAN, -NAN, 5.9604645e-8f, 2.9802322e-8f};
    for (std::uint32_t h = 0; h < 0x10000u; ++h) { // each half, and the floats beside it and half way to the next
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(half_to_float(static_cast<std::uint16_t>(h)));
        for (const std::uint32_t more : {0u, 1u, 0xfffu, 0x1000u, 0x1001u, 0xffffffffu})
            numbers.push_back(std::bit_cast<float>(bits + more));
    }
    std::mt19937 random(17);
    for (int i = 0; i < 1 << 20; ++i)
        numbers.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{13}, numbers.size()}) {
        std::vector<std::uint16_t> halves(n + 1, 0xabcd);
        floats_to_halves(numbers.data(), n, halves.data());
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_EQ(halves[i], float_to_half(numbers[i])) << std::bit_cast<std::uint32_t>(numbers[i]);
        EXPECT_EQ(halves[n], 0xabcd);
        residuals_to_halves(numbers.data(), n, halves.data());
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_EQ(halves[i], float_to_half(numbers[i] - half_to_float(float_to_half(numbers[i]))))
                << std::bit_cast<std::uint32_t>(numbers[i]);
        EXPECT_EQ(halves[n], 0xabcd);
    }
}

TEST(half, equals_the_processors_conversion)
{
    if (!cpu_has_avx2())
        GTEST_SKIP() << "this processor has no F16C";
    for (std::uint32_t h = 0; h < 0x10000u; ++h) {
        const std::uint16_t half = static_cast<std::uint16_t>(h);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(half_to_float(half)), std::bit_cast<std::uint32_t>(hardware_to_float(half))) << h;
    }
    std::mt19937 random(3);
    for (int k = 0; k < 2000000; ++k) {
        // Exponents around the range of halves cover rounding at every exponent, ties and subnormals.
        const std::uint32_t exponent = 100 + static_cast<std::uint32_t>(random()) % 44;
        std::uint32_t mantissa = static_cast<std::uint32_t>(random()) & 0x7fffffu;
        if (k % 3 == 0)
            mantissa = (mantissa & ~0x1fffu) | 0x1000u; // a tie
        const std::uint32_t sign = k & 1 ? 0x80000000u : 0u;
        const float value = std::bit_cast<float>(sign | exponent << 23 | mantissa);
        std::uint16_t want = hardware_to_half(value);
        if ((want & 0x7fffu) == 0x7c00u)
            want = static_cast<std::uint16_t>(want - 1u); // infinity saturates
        ASSERT_EQ(float_to_half(value), want) << value;
    }
}

} // namespace
} // namespace burnish
