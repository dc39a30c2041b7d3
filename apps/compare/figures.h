// The metrics of `burnish compare`, and their output as text, JSON and page.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/compare/options.h"
#include "apps/report/json.h"
#include "core/image/metrics/metrics.h"
#include "core/image/metrics/pattern.h"
#include "core/image/metrics/z_scores.h"

namespace burnish {

struct Pictures {
    Image reference, test;
    std::optional<Image> second_reference;
    std::vector<Image> variances;
    std::vector<std::string> warnings; // guesses of the image readers
    std::string note;                  // on alpha, if only one of the two has alpha
};

struct CompareFigures {
    Metrics asked;
    int width = 0, height = 0;
    std::int64_t nan_pixels = 0; // above 0: nothing else is computed
    FlipResult flip;
    std::optional<ErrorSummary> errors; // summary for `flip`
    std::optional<PixelFigures> pixels;
    std::optional<double> ssim;
    std::optional<PatternFigures> pattern;
    std::optional<ZTest> z;
};

// Reads all pictures of the options, in parallel, and checks that they can be compared.
Result<Pictures> read_pictures(const CompareOptions& options, const Jobs& jobs);
std::vector<std::string> compare_inputs(const CompareOptions& options);

CompareFigures compare_pictures(const CompareOptions& options, const Pictures& pictures, const Jobs& jobs);

// Returns {width, height, flip_mean, ...}: the requested metrics. Null for a metric without a value (psnr of equal pictures, all metrics
// of pictures with NaN).
Json compare_json(const CompareOptions& options, const CompareFigures& figures);

// Returns name and value for people, one metric a line.
std::vector<std::pair<std::string, std::string>> figure_lines(const CompareOptions& options, const CompareFigures& figures);

// A page: verdict and further HTML above the pictures. live: scripts that draw the test anew, under the key "0"; may be empty.
struct ComparePage {
    std::string title, top, live{};
};

// Returns a self-contained page: REFERENCE, TEST and the error map side by side, without other files or network.
Result<std::string> compare_page(const ComparePage& page, const CompareOptions& options, const CompareFigures& figures,
                                 const Pictures& pictures);

} // namespace burnish
