#include "core/image/metrics/pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/check.h"
#include "core/image/colour.h"
#include "core/image/io/stored_row.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr int kInset = 2; // pixels

using Plane = std::vector<double>;

struct Grid {
    std::size_t width, height;
    const Jobs& jobs;

    std::size_t size() const { return width * height; }
    template <class Body> void each_row(const Body& body) const
    {
        jobs.parallel_for(height, [&](std::size_t y, int) { body(y); });
    }
};

// Returns luminance, negative where a pixel is not covered whole.
Plane luminance_of(const Image& image, const Grid& grid)
{
    Plane out(grid.size());
    const std::size_t channels = static_cast<std::size_t>(image.channels);
    const bool alpha = image.channels == 2 || image.channels == 4, encoded = image.type != PixelType::f32;
    grid.each_row([&](std::size_t y) {
        std::vector<float> row;
        read_stored_row(image, static_cast<int>(y), row);
        for (std::size_t x = 0; x < grid.width; ++x) {
            const float* const p = row.data() + x * channels;
            const auto linear = [&](std::size_t c) { return static_cast<double>(encoded ? srgb_to_linear(p[c]) : p[c]); };
            const double light = channels >= 3 ? 0.2126 * linear(0) + 0.7152 * linear(1) + 0.0722 * linear(2) : linear(0);
            out[y * grid.width + x] = alpha && p[channels - 1] < 1.0f ? -1.0 : light;
        }
    });
    return out;
}

// Returns 1 inside surfaces, else 0.
Plane inside_of(const std::vector<const Plane*>& luminances, const Grid& grid)
{
    Plane lit(grid.size()), inside(grid.size());
    grid.each_row([&](std::size_t y) {
        for (std::size_t i = y * grid.width; i < (y + 1) * grid.width; ++i)
            lit[i] = std::all_of(luminances.begin(), luminances.end(), [&](const Plane* l) { return (*l)[i] > 0.0; }) ? 1.0 : 0.0;
    });
    if (grid.width <= 2 * kInset || grid.height <= 2 * kInset)
        return inside;
    grid.each_row([&](std::size_t y) {
        if (y < kInset || y + kInset >= grid.height)
            return;
        for (std::size_t x = kInset; x + kInset < grid.width; ++x) {
            double all = 1.0;
            for (std::size_t v = y - kInset; v <= y + kInset; ++v)
                for (std::size_t u = x - kInset; u <= x + kInset; ++u)
                    all = std::min(all, lit[v * grid.width + u]);
            inside[y * grid.width + x] = all;
        }
    });
    return inside;
}

// Returns ln(test) - ln(reference) inside surfaces, else 0.
Plane error_of(const Plane& reference, const Plane& test, const Plane& inside, double least, const Grid& grid)
{
    Plane out(grid.size());
    grid.each_row([&](std::size_t y) {
        for (std::size_t i = y * grid.width; i < (y + 1) * grid.width; ++i)
            out[i] = inside[i] > 0.0 ? det_log((test[i] + least) / (reference[i] + least)) : 0.0;
    });
    return out;
}

// Returns the plane blurred by a Gaussian along x and y. Pixels outside the picture are 0.
Plane blurred(const Plane& plane, const Grid& grid)
{
    constexpr int kRadius = static_cast<int>(3.0 * kPatternSigma);
    std::array<double, 2 * kRadius + 1> weights;
    for (int k = -kRadius; k <= kRadius; ++k)
        weights[static_cast<std::size_t>(k + kRadius)] = det_exp(-0.5 * k * k / (kPatternSigma * kPatternSigma));
    const int width = static_cast<int>(grid.width), height = static_cast<int>(grid.height);
    const auto pass = [&](const Plane& from, bool along_y) {
        Plane to(grid.size());
        grid.each_row([&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < width; ++x) {
                const int at = along_y ? y : x, end = along_y ? height : width;
                double sum = 0.0;
                for (int k = std::max(-kRadius, -at); k <= std::min(kRadius, end - 1 - at); ++k) {
                    const int u = along_y ? x : x + k, v = along_y ? y + k : y;
                    sum += weights[static_cast<std::size_t>(k + kRadius)] *
                           from[static_cast<std::size_t>(v) * grid.width + static_cast<std::size_t>(u)];
                }
                to[row * grid.width + static_cast<std::size_t>(x)] = sum;
            }
        });
        return to;
    };
    return pass(pass(plane, false), true);
}

// Subtracts from the error inside surfaces its mean around, by a Gaussian that looks at such pixels alone.
Plane high_passed(const Plane& error, const Plane& inside, const Plane& weight, const Grid& grid)
{
    Plane out = blurred(error, grid);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = inside[i] > 0.0 ? error[i] - out[i] / weight[i] : 0.0;
    return out;
}

// Returns the variance of ln(reference) by the reference's noise, inside surfaces, else 0. variance: the means', with the reference's
// channels.
Plane noise_of(const Image& variance, const Plane& reference, const Plane& inside, double least, const Grid& grid)
{
    constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};
    const std::size_t channels = static_cast<std::size_t>(variance.channels);
    Plane out(grid.size());
    grid.each_row([&](std::size_t y) {
        for (std::size_t i = y * grid.width; i < (y + 1) * grid.width; ++i) {
            const auto channel = [&](std::size_t c) { return std::sqrt(static_cast<double>(variance.f32()[i * channels + c])); };
            double deviation = channels < 3 ? channel(0) : 0.0;
            for (std::size_t c = 0; c < 3 && channels >= 3; ++c)
                deviation += kLuminance[c] * channel(c);
            const double relative = deviation / (reference[i] + least);
            out[i] = inside[i] > 0.0 ? relative * relative : 0.0;
        }
    });
    return out;
}

// Returns the mean over the pixels inside surfaces.
double mean_inside(const Plane& plane, std::int64_t pixels)
{
    double sum = 0.0;
    for (const double v : plane)
        sum += v;
    return sum / static_cast<double>(pixels);
}

// Returns the autocovariance at a lag that the high-pass filter leaves of white noise with a variance of 1. The filter subtracts a Gaussian
// from the pixel itself; the blur beyond surface edges is left out.
double high_passed_noise(int lag)
{
    const double s2 = kPatternSigma * kPatternSigma, lag2 = static_cast<double>(lag) * lag;
    const double gaussian = det_exp(-lag2 / (2.0 * s2)) / (2.0 * kPi * s2), both = det_exp(-lag2 / (4.0 * s2)) / (4.0 * kPi * s2);
    return (lag == 0 ? 1.0 : 0.0) - 2.0 * gaussian + both;
}

// One test's two errors, against two references or twice against one.
struct Errors {
    const Plane &first, &second, &inside;
    const Grid& grid;
    const Plane* noise; // variance of `first` that is to be subtracted; null: none

    // Returns the index of the pixel `lag` further along an axis, or grid.size() outside the picture.
    std::size_t further(std::size_t x, std::size_t y, bool along_y, std::size_t lag) const
    {
        const bool within = along_y ? y + lag < grid.height : x + lag < grid.width;
        return within ? y * grid.width + x + (along_y ? lag * grid.width : lag) : grid.size();
    }
};

// Returns the high-passed error's autocovariance along an axis, for lags from 0 on.
std::array<double, kPatternLags + 1> autocovariance(const Errors& e, bool along_y)
{
    struct Sum {
        double value = 0.0;
        std::int64_t count = 0;
    };
    using Lags = std::array<Sum, kPatternLags + 1>;
    std::vector<Lags> rows(e.grid.height);
    e.grid.each_row([&](std::size_t y) {
        for (std::size_t x = 0; x < e.grid.width; ++x) {
            const std::size_t i = y * e.grid.width + x;
            for (std::size_t lag = 0; lag < rows[y].size() && e.inside[i] > 0.0; ++lag) {
                const std::size_t j = e.further(x, y, along_y, lag);
                if (j == e.grid.size())
                    break;
                if (e.inside[j] > 0.0)
                    rows[y][lag].value += 0.5 * (e.first[i] * e.second[j] + e.second[i] * e.first[j]), ++rows[y][lag].count;
            }
        }
    });
    std::array<double, kPatternLags + 1> out = {};
    for (std::size_t lag = 0; lag < out.size(); ++lag) {
        Sum all;
        for (const Lags& row : rows)
            all.value += row[lag].value, all.count += row[lag].count;
        out[lag] = all.count ? all.value / static_cast<double>(all.count) : 0.0;
    }
    return out;
}

// Finds the strongest period along an axis, and keeps it in `f` if none before was stronger. The spectrum is Blackman's and Tukey's (1958):
// the autocovariance's transform under a Hann window, here divided by its value for a sinusoid with a variance of 1.
void find_period(const std::array<double, kPatternLags + 1>& covariance, bool along_y, PatternFigures& f)
{
    for (double period = 2.0; period <= kLongestPeriod; period += 0.5) {
        double power = covariance[0], norm = 1.0;
        for (int lag = 1; lag <= kPatternLags; ++lag) {
            const double window = 0.5 + 0.5 * det_cos(kPi * lag / (kPatternLags + 1)), wave = det_cos(2.0 * kPi * lag / period);
            power += 2.0 * window * covariance[static_cast<std::size_t>(lag)] * wave;
            norm += 2.0 * window * wave * wave;
        }
        const double rms = std::sqrt(std::max(0.0, power / norm));
        if (rms > f.period_rms)
            f.period = period, f.along_y = along_y, f.period_rms = rms;
    }
}

// Mean product of both errors' steps.
struct StepMean {
    double sum = 0.0, count = 0.0;

    // Returns two means' ratio, NaN where noise or missing steps leave none above 0.
    double over(const StepMean& other) const
    {
        const bool known = sum > 0.0 && other.sum > 0.0;
        return known ? (sum / count) / (other.sum / other.count) : std::numeric_limits<double>::quiet_NaN();
    }
};

// Compares the error's steps between neighbours along an axis.
void find_steps(const Errors& e, bool along_y, PatternFigures& f)
{
    StepMean within_quads, between_quads, within_tiles, between_tiles;
    for (std::size_t y = 0; y < e.grid.height; ++y)
        for (std::size_t x = 0; x < e.grid.width; ++x) {
            const std::size_t i = y * e.grid.width + x, j = e.further(x, y, along_y, 1), at = along_y ? y : x;
            if (j == e.grid.size() || e.inside[i] == 0.0 || e.inside[j] == 0.0)
                continue;
            const double noise = e.noise ? (*e.noise)[i] + (*e.noise)[j] : 0.0;
            const double product = (e.first[j] - e.first[i]) * (e.second[j] - e.second[i]) - noise;
            for (StepMean* mean :
                 {at % 2 ? &between_quads : &within_quads, at % kPatternTile == kPatternTile - 1 ? &between_tiles : &within_tiles})
                mean->sum += product, mean->count += 1.0;
        }
    const std::size_t axis = along_y ? 1 : 0;
    f.quad_ratio[axis] = between_quads.over(within_quads);
    f.tile_ratio[axis] = between_tiles.over(within_tiles);
}

} // namespace

PatternFigures pattern_figures(const Image& reference, const Image* second, const Image& test, const Jobs& jobs, const Image* variance)
{
    for (const Image* image : {&test, second}) {
        if (!image)
            continue;
        BN_CHECK_OP(reference.width, ==, image->width);
        BN_CHECK_OP(reference.height, ==, image->height);
        BN_CHECK_OP(reference.channels, ==, image->channels);
    }
    const Grid grid{static_cast<std::size_t>(reference.width), static_cast<std::size_t>(reference.height), jobs};
    // Find luminances, and the pixels inside surfaces
    const Plane of_reference = luminance_of(reference, grid), of_test = luminance_of(test, grid);
    const Plane of_second = second ? luminance_of(*second, grid) : Plane();
    std::vector<const Plane*> all = {&of_reference, &of_test};
    if (second)
        all.push_back(&of_second);
    const Plane inside = inside_of(all, grid);
    PatternFigures f;
    double sum = 0.0;
    for (std::size_t i = 0; i < inside.size(); ++i)
        if (inside[i] > 0.0)
            sum += of_reference[i], ++f.pixels;
    if (f.pixels == 0)
        return f;
    // Find the errors, as they are and high-passed
    const double least = kPatternFloor * sum / static_cast<double>(f.pixels);
    const Plane weight = blurred(inside, grid);
    const Plane first = error_of(of_reference, of_test, inside, least, grid);
    const Plane other = second ? error_of(of_second, of_test, inside, least, grid) : Plane();
    const Plane first_high = high_passed(first, inside, weight, grid);
    const Plane other_high = second ? high_passed(other, inside, weight, grid) : Plane();
    // Find the reference's noise
    const bool subtract = variance && !second;
    const Plane noise = subtract ? noise_of(*variance, of_reference, inside, least, grid) : Plane();
    const double mean_noise = subtract ? mean_inside(noise, f.pixels) : 0.0;
    if (!std::isfinite(mean_noise)) {
        f.rms = f.period = f.period_rms = std::numeric_limits<double>::quiet_NaN();
        for (const std::size_t axis : {0u, 1u})
            f.quad_ratio[axis] = f.tile_ratio[axis] = f.rms;
        return f;
    }
    const Errors errors{first, second ? other : first, inside, grid, subtract ? &noise : nullptr};
    const Errors high{first_high, second ? other_high : first_high, inside, grid, nullptr};
    // Measure
    for (const bool along_y : {false, true}) {
        auto covariance = autocovariance(high, along_y);
        for (std::size_t lag = 0; lag < covariance.size(); ++lag)
            covariance[lag] -= mean_noise * high_passed_noise(static_cast<int>(lag));
        f.rms = std::sqrt(std::max(0.0, covariance[0]));
        find_period(covariance, along_y, f);
        find_steps(errors, along_y, f);
    }
    return f;
}

} // namespace burnish
