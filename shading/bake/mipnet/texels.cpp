#include "shading/bake/mipnet/texels.h"

#include <algorithm>
#include <cmath>

#include "core/base/hash.h"
#include "core/math/scalar_math.h"

namespace burnish::mipnet {

Texels make_texels(int width, int height)
{
    Texels t;
    t.width = width, t.height = height;
    for (std::vector<float>& channel : t.channel)
        channel.resize(t.count());
    return t;
}

Tensor tensor_of(double alpha_along, double alpha_across, double angle)
{
    const double c = det_cos(angle), s = det_sin(angle);
    return {c * c * alpha_across + s * s * alpha_along, s * s * alpha_across + c * c * alpha_along, (alpha_across - alpha_along) * s * c};
}

Widths widths_of(const Tensor& t)
{
    const double mean = 0.5 * (t.a + t.b), half = 0.5 * (t.b - t.a), d = std::sqrt(half * half + t.c * t.c);
    const double wide = mean + d, narrow = (t.a * t.b - t.c * t.c) / wide; // not mean - d, which cancels
    return {wide, narrow, 0.5 * det_atan2(-t.c, half)};
}

void make_valid(Texels& t)
{
    const double kMostTilt = 0.98;
    for (std::size_t i = 0; i < t.count(); ++i) {
        double v[kChannels];
        bool finite = true;
        for (std::size_t c = 0; c < kChannels; ++c) {
            v[c] = static_cast<double>(t.channel[c][i]);
            finite = finite && std::isfinite(v[c]);
        }
        if (!finite)
            v[0] = v[1] = v[4] = 0.0, v[2] = v[3] = 1.0;
        const double shrink = kMostTilt / std::max(std::sqrt(v[0] * v[0] + v[1] * v[1]), kMostTilt);
        const double a = std::clamp(v[2], kLeastAlpha, 1.0), b = std::clamp(v[3], kLeastAlpha, 1.0);
        const double most = std::sqrt(std::max(std::min((1.0 - a) * (1.0 - b), (a - kLeastAlpha) * (b - kLeastAlpha)), 0.0));
        const double valid[kChannels] = {v[0] * shrink, v[1] * shrink, a, b, std::clamp(v[4], -most, most)};
        for (std::size_t c = 0; c < kChannels; ++c)
            t.channel[c][i] = static_cast<float>(valid[c]);
    }
}

Texels mirrored(const Texels& from, int symmetry)
{
    const bool exchanged = (symmetry & 4) != 0;
    Texels to = exchanged ? make_texels(from.height, from.width) : make_texels(from.width, from.height);
    const float sx = symmetry & 1 ? -1.0f : 1.0f, sy = symmetry & 2 ? -1.0f : 1.0f;
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
            int fx = symmetry & 1 ? to.width - 1 - x : x, fy = symmetry & 2 ? to.height - 1 - y : y;
            if (exchanged)
                std::swap(fx, fy);
            const std::size_t at = static_cast<std::size_t>(fy) * static_cast<std::size_t>(from.width) + static_cast<std::size_t>(fx);
            const std::size_t put = static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x);
            to.channel[0][put] = sx * from.channel[exchanged ? 1 : 0][at];
            to.channel[1][put] = sy * from.channel[exchanged ? 0 : 1][at];
            to.channel[2][put] = from.channel[exchanged ? 3 : 2][at];
            to.channel[3][put] = from.channel[exchanged ? 2 : 3][at];
            to.channel[4][put] = sx * sy * from.channel[4][at];
        }
    return to;
}

std::uint64_t source_hash(const Texels& texels)
{
    std::uint64_t least = ~std::uint64_t{0};
    for (int symmetry = 0; symmetry < 8; ++symmetry) {
        Texels t = mirrored(texels, symmetry);
        std::uint64_t hash = static_cast<std::uint64_t>(t.width) << 32 | static_cast<std::uint64_t>(t.height);
        for (std::vector<float>& channel : t.channel) {
            for (float& v : channel)
                v += 0.0f; // avoids the -0 of a mirrored 0
            hash = hash_bytes(channel.data(), channel.size() * sizeof(float), hash);
        }
        least = std::min(least, hash);
    }
    return least;
}

} // namespace burnish::mipnet
