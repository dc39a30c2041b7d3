#include "shading/bake/mip/colour_levels.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "core/scene/texture.h"
#include "shading/bake/mip/texture.h"

namespace burnish {
namespace {

struct Tap {
    int at; // of the map
    double weight;
};

// Modified Bessel function of the first kind, of order 0.
double bessel_0(double x)
{
    double sum = 1.0, term = 1.0;
    for (int k = 1; k < 40; ++k)
        term *= x * x / (4.0 * k * k), sum += term;
    return sum;
}

// Texels of the map below texel i of a level along an axis, with weights that sum to 1.
std::vector<Tap> taps_of(int i, int source, int target, ColourKernel kernel, WrapMode wrap)
{
    constexpr double kRadius = 3.0, kAlpha = 4.0; // in texels of the level
    const double step = static_cast<double>(source) / target, begin = i * step, end = begin + step, centre = 0.5 * (begin + end);
    std::vector<Tap> taps;
    if (kernel == ColourKernel::box || step == 1.0) {
        for (int k = static_cast<int>(begin); k < source && k < end; ++k)
            taps.push_back({k, (std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k))) / step});
        return taps;
    }
    double sum = 0.0;
    for (int k = static_cast<int>(std::floor(centre - kRadius * step)); k < centre + kRadius * step; ++k) {
        const double t = (k + 0.5 - centre) / step, share = t / kRadius;
        if (std::abs(share) >= 1.0)
            continue;
        const double sinc = std::abs(t) < 1e-9 ? 1.0 : det_sin(kPi * t) / (kPi * t);
        taps.push_back({wrapped_at(k, source, wrap), sinc * bessel_0(kAlpha * std::sqrt(1.0 - share * share)) / bessel_0(kAlpha)});
        sum += taps.back().weight;
    }
    for (Tap& tap : taps)
        tap.weight /= sum;
    return taps;
}

std::vector<std::vector<Tap>> all_taps(int source, int target, ColourKernel kernel, WrapMode wrap)
{
    std::vector<std::vector<Tap>> all;
    for (int i = 0; i < target; ++i)
        all.push_back(taps_of(i, source, target, kernel, wrap));
    return all;
}

// sums: channels a texel, of the map.
std::vector<double> resampled(const std::vector<double>& sums, std::size_t channels, int width, const std::vector<std::vector<Tap>>& across,
                              const std::vector<std::vector<Tap>>& down)
{
    std::vector<double> to(across.size() * down.size() * channels), row(static_cast<std::size_t>(width) * channels);
    for (std::size_t y = 0; y < down.size(); ++y) {
        std::fill(row.begin(), row.end(), 0.0);
        for (const Tap& tap : down[y])
            for (std::size_t i = 0; i < row.size(); ++i)
                row[i] += tap.weight * sums[static_cast<std::size_t>(tap.at) * row.size() + i];
        for (std::size_t x = 0; x < across.size(); ++x)
            for (const Tap& tap : across[x])
                for (std::size_t c = 0; c < channels; ++c)
                    to[(y * across.size() + x) * channels + c] += tap.weight * row[static_cast<std::size_t>(tap.at) * channels + c];
    }
    return to;
}

} // namespace

std::vector<Image> colour_levels(const Image& linear, const ColourOptions& options)
{
    BN_CHECK(linear.type == PixelType::f32 && !linear.empty());
    const Image* weight = options.weight;
    BN_CHECK(!weight || (weight->type == PixelType::f32 && weight->width == linear.width && weight->height == linear.height));
    // Colours times weights, then the weights themselves.
    const std::size_t channels = static_cast<std::size_t>(linear.channels), held = channels + 1;
    const std::size_t count = static_cast<std::size_t>(linear.width) * static_cast<std::size_t>(linear.height);
    std::vector<double> sums(count * held);
    std::vector<float> least(channels), most(channels);
    for (std::size_t c = 0; c < channels; ++c)
        least[c] = most[c] = linear.f32()[c];
    for (std::size_t i = 0; i < count; ++i) {
        const double w = weight ? static_cast<double>(weight->f32()[i * static_cast<std::size_t>(weight->channels)]) : 1.0;
        for (std::size_t c = 0; c < channels; ++c) {
            const float value = linear.f32()[i * channels + c];
            least[c] = std::min(least[c], value), most[c] = std::max(most[c], value);
            sums[i * held + c] = w * static_cast<double>(value);
        }
        sums[i * held + channels] = w;
    }
    std::vector<Image> levels = {linear};
    const int side = std::max(linear.width, linear.height);
    for (int l = 1; l < kMaxTextureLevels && (side >> l) > 0; ++l) {
        Image level = make_image(std::max(1, linear.width >> l), std::max(1, linear.height >> l), linear.channels, PixelType::f32);
        const std::vector<double> to =
            resampled(sums, held, linear.width, all_taps(linear.width, level.width, options.kernel, options.wrap_s),
                      all_taps(linear.height, level.height, options.kernel, options.wrap_t));
        for (std::size_t i = 0; i < to.size() / held; ++i)
            for (std::size_t c = 0; c < channels; ++c) {
                const double w = std::max(to[i * held + channels], 1e-9);
                level.f32()[i * channels + c] = std::clamp(static_cast<float>(to[i * held + c] / w), least[c], most[c]);
            }
        levels.push_back(std::move(level));
    }
    return levels;
}

} // namespace burnish
