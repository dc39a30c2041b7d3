#include "apps/chart/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/hash.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

// Returns a standard normal deviate for a pixel (Box and Muller 1958).
double deviate(std::uint64_t pixel, std::uint32_t seed)
{
    const std::uint64_t key[2] = {pixel, seed}, bits = hash_bytes(key, sizeof key);
    const double u = (static_cast<double>(bits >> 32) + 0.5) * 0x1p-32, v = static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
    return std::sqrt(-2.0 * det_log(u)) * det_cos(2.0 * kPi * v);
}

} // namespace

Image with_noise(const Image& mean, const Image& variance, std::uint32_t seed, const Jobs& jobs)
{
    BN_CHECK(mean.width == variance.width && mean.height == variance.height && mean.channels == 3 && variance.channels == 3);
    Image out = mean;
    jobs.parallel_for(static_cast<std::size_t>(mean.height), [&](std::size_t y, int) {
        for (std::size_t x = 0; x < static_cast<std::size_t>(mean.width); ++x) {
            const std::size_t pixel = y * static_cast<std::size_t>(mean.width) + x;
            const double d = deviate(pixel, seed);
            for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
                out.f32()[i] =
                    static_cast<float>(static_cast<double>(mean.f32()[i]) + d * std::sqrt(static_cast<double>(variance.f32()[i])));
        }
    });
    return out;
}

double noise_flip(const Image& mean, const Image& variance, Isa isa, const Jobs& jobs)
{
    const std::size_t values = variance.bytes.size() / sizeof(float);
    if (!std::all_of(variance.f32(), variance.f32() + values, [](float v) { return std::isfinite(v); }))
        return std::numeric_limits<double>::quiet_NaN();
    FlipOptions options;
    options.isa = isa;
    return summarise_errors(flip_hdr(mean, with_noise(mean, variance, 1, jobs), options, jobs).error).mean;
}

} // namespace burnish
