#include "apps/golden/difference.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/core.h>
#include <utility>

#include "apps/compare/displayed.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/image/metrics/pattern.h"
#include "core/image/metrics/z_scores.h"

namespace burnish {
namespace {

constexpr double kSignificance = 0.01; // of the z-test over all pixels
constexpr double kBrightest = 0.005;   // share of pixels that count as highlights
constexpr double kMoved = 1.0;         // pixels; a highlight that moved less is not mentioned

std::size_t value_bytes(PixelType type)
{
    return type == PixelType::u8 ? 1 : type == PixelType::u16 ? 2 : 4;
}

// Copies the golden's values where the mask is black.
void apply_mask(const Image& mask, const Image& golden, Image& picture)
{
    const std::size_t of_mask = value_bytes(mask.type) * static_cast<std::size_t>(mask.channels),
                      of_pixel = value_bytes(picture.type) * static_cast<std::size_t>(picture.channels),
                      colours = value_bytes(mask.type) * static_cast<std::size_t>(mask.channels < 3 ? 1 : 3);
    const std::size_t pixels = picture.bytes.size() / of_pixel;
    for (std::size_t p = 0; p < pixels; ++p) {
        const std::byte* at = mask.bytes.data() + p * of_mask;
        if (std::all_of(at, at + colours, [](std::byte b) { return b == std::byte{0}; }))
            std::memcpy(picture.bytes.data() + p * of_pixel, golden.bytes.data() + p * of_pixel, of_pixel);
    }
}

// Returns a pixel's mean of colours, in its type's units.
double brightness(const Image& image, std::size_t pixel)
{
    const int colours = std::min(image.channels, 3);
    double sum = 0.0;
    for (int c = 0; c < colours; ++c) {
        const std::size_t at = pixel * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(c);
        sum += image.type == PixelType::f32   ? static_cast<double>(image.f32()[at])
               : image.type == PixelType::u16 ? reinterpret_cast<const std::uint16_t*>(image.bytes.data())[at]
                                              : static_cast<int>(image.bytes[at]);
    }
    return sum / colours;
}

struct Spot {
    double x = 0.0, y = 0.0;
};

// Returns the centre of the brightest pixels.
Spot highlight_of(const Image& image)
{
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::vector<double> values(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        values[p] = brightness(image, p);
    std::vector<double> sorted = values;
    const std::size_t at = pixels - 1 - static_cast<std::size_t>(kBrightest * static_cast<double>(pixels - 1));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(at), sorted.end());
    Spot sum;
    double count = 0.0;
    for (std::size_t p = 0; p < pixels; ++p)
        if (values[p] >= sorted[at]) {
            sum.x += static_cast<double>(p % static_cast<std::size_t>(image.width));
            sum.y += static_cast<double>(p / static_cast<std::size_t>(image.width));
            count += 1.0;
        }
    return {sum.x / count, sum.y / count};
}

// Returns the box of all pixels that differ: "within 40x20 pixels from 120,80".
std::string place_of_difference(const Image& a, const Image& b)
{
    const std::size_t of_pixel = value_bytes(a.type) * static_cast<std::size_t>(a.channels);
    int x0 = a.width, y0 = a.height, x1 = -1, y1 = -1;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const std::size_t at =
                (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x)) * of_pixel;
            if (std::memcmp(a.bytes.data() + at, b.bytes.data() + at, of_pixel) != 0)
                x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
        }
    return fmt::format("within {}x{} pixels from {},{}", x1 - x0 + 1, y1 - y0 + 1, x0, y0);
}

std::string percent(double share)
{
    return share < 0.001 ? "less than 0.1 %" : fmt::format("{:.1f} %", 100.0 * share);
}

// Tells a measured difference in words.
std::string words_of(const Image& golden, const Image& picture, const GoldenResult& result)
{
    std::string text = fmt::format("{} of the pixels differ, {}, by {:.3g} at most; mean FLIP {:.4f}", percent(*result.differing),
                                   place_of_difference(golden, picture), *result.largest, *result.flip);
    const Spot before = highlight_of(golden), now = highlight_of(picture);
    if (const double moved = std::hypot(now.x - before.x, now.y - before.y); moved >= kMoved)
        text += fmt::format("; the highlights moved by {:.1f} pixels", moved);
    return text;
}

// Returns the excess over a limit in words, or nothing.
std::string excess(const char* name, double value, const std::optional<double>& limit)
{
    return limit && !(value <= *limit) ? fmt::format("{} is {:.4g}, above {:.4g}; ", name, value, *limit) : "";
}

} // namespace

Status show(const Image& image, float exposure_ev, const std::string& path)
{
    return write_image(path, displayed(image, exposure_ev));
}

std::string exposure_ending(int stops)
{
    return stops == 0 ? ".png" : fmt::format("%ev{}.png", stops);
}

void judge(const GoldenLimits& limits, DifferenceInput input, const Jobs& jobs, const std::string& shown, GoldenResult& result)
{
    const Image& golden = input.golden;
    Image& picture = input.picture;
    const auto fails = [&](GoldenVerdict verdict, std::string reason) { result.verdict = verdict, result.reason = std::move(reason); };
    // Compare shapes, then values
    if (golden.width != picture.width || golden.height != picture.height || golden.channels != picture.channels ||
        golden.type != picture.type)
        return fails(GoldenVerdict::differs, fmt::format("it is {}; the golden is {}", describe(picture), describe(golden)));
    if (input.mask) {
        if (input.mask->width != picture.width || input.mask->height != picture.height)
            return fails(GoldenVerdict::failed, fmt::format("its mask is {}; the picture is {}", describe(*input.mask), describe(picture)));
        apply_mask(*input.mask, golden, picture);
    }
    if (golden.bytes == picture.bytes)
        return set_equal(result);
    if (const std::int64_t bad = not_finite_pixels(golden, picture))
        return fails(GoldenVerdict::differs, fmt::format("{} pixels of the golden are NaN or Inf", bad));
    // Measure
    FlipOptions options;
    const FlipResult flip =
        golden.type == PixelType::f32 ? flip_hdr(golden, picture, options, jobs) : flip_ldr(golden, picture, options, jobs);
    const ErrorSummary errors = summarise_errors(flip.error);
    const PixelFigures pixels = pixel_figures(golden, picture, jobs);
    result.flip = errors.mean, result.flip_p99 = errors.p99, result.differing = pixels.differing_fraction, result.largest = pixels.max_abs;
    // Hold the limits
    std::string over = excess("mean FLIP", errors.mean, limits.flip) + excess("FLIP's 99th percentile", errors.p99, limits.flip_p99);
    if (limits.pattern)
        over += excess("RMS of patterns", pattern_figures(golden, nullptr, picture, jobs).rms, limits.pattern);
    if (limits.z) {
        const auto fits = [&](Image& v) {
            if (golden.channels == 4 && v.channels == 3 && v.type == PixelType::f32)
                v = with_alpha(v, [](std::size_t) { return 0.0f; }); // coverage has no noise
            return v.width == golden.width && v.height == golden.height && v.channels == golden.channels && v.type == PixelType::f32;
        };
        if (golden.type != PixelType::f32 || !fits(*input.golden_variance) || (input.variance && !fits(*input.variance)))
            return fails(GoldenVerdict::failed, "the z-test needs floats, and variances of the same shape");
        const ZTest z = z_test(golden, picture, *input.golden_variance, input.variance ? &*input.variance : nullptr, kSignificance, jobs);
        over += excess("the share of pixels that the z-test rejects", z.rejected_fraction, limits.z);
    }
    result.reason = words_of(golden, picture, result);
    if (!over.empty() || limits.exact())
        result.verdict = GoldenVerdict::differs, result.reason = over + result.reason;
    // Write the page's pictures
    const float exposure = golden.type == PixelType::f32 ? 0.5f * (flip.exposures.start_ev + flip.exposures.stop_ev) : 0.0f;
    for (const Status& written : {show(picture, exposure, shown + ".png"), show(golden, exposure, shown + "%golden.png"),
                                  write_image(shown + "%error.png", magma_map(flip.error))})
        if (!written)
            return fails(GoldenVerdict::failed, written.error().line());
    if (golden.type != PixelType::f32 || result.verdict == GoldenVerdict::passed)
        return;
    for (const int stops : kMoreExposures)
        for (const auto& [image, name] : {std::pair<const Image*, std::string>{&picture, shown}, {&golden, shown + "%golden"}})
            if (const Status written = show(*image, exposure + static_cast<float>(stops), name + exposure_ending(stops)); !written)
                return fails(GoldenVerdict::failed, written.error().line());
}

} // namespace burnish
