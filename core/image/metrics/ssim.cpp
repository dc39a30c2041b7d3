// SSIM with separated windows: strips of rows in parallel. Filters each row's moments along x once.
#include <algorithm>
#include <array>
#include <vector>

#include "core/base/check.h"
#include "core/image/io/stored_row.h"
#include "core/image/metrics/metrics.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr int kStripHeight = 64; // rows

using Window = std::array<double, kRadius + 1>; // half of the window, [0] at the centre
using Line = std::vector<double>;

Window make_window()
{
    Window w;
    double sum = 0.0;
    for (int k = 0; k <= kRadius; ++k) {
        w[static_cast<std::size_t>(k)] = det_exp(-0.5 * k * k / (kSigma * kSigma));
        sum += (k == 0 ? 1.0 : 2.0) * w[static_cast<std::size_t>(k)];
    }
    for (double& v : w)
        v /= sum;
    return w;
}

// Window centres along an image side, [begin, end). The whole side where no window fits.
struct Centres {
    int begin, end;
};
Centres centres_of(int side)
{
    return side > 2 * kRadius ? Centres{kRadius, side - kRadius} : Centres{0, side};
}

Line luminance_row(const Image& image, int y, std::vector<float>& scratch)
{
    read_stored_row(image, y, scratch);
    const std::size_t width = static_cast<std::size_t>(image.width), channels = static_cast<std::size_t>(image.channels);
    Line line(width + 2 * kRadius); // with repeated edges
    for (std::size_t x = 0; x < width; ++x) {
        const float* v = scratch.data() + x * channels;
        line[x + kRadius] =
            channels < 3 ? static_cast<double>(v[0])
                         : 0.2126 * static_cast<double>(v[0]) + 0.7152 * static_cast<double>(v[1]) + 0.0722 * static_cast<double>(v[2]);
    }
    std::fill_n(line.begin(), kRadius, line[kRadius]);
    std::fill_n(line.end() - kRadius, kRadius, line[width + kRadius - 1]);
    return line;
}

// Weighted sums along x of a, b, a^2, b^2 and ab.
struct Moments {
    std::array<Line, 5> of;
};

Line filtered(const Line& padded, const Window& window)
{
    const std::size_t width = padded.size() - 2 * kRadius;
    Line out(width);
    const double* in = padded.data() + kRadius;
    for (std::size_t x = 0; x < width; ++x)
        out[x] = in[x] * window[0];
    for (std::size_t k = 1; k <= kRadius; ++k)
        for (std::size_t x = 0; x < width; ++x)
            out[x] += ((in - k)[x] + in[x + k]) * window[k];
    return out;
}

Line product(const Line& a, const Line& b)
{
    Line p(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        p[i] = a[i] * b[i];
    return p;
}

Moments moments_of_row(const Image& reference, const Image& test, int y, const Window& window)
{
    std::vector<float> scratch;
    const Line a = luminance_row(reference, y, scratch), b = luminance_row(test, y, scratch);
    return {{filtered(a, window), filtered(b, window), filtered(product(a, a), window), filtered(product(b, b), window),
             filtered(product(a, b), window)}};
}

// Sums Wang et al. 2004, eq. 13, over a row; c1 = (K1 L)^2, c2 = (K2 L)^2.
double sum_of_row(const std::array<Line, 5>& m, Centres columns, double c1, double c2)
{
    double sum = 0.0;
    for (int column = columns.begin; column < columns.end; ++column) {
        const std::size_t x = static_cast<std::size_t>(column);
        const double a = m[0][x], b = m[1][x];
        const double variances = (m[2][x] - a * a) + (m[3][x] - b * b), covariance = m[4][x] - a * b;
        sum += (2.0 * (a * b) + c1) * (2.0 * covariance + c2) / ((a * a + b * b + c1) * (variances + c2));
    }
    return sum;
}

std::array<Line, 5> filter_columns(const std::vector<Moments>& rows, int first, int y, int height, const Window& window)
{
    const auto row = [&](int at) -> const Moments& { return rows[static_cast<std::size_t>(std::clamp(at, 0, height - 1) - first)]; };
    std::array<Line, 5> out;
    for (std::size_t m = 0; m < out.size(); ++m) {
        out[m] = row(y).of[m];
        for (double& v : out[m])
            v *= window[0];
        for (int k = 1; k <= kRadius; ++k) {
            const Line &above = row(y - k).of[m], &below = row(y + k).of[m];
            for (std::size_t x = 0; x < out[m].size(); ++x)
                out[m][x] += (above[x] + below[x]) * window[static_cast<std::size_t>(k)];
        }
    }
    return out;
}

} // namespace

double ssim(const Image& reference, const Image& test, const Jobs& jobs)
{
    BN_CHECK_OP(reference.width, ==, test.width);
    BN_CHECK_OP(reference.height, ==, test.height);
    BN_CHECK_OP(reference.channels, ==, test.channels);
    const Window window = make_window();
    const double peak = peak_value(reference), c1 = 0.01 * peak * (0.01 * peak), c2 = 0.03 * peak * (0.03 * peak);
    const Centres rows = centres_of(reference.height), columns = centres_of(reference.width);
    const int strips = (rows.end - rows.begin + kStripHeight - 1) / kStripHeight;
    std::vector<double> sums(static_cast<std::size_t>(rows.end));
    jobs.parallel_for(static_cast<std::size_t>(strips), [&](std::size_t strip, int) {
        const int begin = rows.begin + static_cast<int>(strip) * kStripHeight;
        const int end = std::min(begin + kStripHeight, rows.end);
        const int first = std::max(0, begin - kRadius), last = std::min(reference.height - 1, end - 1 + kRadius);
        std::vector<Moments> moments;
        for (int y = first; y <= last; ++y)
            moments.push_back(moments_of_row(reference, test, y, window));
        for (int y = begin; y < end; ++y)
            sums[static_cast<std::size_t>(y)] = sum_of_row(filter_columns(moments, first, y, reference.height, window), columns, c1, c2);
    });
    double sum = 0.0;
    for (const double s : sums)
        sum += s;
    return sum / (static_cast<double>(rows.end - rows.begin) * (columns.end - columns.begin));
}

} // namespace burnish
