#include "apps/compare/options.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <system_error>
#include <utility>

#include "apps/cli/numbered.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"

namespace burnish {
namespace {

constexpr std::pair<const char*, bool Metrics::*> kMetrics[] = {
    {"flip", &Metrics::flip}, {"flip-hdr", &Metrics::flip_hdr}, {"mse", &Metrics::mse}, {"rel-mse", &Metrics::rel_mse},
    {"psnr", &Metrics::psnr}, {"ssim", &Metrics::ssim},         {"max", &Metrics::max}, {"pattern", &Metrics::pattern}};

std::vector<std::string> metric_names()
{
    std::vector<std::string> names;
    for (const auto& [name, member] : kMetrics)
        names.emplace_back(name);
    return names;
}

std::vector<Option> figure_rows(CompareArguments& to)
{
    CompareOptions& o = to.plain;
    return {
        {"--metric", "NAMES", "Measures, separated by commas: flip or flip-hdr, mse, rel-mse, psnr, ssim, max, pattern",
         choices(to.metrics, metric_names()), "all that suit the pictures, without pattern"},
        {"--ppd", "N", "FLIP: pixels per degree of the observer's visual field",
         number(o.flip.ppd, static_cast<double>(kMinPpd), static_cast<double>(kMaxPpd)), "67.02"},
        {"--tonemapper", "NAME", "HDR-FLIP: tone curve, {}", choice(o.flip.tonemap, {"aces", "reinhard", "hable"})},
        {"--start-exposure", "EV", "HDR-FLIP: lowest exposure", number(o.flip.start_ev, -kMaxExposure, kMaxExposure),
         "found in the reference"},
        {"--stop-exposure", "EV", "HDR-FLIP: highest exposure", number(o.flip.stop_ev, -kMaxExposure, kMaxExposure),
         "found in the reference"},
        {"--exposures", "N", "HDR-FLIP: number of exposures", integer(o.flip.exposures, 1, kMaxFlipExposures), "one a stop"},
        {"--second-reference", "FILE", "Independent second reference: takes the references' noise out of pattern",
         file(o.second_reference)},
        {"--variance", "FILE",
         "Variance of the reference's pixel means, for a z-test of every pixel, and to take noise out of pattern; a "
         "second one is the test's",
         files(o.variances)},
        {"--sequence", "", "Compare numbered files such as out_%04d.exr, and measure flicker", flag(o.sequence)},
        {"--significance", "P", "z-test: probability of rejecting equal pictures", number(o.significance, 1e-9, 0.5)},
    };
}

std::vector<Option> failure_rows(CompareOptions& to)
{
    return {
        {"--fail-flip", "MEAN", "Fail if FLIP's mean exceeds MEAN", number(to.fail_flip, 0.0, 1.0)},
        {"--fail-flicker", "F", "With --sequence: fail if the test's flicker exceeds the reference's by more than F",
         number(to.fail_flicker, 0.0, 1.0)},
        {"--fail-max", "V", "Fail if a channel differs by more than V", number(to.fail_max, 0.0, 1e38)},
        {"--fail-fraction", "F", "Fail if more than the fraction F of pixels differs", number(to.fail_fraction, 0.0, 1.0)},
        {"--fail-pattern", "V", "Fail if pattern's RMS exceeds V", number(to.fail_pattern, 0.0, 1e6)},
        {"--fail-z", "F", "Fail if the z-test rejects more than the fraction F of pixels", number(to.fail_z, 0.0, 1.0)},
    };
}

std::vector<Option> output_rows(CompareOptions& to)
{
    return {
        {"--json", "FILE", "Write the figures as JSON; - for standard output", file(to.json)},
        {"--csv", "FILE", "Write the figures as a line of names, then a line of values for each picture", file(to.csv)},
        {"--junit", "FILE", "Write the verdict as JUnit XML; of folders: a case for each picture", file(to.junit)},
        {"--html", "FILE", "Write a page with both pictures, the error map and the figures", file(to.html)},
        {"--live", "WORDS",
         "With --html: options of burnish render that drew TEST, as one word. The page then draws it anew: see burnish export page",
         text(to.live), ""},
        {"--renderer", "FOLDER", "With --live: folder of the npm package, with burnish_core.wasm", folder(to.renderer),
         "build/wasm/package"},
        {"--error-map", "FILE", "Write FLIP's errors: in the magma colour map, or as floats (exr, hdr, pfm)", file(to.error_map)},
        quiet_option(to.quiet),
        verbose_option(to.verbosity),
    };
}

Status check_metrics(const std::vector<std::string>& names, CompareOptions& out)
{
    if (names.empty())
        return {};
    out.metrics = Metrics();
    for (const auto& [name, member] : kMetrics)
        (*out.metrics).*member = std::find(names.begin(), names.end(), name) != names.end();
    if (out.metrics->flip && out.metrics->flip_hdr)
        return usage_error("--metric", "flip and flip-hdr are two readings of the same pictures: choose one");
    return {};
}

// Sets `folders` where both names are folders.
Status check_folders(const OptionTable& given, CompareOptions& out)
{
    std::error_code ignored;
    const bool reference = std::filesystem::is_directory(out.reference, ignored), test = std::filesystem::is_directory(out.test, ignored);
    if (reference != test)
        return Error{ExitCode::bad_input, reference ? out.reference : out.test, "",
                     fmt::format("is a folder, and {} is none", reference ? out.test : out.reference)};
    out.folders = reference;
    if (!reference)
        return {};
    if (given.given("--html"))
        return usage_error(
            "--html", fmt::format("is for two pictures: `burnish golden check {} {}` makes a page of folders", out.reference, out.test));
    for (const char* option : {"--variance", "--second-reference", "--error-map"})
        if (given.given(option))
            return usage_error(option, "cannot be combined with folders");
    return {};
}

} // namespace

OptionTable compare_option_table(CompareArguments& to)
{
    OptionTable table, limits;
    limits.add("", limit_options(to.plain.limits));
    table.add("", {Option("REFERENCE", "", "Picture to compare with, or a folder of them", file(to.plain.reference)).must_be_given(),
                   Option("TEST", "", "Picture to judge, or a folder of them", file(to.plain.test)).must_be_given()});
    table.add("Figures", figure_rows(to));
    table.add("Failing (exit code 1)", failure_rows(to.plain));
    table.add("Output", output_rows(to.plain));
    table.add("Machine", {threads_option(to.plain.threads, "Worker threads; never changes a figure"),
                          isa_option(to.isa, "Instruction set: {}; never changes a figure")});
    table.take(limits, "Limits on input",
               {{"--limit-image-side", "Width and height of a picture"},
                {"--limit-texture-bytes", "Size of one picture's decoded pixels"},
                {"--limit-file-bytes", "Size of one file"}});
    return table;
}

Result<CompareOptions> check_compare_options(const CompareArguments& in, const OptionTable& given)
{
    CompareOptions out = in.plain;
    BN_TRY(check_metrics(in.metrics, out));
    if (out.flip.start_ev && out.flip.stop_ev && *out.flip.start_ev > *out.flip.stop_ev)
        return usage_error("--stop-exposure", "is below --start-exposure");
    if (given.given("--live") && (out.html.empty() || out.sequence))
        return usage_error("--live", out.sequence ? "cannot be combined with --sequence" : "needs --html");
    if (given.given("--renderer") && !given.given("--live"))
        return usage_error("--renderer", "needs --live");
    if (out.variances.size() > 2)
        return usage_error("--variance", "is given more than twice: once for REFERENCE, once for TEST");
    for (const char* option : {"--significance", "--fail-z"})
        if (out.variances.empty() && given.given(option))
            return usage_error(option, "needs --variance");
    if (out.sequence) {
        for (const auto& [name, pattern] : {std::pair{"REFERENCE", out.reference}, {"TEST", out.test}})
            if (!has_number(pattern))
                return usage_error(name, fmt::format("'{}' needs a number such as %04d with --sequence", pattern));
        for (const char* option : {"--variance", "--second-reference", "--error-map", "--fail-max", "--fail-fraction", "--fail-pattern"})
            if (given.given(option))
                return usage_error(option, "cannot be combined with --sequence");
        if (out.metrics && !out.metrics->flip && !out.metrics->flip_hdr)
            return usage_error("--metric", "--sequence takes flip or flip-hdr");
    } else if (out.fail_flicker) {
        return usage_error("--fail-flicker", "needs --sequence");
    } else {
        BN_TRY(check_folders(given, out));
    }
    const Result<Isa> isa = choose_isa(given, in.isa);
    BN_TRY(isa);
    out.flip.isa = *isa;
    return out;
}

} // namespace burnish
