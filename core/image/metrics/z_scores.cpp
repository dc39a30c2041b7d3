#include "core/image/metrics/z_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/check.h"
#include "core/image/io/stored_row.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

// Returns 1 - erf(x) for x >= 0 (Abramowitz and Stegun 1964): the series 7.1.6 where it converges fast, else the
// continued fraction 7.1.14.
double erfc_of(double x)
{
    const double bell = det_exp(-x * x) / std::sqrt(kPi);
    if (x < 2.0) {
        double term = x, sum = x;
        for (int n = 1; n < 80; ++n) {
            term *= 2.0 * x * x / (2.0 * n + 1.0);
            sum += term;
        }
        return 1.0 - 2.0 * bell * sum;
    }
    double fraction = x;
    for (int n = 80; n >= 1; --n)
        fraction = x + 0.5 * n / fraction;
    return bell / fraction;
}

// Returns 1 - (1 - a)^(1/n) without losing digits of small results.
double level_of_one(double a, double n)
{
    const double t = -det_log(1.0 - a) / n; // the result is 1 - e^-t
    if (t > 0.01)
        return 1.0 - det_exp(-t);
    return t * (1.0 - t / 2.0 * (1.0 - t / 3.0 * (1.0 - t / 4.0 * (1.0 - t / 5.0))));
}

struct RowResult {
    double largest_square = 0.0; // largest z^2
    std::int64_t rejected = 0;
};

} // namespace

double sidak_limit(double significance, std::int64_t tests)
{
    BN_CHECK(significance > 0.0 && significance < 1.0 && tests > 0);
    const double level = level_of_one(significance, static_cast<double>(tests));
    double low = 0.0, high = 38.0; // beyond 38, the tail is below the smallest double
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (erfc_of(middle * 0.70710678118654752) > level ? low : high) = middle;
    }
    return high;
}

ZTest z_test(const Image& reference, const Image& test, const Image& reference_variance, const Image* test_variance, double significance,
             const Jobs& jobs)
{
    // Check the images
    const Image* const all[] = {&reference, &test, &reference_variance, test_variance ? test_variance : &reference};
    for (const Image* image : all) {
        BN_CHECK(image->type == PixelType::f32);
        BN_CHECK_OP(image->bytes.size(), ==, reference.bytes.size());
    }
    const std::size_t channels = static_cast<std::size_t>(reference.channels);
    const std::size_t colours = static_cast<std::size_t>(colour_channels(reference));
    const std::size_t width = static_cast<std::size_t>(reference.width);
    const std::int64_t pixels = static_cast<std::int64_t>(reference.width) * reference.height;
    // Find the limit for all tests together
    ZTest result;
    result.limit = sidak_limit(significance, pixels * static_cast<std::int64_t>(colours));
    const double limit_square = result.limit * result.limit;

    // Test each channel of each pixel
    std::vector<RowResult> rows(static_cast<std::size_t>(reference.height));
    jobs.parallel_for(rows.size(), [&](std::size_t y, int) {
        for (std::size_t i = y * width * channels; i < (y + 1) * width * channels; i += channels) {
            bool rejected = false;
            for (std::size_t c = i; c < i + colours; ++c) {
                const double d = static_cast<double>(reference.f32()[c]) - static_cast<double>(test.f32()[c]);
                double variance = static_cast<double>(reference_variance.f32()[c]);
                if (test_variance)
                    variance += static_cast<double>(test_variance->f32()[c]);
                const double square = d == 0.0 ? 0.0 : variance == 0.0 ? std::numeric_limits<double>::infinity() : d * d / variance;
                rows[y].largest_square = std::max(rows[y].largest_square, square);
                rejected = rejected || square > limit_square;
            }
            rows[y].rejected += rejected ? 1 : 0;
        }
    });
    // Sum up the rows
    for (const RowResult& row : rows) {
        result.largest = std::max(result.largest, std::sqrt(row.largest_square));
        result.rejected += row.rejected;
    }
    result.rejected_fraction = static_cast<double>(result.rejected) / static_cast<double>(pixels);
    return result;
}

} // namespace burnish
