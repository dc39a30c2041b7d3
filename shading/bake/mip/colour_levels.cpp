#include "shading/bake/mip/colour_levels.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "core/scene/texture.h"
#include "shading/bake/mip/grid.h"

namespace burnish {
namespace {

struct Tap {
    int at; // texel in the map
    double weight;
};

// Modified Bessel function, first kind, order 0.
double bessel_0(double x)
{
    double sum = 1.0, term = 1.0;
    for (int k = 1; k < 40; ++k)
        term *= x * x / (4.0 * k * k), sum += term;
    return sum;
}

// Returns the map's texels under texel i of a level, along one axis. Weights sum to 1.
std::vector<Tap> taps_of(int i, int source, int target, ColourKernel kernel, WrapMode wrap)
{
    constexpr double kRadius = 3.0, kAlpha = 4.0; // in texels of the level
    const double step = static_cast<double>(source) / target, begin = i * step, end = begin + step, centre = 0.5 * (begin + end);
    std::vector<Tap> taps;
    // Box: exact overlaps
    if (kernel == ColourKernel::box || step == 1.0) {
        for (int k = static_cast<int>(begin); k < source && k < end; ++k)
            taps.push_back({k, (std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k))) / step});
        return taps;
    }
    // Kaiser: a windowed sinc, normalised
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

struct Span {
    float least, most;
};

// Returns the range of each channel.
std::vector<Span> spans_of(const ColourRows& map, const Jobs& jobs)
{
    const std::size_t channels = static_cast<std::size_t>(map.channels), texels = static_cast<std::size_t>(map.width) * channels;
    std::vector<Span> rows(static_cast<std::size_t>(map.height) * channels);
    jobs.parallel_for(static_cast<std::size_t>(map.height), [&](std::size_t y, int) {
        std::vector<float> row(texels);
        map.row(static_cast<int>(y), row.data());
        Span* const to = rows.data() + y * channels;
        for (std::size_t c = 0; c < channels; ++c)
            to[c] = {row[c], row[c]};
        for (std::size_t i = 0; i < texels; ++i)
            to[i % channels] = {std::min(to[i % channels].least, row[i]), std::max(to[i % channels].most, row[i])};
    });
    std::vector<Span> all(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(channels));
    for (std::size_t i = 0; i < rows.size(); ++i)
        all[i % channels] = {std::min(all[i % channels].least, rows[i].least), std::max(all[i % channels].most, rows[i].most)};
    return all;
}

// Adds a row: weighted colours, then the weight, per texel.
void add_row(const ColourRows& map, int y, double share, const Image* weight, float* colours, double* sums)
{
    const std::size_t channels = static_cast<std::size_t>(map.channels), width = static_cast<std::size_t>(map.width);
    map.row(y, colours);
    for (std::size_t x = 0; x < width; ++x, sums += channels + 1) {
        const double w =
            weight
                ? static_cast<double>(weight->f32()[(static_cast<std::size_t>(y) * width + x) * static_cast<std::size_t>(weight->channels)])
                : 1.0;
        for (std::size_t c = 0; c < channels; ++c)
            sums[c] += share * (w * static_cast<double>(colours[x * channels + c]));
        sums[channels] += share * w;
    }
}

} // namespace

void each_colour_row(const ColourRows& map, const ColourOptions& options, const Jobs& jobs, const LevelRow& use)
{
    const Image* weight = options.weight;
    BN_CHECK(!weight || (weight->type == PixelType::f32 && weight->width == map.width && weight->height == map.height));
    const std::size_t channels = static_cast<std::size_t>(map.channels), held = channels + 1, width = static_cast<std::size_t>(map.width);
    const std::vector<Span> spans = spans_of(map, jobs);
    for (int l = 1; l <= levels_below(map.width, map.height); ++l) {
        const int columns = std::max(1, map.width >> l);
        const auto across = all_taps(map.width, columns, options.kernel, options.wrap_s);
        const auto down = all_taps(map.height, std::max(1, map.height >> l), options.kernel, options.wrap_t);
        jobs.parallel_for(down.size(), [&](std::size_t y, int) {
            std::vector<double> row(width * held), texel(held);
            std::vector<float> colours(width * channels), made(across.size() * channels);
            // Filter down, then across
            for (const Tap& tap : down[y])
                add_row(map, tap.at, tap.weight, weight, colours.data(), row.data());
            float* to = made.data();
            for (const std::vector<Tap>& taps : across) {
                std::fill(texel.begin(), texel.end(), 0.0);
                for (const Tap& tap : taps)
                    for (std::size_t c = 0; c < held; ++c)
                        texel[c] += tap.weight * row[static_cast<std::size_t>(tap.at) * held + c];
                // Divide by the weight, and clamp to the map's range
                const double w = std::max(texel[channels], 1e-9);
                for (std::size_t c = 0; c < channels; ++c)
                    *to++ = std::clamp(static_cast<float>(texel[c] / w), spans[c].least, spans[c].most);
            }
            use(l, columns, static_cast<int>(y), made.data());
        });
    }
}

std::vector<Image> colour_levels(const Image& linear, const ColourOptions& options)
{
    BN_CHECK(linear.type == PixelType::f32 && !linear.empty());
    const std::size_t row = static_cast<std::size_t>(linear.width) * static_cast<std::size_t>(linear.channels);
    std::vector<Image> levels = {linear};
    for (int l = 1; l <= levels_below(linear.width, linear.height); ++l)
        levels.push_back(make_image(std::max(1, linear.width >> l), std::max(1, linear.height >> l), linear.channels, PixelType::f32));
    each_colour_row({linear.width, linear.height, linear.channels,
                     [&](int y, float* to) { std::copy_n(linear.f32() + static_cast<std::size_t>(y) * row, row, to); }},
                    options, Jobs(1), [&](int l, int width, int y, const float* texels) {
                        const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(linear.channels);
                        std::copy_n(texels, count, levels[static_cast<std::size_t>(l)].f32() + static_cast<std::size_t>(y) * count);
                    });
    return levels;
}

} // namespace burnish
