#include "shading/bake/mip/level_gains.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/scalar_math.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mipnet/albedo_fns.h"
#include "shading/bake/mipnet/net.h"

namespace burnish {
namespace {

using mipnet::kChannels;

constexpr std::size_t kPointsAtOnce = 2048, kMostPoints = 2 * kPointsAtOnce, kTexelsAPoint = 32;

// Returns random numbers in [0,1), one in each of `count` equal parts, in random order. A fixed seed gives fixed numbers.
std::vector<double> spread_numbers(std::size_t count, mipnet::Random& random)
{
    std::vector<double> all(count);
    for (std::size_t i = 0; i < count; ++i)
        all[i] = (static_cast<double>(i) + random.unit()) / static_cast<double>(count);
    for (std::size_t i = count; i > 1; --i)
        std::swap(all[i - 1], all[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
    return all;
}

// Fixed sample points, in parts of kPointsAtOnce that are stratified by themselves.
struct Points {
    std::vector<double> u, v; // place in the map
    std::vector<float> drawn; // planes kMostPoints apart, in the layout of AlbedoWork
};

Points make_points()
{
    Points p;
    p.drawn.resize(mipnet::kDrawnNumbers * kMostPoints);
    mipnet::Random random(41);
    for (std::size_t first = 0; first < kMostPoints; first += kPointsAtOnce) {
        std::vector<double> numbers[8];
        for (std::vector<double>& of : numbers)
            of = spread_numbers(kPointsAtOnce, random);
        p.u.insert(p.u.end(), numbers[0].begin(), numbers[0].end()), p.v.insert(p.v.end(), numbers[1].begin(), numbers[1].end());
        for (std::size_t i = 0; i < kPointsAtOnce; ++i) {
            const auto turned = [&](double z, double turn, double* to) {
                const double r = std::sqrt(std::max(1.0 - z * z, 0.0));
                to[0] = r * det_cos(2.0 * kPi * turn), to[1] = r * det_sin(2.0 * kPi * turn), to[2] = z;
            };
            const double out = numbers[4][i], radius = std::sqrt(out / (1.0 - out)), turn = 2.0 * kPi * numbers[5][i];
            double drawn[mipnet::kDrawnNumbers];
            turned(std::sqrt(0.01 + 0.99 * numbers[2][i]), numbers[3][i], drawn);
            drawn[3] = radius * det_cos(turn), drawn[4] = radius * det_sin(turn);
            turned(mipnet::kLeastLightZ + (1.0 - mipnet::kLeastLightZ) * numbers[6][i], numbers[7][i], drawn + 5);
            for (std::size_t k = 0; k < mipnet::kDrawnNumbers; ++k)
                p.drawn[k * kMostPoints + first + i] = static_cast<float>(drawn[k]);
        }
    }
    return p;
}

// Reflected light: the part that gains scale, and the rest
struct Given {
    double scaled, rest;
};

// Returns the light that a level reflects, summed over the points.
Given given_back(const Points& p, std::size_t count, int level, const LevelSize& size, const LevelTexels& texels,
                 const MipErrorSurface& surface, Gains rule)
{
    std::vector<float> planes(kChannels * count), scaled(count), rest(count);
    std::vector<int> x(count), y(count);
    for (std::size_t i = 0; i < count; ++i)
        x[i] = static_cast<int>(p.u[i] * size.width), y[i] = static_cast<int>(p.v[i] * size.height);
    texels(level, count, x.data(), y.data(), planes.data());
    pick<mipnet::AlbedoFns>().albedo({surface.lobe, count, surface.f0, surface.diffuse, rule == Gains::of_frames, planes.data(),
                                      p.drawn.data(), kMostPoints, scaled.data(), rest.data()});
    Given sum = {0.0, 0.0};
    for (std::size_t i = 0; i < count; ++i)
        sum.scaled += static_cast<double>(scaled[i]), sum.rest += static_cast<double>(rest[i]);
    return sum;
}

} // namespace

std::vector<float> level_gains(const std::vector<LevelSize>& sizes, const LevelTexels& texels, const MipErrorSurface& surface, Gains rule)
{
    static const Points points = make_points();
    const std::size_t area = static_cast<std::size_t>(sizes[0].width) * static_cast<std::size_t>(sizes[0].height);
    const std::size_t count = std::clamp(area / kTexelsAPoint / kPointsAtOnce * kPointsAtOnce, kPointsAtOnce, kMostPoints);
    const Given wanted = given_back(points, count, 0, sizes[0], texels, surface, rule);
    std::vector<float> gains;
    for (std::size_t l = 1; l < sizes.size(); ++l) {
        const Given given = given_back(points, count, static_cast<int>(l), sizes[l], texels, surface, rule);
        const double left = wanted.scaled + wanted.rest - given.rest, gain = given.scaled > 1e-12 ? left / given.scaled : 1.0;
        gains.push_back(std::clamp(static_cast<float>(gain), kLeastGain, kMostGain));
    }
    return gains;
}

std::vector<float> level_gains(const std::vector<mipnet::Texels>& levels, const MipErrorSurface& surface)
{
    std::vector<LevelSize> sizes;
    for (const mipnet::Texels& level : levels)
        sizes.push_back({level.width, level.height});
    const auto texels = [&](int level, std::size_t count, const int* x, const int* y, float* planes) {
        const mipnet::Texels& of = levels[static_cast<std::size_t>(level)];
        for (std::size_t c = 0; c < kChannels; ++c)
            for (std::size_t i = 0; i < count; ++i)
                *planes++ =
                    of.channel[c][static_cast<std::size_t>(y[i]) * static_cast<std::size_t>(of.width) + static_cast<std::size_t>(x[i])];
    };
    return level_gains(sizes, texels, surface, Gains::as_judged);
}

MipErrorSurface gained(const MipErrorSurface& surface, float gain)
{
    return {surface.lobe, std::min(surface.f0 * gain, 1.0f), std::min(surface.diffuse * gain, 1.0f)};
}

} // namespace burnish
