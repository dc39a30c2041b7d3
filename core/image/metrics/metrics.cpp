#include "core/image/metrics/metrics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/check.h"
#include "core/image/io/stored_row.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr double kLn10 = 2.30258509299404568402;

struct RowSums {
    double square = 0.0, relative = 0.0;
    float max_abs = 0.0f;
    std::int64_t differing = 0;
};

void check_pair(const Image& reference, const Image& test)
{
    BN_CHECK_OP(reference.width, ==, test.width);
    BN_CHECK_OP(reference.height, ==, test.height);
    BN_CHECK_OP(reference.channels, ==, test.channels);
}

RowSums sums_of_row(const Image& reference, const Image& test, int y)
{
    std::vector<float> a, b;
    read_stored_row(reference, y, a);
    read_stored_row(test, y, b);
    const std::size_t channels = static_cast<std::size_t>(reference.channels);
    const std::size_t colours = static_cast<std::size_t>(colour_channels(reference));
    RowSums row;
    for (std::size_t i = 0; i < a.size(); i += channels) {
        bool differs = false;
        for (std::size_t c = 0; c < channels; ++c) {
            const double r = static_cast<double>(a[i + c]), d = r - static_cast<double>(b[i + c]);
            row.max_abs = std::max(row.max_abs, static_cast<float>(std::fabs(d)));
            differs = differs || a[i + c] != b[i + c];
            if (c < colours) {
                row.square += d * d;
                row.relative += d * d / (r * r + kRelativeMseEpsilon);
            }
        }
        row.differing += differs ? 1 : 0;
    }
    return row;
}

bool finite_pixel(const float* values, int channels)
{
    return std::all_of(values, values + channels, [](float v) { return std::isfinite(v); });
}

// Converts an error to fixed point: sums are exact and independent of the order. The sum of 2^28 pixels with error 1
// still fits.
std::uint64_t fixed_point(float error)
{
    return static_cast<std::uint64_t>(static_cast<double>(error) * 0x1p32 + 0.5);
}

// Returns the smallest value at which the cumulative weight exceeds `threshold`. Positive floats sort like their bits,
// so a histogram of the upper halves leaves few values to sort.
template <class Weight> float select_value(const std::vector<float>& values, std::uint64_t threshold, const Weight& weight)
{
    constexpr unsigned kShift = 16;
    std::vector<std::uint64_t> histogram(std::size_t{1} << 16);
    for (const float v : values)
        histogram[std::bit_cast<std::uint32_t>(v) >> kShift] += weight(v);
    std::uint64_t below = 0;
    std::size_t key = 0;
    while (key + 1 < histogram.size() && below + histogram[key] <= threshold)
        below += histogram[key++];
    std::vector<float> nearby;
    for (const float v : values)
        if (std::bit_cast<std::uint32_t>(v) >> kShift == key)
            nearby.push_back(v);
    std::sort(nearby.begin(), nearby.end());
    for (const float v : nearby) {
        below += weight(v);
        if (below > threshold)
            return v;
    }
    return nearby.empty() ? 0.0f : nearby.back();
}

} // namespace

PixelFigures pixel_figures(const Image& reference, const Image& test, const Jobs& jobs)
{
    check_pair(reference, test);
    std::vector<RowSums> rows(static_cast<std::size_t>(reference.height));
    jobs.parallel_for(rows.size(), [&](std::size_t y, int) { rows[y] = sums_of_row(reference, test, static_cast<int>(y)); });
    RowSums all;
    for (const RowSums& row : rows) {
        all.square += row.square;
        all.relative += row.relative;
        all.max_abs = std::max(all.max_abs, row.max_abs);
        all.differing += row.differing;
    }
    const double pixels = static_cast<double>(reference.width) * reference.height;
    const double values = pixels * colour_channels(reference);
    PixelFigures figures;
    figures.mse = all.square / values;
    figures.rel_mse = all.relative / values;
    const double peak = peak_value(reference);
    figures.psnr = figures.mse > 0.0 ? 10.0 / kLn10 * det_log(peak * peak / figures.mse) : std::numeric_limits<double>::infinity();
    figures.max_abs = static_cast<double>(all.max_abs);
    figures.differing_fraction = static_cast<double>(all.differing) / pixels;
    return figures;
}

std::int64_t not_finite_pixels(const Image& reference, const Image& test)
{
    check_pair(reference, test);
    if (reference.type != PixelType::f32 || test.type != PixelType::f32)
        return 0;
    std::int64_t count = 0;
    const std::size_t channels = static_cast<std::size_t>(reference.channels);
    for (std::size_t i = 0; i < reference.bytes.size() / sizeof(float); i += channels)
        if (!finite_pixel(reference.f32() + i, reference.channels) || !finite_pixel(test.f32() + i, test.channels))
            ++count;
    return count;
}

double peak_value(const Image& reference)
{
    if (reference.type != PixelType::f32)
        return 1.0;
    float peak = 0.0f;
    const std::size_t channels = static_cast<std::size_t>(reference.channels);
    for (std::size_t i = 0; i < reference.bytes.size() / sizeof(float); i += channels)
        for (int c = 0; c < colour_channels(reference); ++c)
            peak = std::max(peak, reference.f32()[i + static_cast<std::size_t>(c)]);
    return peak > 0.0f ? static_cast<double>(peak) : 1.0;
}

ErrorSummary summarise_errors(const Image& error)
{
    BN_CHECK(error.type == PixelType::f32 && error.channels == 1 && !error.empty());
    std::vector<float> values(error.f32(), error.f32() + error.bytes.size() / sizeof(float));
    std::uint64_t sum = 0;
    float largest = 0.0f;
    for (float& v : values) {
        v = v > 0.0f ? v : 0.0f; // -0 would have the largest bits
        sum += fixed_point(v);
        largest = std::max(largest, v);
    }
    const std::uint64_t count = values.size();
    ErrorSummary summary;
    summary.mean = static_cast<double>(sum) * 0x1p-32 / static_cast<double>(count);
    summary.max = static_cast<double>(largest);
    const std::uint64_t rank = count - count / 100; // the smallest integer at or above 0.99 count
    summary.p99 = static_cast<double>(select_value(values, rank - 1, [](float) { return std::uint64_t{1}; }));
    summary.weighted_median = static_cast<double>(select_value(values, sum / 2, fixed_point));
    return summary;
}

} // namespace burnish
