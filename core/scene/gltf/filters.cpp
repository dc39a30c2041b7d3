#include "core/scene/gltf/filters.h"

#include <cmath>
#include <cstring>

namespace burnish::gltf {

namespace {

// Rounds half away from zero, like round(); |value| < 2^31.
int round_to_int(float value)
{
    return static_cast<int>(value + (value >= 0.0f ? 0.5f : -0.5f));
}

template <class T> void decode_octahedral(std::uint8_t* bytes, std::size_t count)
{
    constexpr float kMax = sizeof(T) == 1 ? 127.0f : 32767.0f;
    for (std::size_t i = 0; i < count; ++i) {
        T v[4];
        std::memcpy(v, bytes + i * sizeof(v), sizeof(v));
        const float one = v[2] > 0 ? static_cast<float>(v[2]) : 1.0f; // invalid data must not divide by zero
        float x = static_cast<float>(v[0]) / one, y = static_cast<float>(v[1]) / one;
        float z = 1.0f - std::fabs(x) - std::fabs(y);
        const float fold = z < 0.0f ? z : 0.0f; // fold the lower half over the diagonals
        x += x >= 0.0f ? fold : -fold;
        y += y >= 0.0f ? fold : -fold;
        const float length = std::sqrt(x * x + y * y + z * z);
        const float scale = length > 0.0f ? kMax / length : 0.0f;
        v[0] = static_cast<T>(round_to_int(x * scale));
        v[1] = static_cast<T>(round_to_int(y * scale));
        v[2] = static_cast<T>(round_to_int(z * scale));
        std::memcpy(bytes + i * sizeof(v), v, sizeof(v));
    }
}

} // namespace

void filter_octahedral(std::uint8_t* bytes, std::size_t count, std::size_t stride)
{
    if (stride == 4)
        decode_octahedral<std::int8_t>(bytes, count);
    else
        decode_octahedral<std::int16_t>(bytes, count);
}

void filter_quaternion(std::uint8_t* bytes, std::size_t count)
{
    constexpr float kMax = 32767.0f, kInvSqrt2 = 0.70710678f;
    for (std::size_t i = 0; i < count; ++i) {
        std::int16_t v[4], out[4];
        std::memcpy(v, bytes + i * sizeof(v), sizeof(v));
        const float one = static_cast<float>(v[3] | 3);
        const float x = static_cast<float>(v[0]) / one * kInvSqrt2;
        const float y = static_cast<float>(v[1]) / one * kInvSqrt2;
        const float z = static_cast<float>(v[2]) / one * kInvSqrt2;
        const float square = 1.0f - x * x - y * y - z * z;
        const float w = std::sqrt(square > 0.0f ? square : 0.0f);
        const float parts[4] = {w, x, y, z}; // cyclic, from the largest component on
        for (int k = 0; k < 4; ++k) {
            const float clamped = parts[k] < -1.0f ? -1.0f : parts[k] > 1.0f ? 1.0f : parts[k];
            out[((v[3] & 3) + k) & 3] = static_cast<std::int16_t>(round_to_int(clamped * kMax));
        }
        std::memcpy(bytes + i * sizeof(v), out, sizeof(out));
    }
}

void filter_exponential(std::uint8_t* bytes, std::size_t words)
{
    for (std::size_t i = 0; i < words; ++i) {
        std::uint32_t word;
        std::memcpy(&word, bytes + i * 4, 4);
        const int exponent = static_cast<std::int32_t>(word) >> 24;
        const int mantissa = static_cast<std::int32_t>(word << 8) >> 8;
        const float value = static_cast<float>(std::ldexp(static_cast<double>(mantissa), exponent)); // exact except for the last rounding
        std::memcpy(bytes + i * 4, &value, 4);
    }
}

} // namespace burnish::gltf
