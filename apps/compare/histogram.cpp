#include "apps/compare/histogram.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/report/axes.h"
#include "core/image/magma.h"

namespace burnish {
namespace {

constexpr double kWidth = 650.0, kHeight = 260.0, kLeft = 62.0, kRight = 638.0, kTop = 22.0, kBottom = 208.0; // px

Paint magma(double value)
{
    Image one = make_image(1, 1, 1, PixelType::f32);
    one.f32()[0] = static_cast<float>(value);
    const Image mapped = magma_map(one);
    const auto channel = [&mapped](std::size_t i) { return static_cast<double>(mapped.bytes[i]); };
    return {channel(0), channel(1), channel(2)};
}

double x_of(double error)
{
    return kLeft + std::clamp(error, 0.0, 1.0) * (kRight - kLeft);
}

void draw_marker(Drawing& out, double error, const char* name, double y)
{
    out.line({{x_of(error), y}, {x_of(error), kBottom}}, "whisker c1");
    const bool end = error > 0.8;
    out.text(x_of(error) + (end ? -5.0 : 5.0), y + 9.0, end ? "tick end" : "tick", fmt::format("{} {}", name, number(error)));
}

} // namespace

std::vector<double> histogram_of(const Image& error)
{
    std::vector<double> bins(kHistogramBins);
    const std::size_t pixels = static_cast<std::size_t>(error.width) * static_cast<std::size_t>(error.height);
    for (std::size_t i = 0; i < pixels; ++i) {
        const double value = static_cast<double>(error.f32()[i]);
        bins[static_cast<std::size_t>(std::clamp(value * kHistogramBins, 0.0, kHistogramBins - 1.0))] += 1.0 / static_cast<double>(pixels);
    }
    return bins;
}

Drawing plot_histogram(const Image& error, const ErrorSummary& summary)
{
    Drawing out(kWidth, kHeight, "chart", "How FLIP's errors are spread over the pixels");
    const double one_pixel = 1.0 / (static_cast<double>(error.width) * error.height);
    const Axis y{std::min(0.5 * one_pixel, 0.01), 1.0, kBottom, kTop}; // logarithmic, to show even a few wrong pixels
    for (double share = 1.0; share >= y.low; share /= 10.0) {
        out.line({{kLeft, y.at(share)}, {kRight, y.at(share)}}, "grid");
        out.text(kLeft - 7.0, y.at(share) + 4.5, "tick end", fmt::format("{} %", number(100.0 * share)));
    }
    const std::vector<double> bins = histogram_of(error);
    for (int i = 0; i < kHistogramBins; ++i) {
        const double share = bins[static_cast<std::size_t>(i)], from = static_cast<double>(i) / kHistogramBins,
                     to = (i + 1.0) / kHistogramBins;
        if (share <= 0.0)
            continue;
        out.open("", {{"role", "img"}}, fmt::format("{:.2f} to {:.2f}: {} % of the pixels", from, to, number(100.0 * share)));
        out.rectangle(x_of(from), y.at(share), x_of(to) - x_of(from) - 1.0, kBottom - y.at(share), "", magma(0.5 * (from + to)));
        out.close();
    }
    for (int i = 0; i <= 10; i += 2)
        out.text(x_of(0.1 * i), kBottom + 18.0, "tick middle", number(0.1 * i));
    out.text(0.5 * (kLeft + kRight), kBottom + 40.0, "title middle", "FLIP");
    out.text(14.0, 0.5 * (kTop + kBottom), "title middle", "pixels", -90.0);
    draw_marker(out, summary.mean, "mean", kTop - 14.0);
    draw_marker(out, summary.p99, "p99", kTop);
    return out;
}

} // namespace burnish
