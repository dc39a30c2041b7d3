// The figures of `burnish compare`, and what is made of them: text, JSON, a page, a verdict.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/compare/options.h"
#include "apps/report/json.h"
#include "core/image/metrics/metrics.h"
#include "core/image/metrics/z_scores.h"

namespace burnish {

struct Pictures {
    Image reference, test;
    std::vector<Image> variances;
    std::vector<std::string> warnings; // what their readers had to guess
    std::string note;                  // on alpha, where only one of the two has it
};

struct CompareFigures {
    Metrics asked;
    int width = 0, height = 0;
    std::int64_t nan_pixels = 0; // any: nothing else is computed
    FlipResult flip;
    std::optional<ErrorSummary> errors; // of flip
    std::optional<PixelFigures> pixels;
    std::optional<double> ssim;
    std::optional<ZTest> z;
};

CompareFigures compare_pictures(const CompareOptions& options, const Pictures& pictures, const Jobs& jobs);

// {width, height, flip_mean, ...}: what was asked for, null where a figure has no value (psnr of equal
// pictures, everything about pictures with NaN).
Json compare_json(const CompareOptions& options, const CompareFigures& figures);

// Name and value for people to read, a figure a line.
std::vector<std::pair<std::string, std::string>> figure_lines(const CompareOptions& options, const CompareFigures& figures);

// An Error with ExitCode::differ that names the first limit that is passed.
Status check_limits(const CompareOptions& options, const CompareFigures& figures);

// A page that needs no other file and no network. REFERENCE, TEST and the error map side by side.
Result<std::string> compare_page(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures);

} // namespace burnish
