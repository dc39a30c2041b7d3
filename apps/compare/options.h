// The options of `burnish compare`: as given on the command line, then checked.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/metrics/flip.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {

// The requested metrics. Without a choice by the user, the picture format selects LDR- or HDR-FLIP, and `pattern` is left out.
struct Metrics {
    bool flip = false, flip_hdr = false, mse = false, rel_mse = false, psnr = false, ssim = false, max = false, pattern = false;
};

struct CompareOptions {
    std::string reference, test;
    std::optional<Metrics> metrics; // none: all metrics for the pictures' format
    FlipOptions flip;
    std::string json, csv, junit, html, error_map; // empty: no file; "-": standard output, but for error_map
    std::optional<double> fail_flip, fail_max, fail_fraction, fail_pattern;
    std::string second_reference;       // takes the reference's noise out of `pattern`; may be empty
    std::vector<std::string> variances; // the reference's, the test's
    double significance = 0.01, fail_z = 0.0;
    bool sequence = false;      // reference and test are patterns of file sequences
    bool folders = false;       // reference and test are folders
    std::string live, renderer; // options of `burnish render` that drew the test, for the page; the renderer's folder
    std::optional<double> fail_flicker;
    int threads = 0;
    Limits limits;
    bool quiet = false;
    int verbosity = 0;
};

struct CompareArguments {
    CompareOptions plain;
    std::vector<std::string> metrics;
    Isa isa = {};
};

OptionTable compare_option_table(CompareArguments& to);
Result<CompareOptions> check_compare_options(const CompareArguments& arguments, const OptionTable& given);

} // namespace burnish
