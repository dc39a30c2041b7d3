#include "apps/compare/figures.h"

#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/report/json.h"
#include "core/base/text.h"

namespace burnish {
namespace {

// Returns the metrics for the pictures' format, and those that an output or a limit needs.
Metrics wanted(const CompareOptions& options, bool floats)
{
    Metrics m = options.metrics.value_or(Metrics{!floats, floats, true, true, true, true, true, false});
    if (options.fail_flip || !options.error_map.empty() || !options.html.empty())
        if (!m.flip && !m.flip_hdr)
            (floats ? m.flip_hdr : m.flip) = true;
    m.pattern = m.pattern || options.fail_pattern || !options.second_reference.empty();
    m.max = m.max || options.fail_max || options.fail_fraction;
    return m;
}

const char* flip_name(const Metrics& metrics)
{
    return metrics.flip_hdr ? "flip-hdr" : "flip";
}

// Returns a number, or null: JSON has neither NaN nor infinity.
Json value_or_null(bool known, double value)
{
    return known && std::isfinite(value) ? Json(value) : Json();
}

std::string ratio(double value)
{
    return std::isfinite(value) ? fmt::format("{:.2f}", value) : "unknown";
}

} // namespace

CompareFigures compare_pictures(const CompareOptions& options, const Pictures& pictures, const Jobs& jobs)
{
    const Image &reference = pictures.reference, &test = pictures.test;
    CompareFigures figures;
    figures.asked = wanted(options, reference.type == PixelType::f32);
    figures.width = reference.width;
    figures.height = reference.height;
    figures.nan_pixels = not_finite_pixels(reference, test);
    if (pictures.second_reference)
        figures.nan_pixels += not_finite_pixels(*pictures.second_reference, *pictures.second_reference);
    if (figures.nan_pixels)
        return figures;
    const Metrics& asked = figures.asked;
    if (asked.flip || asked.flip_hdr) {
        const TraceSpan span("flip");
        figures.flip = asked.flip_hdr ? flip_hdr(reference, test, options.flip, jobs) : flip_ldr(reference, test, options.flip, jobs);
        figures.errors = summarise_errors(figures.flip.error);
    }
    if (asked.mse || asked.rel_mse || asked.psnr || asked.max)
        figures.pixels = pixel_figures(reference, test, jobs);
    if (asked.ssim)
        figures.ssim = ssim(reference, test, jobs);
    if (asked.pattern) {
        const TraceSpan span("pattern");
        figures.pattern = pattern_figures(reference, pictures.second_reference ? &*pictures.second_reference : nullptr, test, jobs,
                                          pictures.variances.empty() ? nullptr : &pictures.variances[0]);
    }
    if (!pictures.variances.empty())
        figures.z = z_test(reference, test, pictures.variances[0], pictures.variances.size() > 1 ? &pictures.variances[1] : nullptr,
                           options.significance, jobs);
    return figures;
}

Json compare_json(const CompareOptions& options, const CompareFigures& figures)
{
    Json json;
    const Metrics& asked = figures.asked;
    json["width"] = figures.width;
    json["height"] = figures.height;
    const auto put = [&json](const char* name, bool wanted_here, bool known, double value) {
        if (wanted_here)
            json[name] = value_or_null(known, value);
    };
    const bool flip = asked.flip || asked.flip_hdr, errors = figures.errors.has_value(), pixels = figures.pixels.has_value();
    if (flip) {
        json["flip_kind"] = flip_name(asked);
        json["ppd"] = shortest_decimal(options.flip.ppd);
    }
    const ErrorSummary e = figures.errors.value_or(ErrorSummary{});
    put("flip_mean", flip, errors, e.mean);
    put("flip_p99", flip, errors, e.p99);
    put("flip_weighted_median", flip, errors, e.weighted_median);
    put("flip_max", flip, errors, e.max);
    const FlipExposures& range = figures.flip.exposures;
    put("start_exposure", asked.flip_hdr, errors, shortest_decimal(range.start_ev));
    put("stop_exposure", asked.flip_hdr, errors, shortest_decimal(range.stop_ev));
    if (asked.flip_hdr)
        json["exposures"] = errors ? Json(range.count) : Json();
    const PixelFigures p = figures.pixels.value_or(PixelFigures{});
    put("mse", asked.mse, pixels, p.mse);
    put("rel_mse", asked.rel_mse, pixels, p.rel_mse);
    put("psnr", asked.psnr, pixels, p.psnr);
    put("ssim", asked.ssim, figures.ssim.has_value(), figures.ssim.value_or(0.0));
    put("max_abs", asked.max, pixels, p.max_abs);
    put("differing_fraction", asked.max, pixels, p.differing_fraction);
    const PatternFigures t = figures.pattern.value_or(PatternFigures{});
    const bool inside = t.pixels > 0;
    if (asked.pattern)
        json["pattern_pixels"] = figures.pattern ? Json(t.pixels) : Json();
    put("pattern_rms", asked.pattern, inside, t.rms);
    put("pattern_period", asked.pattern, t.period > 0.0, t.period);
    put("pattern_period_rms", asked.pattern, inside, t.period_rms);
    if (asked.pattern)
        json["pattern_period_axis"] = t.period > 0.0 ? Json(t.along_y ? "y" : "x") : Json();
    put("quad_ratio_x", asked.pattern, inside, t.quad_ratio[0]);
    put("quad_ratio_y", asked.pattern, inside, t.quad_ratio[1]);
    put("tile_ratio_x", asked.pattern, inside, t.tile_ratio[0]);
    put("tile_ratio_y", asked.pattern, inside, t.tile_ratio[1]);
    const ZTest z = figures.z.value_or(ZTest{});
    put("z_limit", !options.variances.empty(), figures.z.has_value(), z.limit);
    put("z_max", !options.variances.empty(), figures.z.has_value(), z.largest);
    put("z_rejected_fraction", !options.variances.empty(), figures.z.has_value(), z.rejected_fraction);
    json["nan_pixels"] = figures.nan_pixels;
    return json;
}

std::vector<std::pair<std::string, std::string>> figure_lines(const CompareOptions& options, const CompareFigures& figures)
{
    std::vector<std::pair<std::string, std::string>> lines;
    const auto add = [&lines](const char* name, double value) { lines.emplace_back(name, fmt::format("{:.6g}", value)); };
    const Metrics& asked = figures.asked;
    if (figures.errors) {
        const ErrorSummary& e = *figures.errors;
        lines.emplace_back(flip_name(asked), fmt::format("mean {:.6f}, p99 {:.6f}, weighted median {:.6f}, max {:.6f}", e.mean, e.p99,
                                                         e.weighted_median, e.max));
        lines.emplace_back("seen at", fmt::format("{:.2f} pixels per degree", options.flip.ppd));
    }
    if (figures.errors && asked.flip_hdr)
        lines.emplace_back("exposures", fmt::format("{} from {:.4f} to {:.4f} EV", figures.flip.exposures.count,
                                                    figures.flip.exposures.start_ev, figures.flip.exposures.stop_ev));
    if (figures.pixels && asked.mse)
        add("mse", figures.pixels->mse);
    if (figures.pixels && asked.rel_mse)
        add("rel-mse", figures.pixels->rel_mse);
    if (figures.pixels && asked.psnr)
        lines.emplace_back("psnr", std::isfinite(figures.pixels->psnr) ? fmt::format("{:.2f} dB", figures.pixels->psnr)
                                                                       : "infinite: the colours are equal");
    if (figures.ssim)
        add("ssim", *figures.ssim);
    if (figures.pixels && asked.max) {
        add("max", figures.pixels->max_abs);
        lines.emplace_back("differing", fmt::format("{:.4f} % of the pixels", 100.0 * figures.pixels->differing_fraction));
    }
    if (figures.pattern && figures.pattern->pixels == 0)
        lines.emplace_back("pattern", "no pixel lies inside a surface");
    if (figures.pattern && figures.pattern->pixels > 0) {
        const PatternFigures& p = *figures.pattern;
        const std::string period = p.period > 0.0 ? fmt::format("period of {:.1f} pixels along {}: {:.2f} %", p.period,
                                                                p.along_y ? "y" : "x", 100.0 * p.period_rms)
                                                  : "no period";
        lines.emplace_back("pattern", fmt::format("{:.2f} % of luminance inside surfaces; {}", 100.0 * p.rms, period));
        lines.emplace_back("steps",
                           fmt::format("between quads over within: {} along x, {} along y; at tile borders over elsewhere: {}, {}",
                                       ratio(p.quad_ratio[0]), ratio(p.quad_ratio[1]), ratio(p.tile_ratio[0]), ratio(p.tile_ratio[1])));
    }
    if (figures.z)
        lines.emplace_back("z-test", fmt::format("largest |z| {:.3f}, limit {:.3f}, {} pixels rejected", figures.z->largest,
                                                 figures.z->limit, figures.z->rejected));
    return lines;
}

} // namespace burnish
