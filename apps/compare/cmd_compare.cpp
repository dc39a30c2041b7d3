// `burnish compare`: compares a picture with its reference. Reports metrics, an error map, a page and an exit code.
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/compare/alpha.h"
#include "apps/compare/displayed.h"
#include "apps/compare/figures.h"
#include "apps/compare/options.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(8- and 16-bit pictures are sRGB and compared by LDR-FLIP; float pictures (exr, hdr, pfm) are linear and compared
by HDR-FLIP. Without a --fail option the exit code says only whether the pictures could be compared.

Exit codes: 0 compared, 1 differ by more than a --fail option or the z-test allows, 2 wrong option, 3 size or channels
do not match, 4 unreadable picture, 6 NaN or Inf in a picture, 7 output not written.

Examples:
  burnish compare reference.png test.png
  burnish compare reference.exr test.exr --metric flip-hdr,rel-mse --json -
  burnish compare reference.png test.png --error-map error.png --html report.html
  burnish compare reference.exr test.exr --fail-flip 0.02 --fail-max 0.5
  burnish compare --sequence truth_%04d.exr test_%04d.exr --fail-flicker 0.002 --csv frames.csv
  burnish compare reference.exr test.exr --second-reference other_seed.exr
  burnish compare mean.exr test.exr --variance variance.exr --significance 0.01)";

// Returns each output path with its option.
std::vector<std::pair<std::string, std::string>> outputs_of(const CompareOptions& options)
{
    std::vector<std::pair<std::string, std::string>> outputs;
    for (const auto& [option, path] :
         {std::pair{"--json", options.json}, {"--csv", options.csv}, {"--html", options.html}, {"--error-map", options.error_map}})
        if (!path.empty())
            outputs.emplace_back(option, path);
    return outputs;
}

std::vector<std::string> inputs_of(const CompareOptions& options)
{
    std::vector<std::string> inputs = {options.reference, options.test};
    if (!options.second_reference.empty())
        inputs.push_back(options.second_reference);
    inputs.insert(inputs.end(), options.variances.begin(), options.variances.end());
    return inputs;
}

Status check_paths(const CompareOptions& options)
{
    const auto outputs = outputs_of(options);
    for (const auto& [option, path] : outputs) {
        const Status status =
            option == "--error-map" ? check_picture_path(path, inputs_of(options)) : check_text_path(option, path, inputs_of(options));
        if (!status)
            return status;
    }
    if (!options.second_reference.empty() && same_file(options.second_reference, options.reference))
        return usage_error("--second-reference", "is the reference itself: take one with another seed");
    for (std::size_t i = 0; i < outputs.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (same_file(outputs[i].second, outputs[j].second))
                return Error{ExitCode::usage, outputs[i].second, "", "is given twice as an output"};
    return {};
}

// Refuses pictures of different size or format. 8 and 16 bits match: both are display values.
Status check_match(const std::string& name, const Image& image, const std::string& reference_name, const Image& reference)
{
    const bool floats = image.type == PixelType::f32, reference_floats = reference.type == PixelType::f32;
    if (image.width == reference.width && image.height == reference.height && image.channels == reference.channels &&
        floats == reference_floats)
        return {};
    return Error{ExitCode::size_mismatch, name, "", fmt::format("{}; {} has {}", describe(image), reference_name, describe(reference))};
}

Status check_variance(const std::string& name, const Image& variance, const CompareOptions& options, const Image& reference)
{
    if (reference.type != PixelType::f32)
        return usage_error("--variance", fmt::format("{} does not hold floats", options.reference));
    if (Status match = check_match(name, variance, options.reference, reference); !match)
        return match;
    if (const std::int64_t bad = not_finite_pixels(variance, variance))
        return Error{ExitCode::not_finite, name, "", fmt::format("{} pixels are NaN or Inf", bad)};
    for (std::size_t i = 0; i < variance.bytes.size() / sizeof(float); ++i)
        if (variance.f32()[i] < 0.0f)
            return Error{ExitCode::bad_input, name, fmt::format("value {}", i), "a variance is negative"};
    return {};
}

// Reads files in parallel: decoding a large PNG takes longer than the comparison.
Result<Pictures> read_pictures(const CompareOptions& options, const Jobs& jobs)
{
    const std::vector<std::string> names = inputs_of(options);
    const std::size_t colours = options.second_reference.empty() ? 2 : 3;
    std::vector<Result<Image>> images(names.size(), Result<Image>(Image{}));
    std::vector<PictureNotes> notes(names.size());
    jobs.parallel_for(names.size(), [&](std::size_t i, int) {
        images[i] = i < colours ? read_colours(names[i], options.limits, notes[i]) : read_image(names[i], options.limits, &notes[i]);
    });
    for (const Result<Image>& image : images)
        BN_TRY(image);
    if (images.size() > colours && (notes[0].converted || notes[1].converted))
        return usage_error("--variance", fmt::format("{} has other primaries than Rec.709, and variances cannot be converted",
                                                     names[notes[0].converted ? 0 : 1]));
    Pictures pictures;
    for (std::size_t i = 0; i < names.size(); ++i)
        for (const std::string& warning : notes[i].warnings)
            pictures.warnings.push_back(names[i] + ": " + warning);
    pictures.reference = std::move(*images[0]);
    pictures.test = std::move(*images[1]);
    pictures.note = drop_lone_alpha(pictures.reference, options.reference, pictures.test, options.test);
    BN_TRY(check_match(options.test, pictures.test, options.reference, pictures.reference));
    if (colours > 2) {
        Image& second = pictures.second_reference.emplace(std::move(*images[2]));
        if (second.channels > pictures.reference.channels)
            pictures.note += (pictures.note.empty() ? "" : "; ") +
                             drop_lone_alpha(second, options.second_reference, pictures.reference, options.reference);
        BN_TRY(check_match(options.second_reference, second, options.reference, pictures.reference));
    }
    for (std::size_t i = colours; i < images.size(); ++i) {
        if (pictures.reference.channels == 4 && images[i]->channels == 3 && images[i]->type == PixelType::f32)
            *images[i] = with_alpha(*images[i], [](std::size_t) { return 0.0f; }); // coverage has no noise
        BN_TRY(check_variance(names[i], *images[i], options, pictures.reference));
        pictures.variances.push_back(std::move(*images[i]));
    }
    if (options.metrics && options.metrics->flip_hdr && pictures.reference.type != PixelType::f32)
        return usage_error("--metric",
                           fmt::format("flip-hdr needs float pictures, {} has {}", options.reference, describe(pictures.reference)));
    return pictures;
}

Status write_error_map(const std::string& path, const Image& error)
{
    return write_image(path, stores_floats(path) ? error : magma_map(error));
}

Status write_page(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures)
{
    const Result<std::string> page = compare_page(options, figures, pictures);
    return page ? write_text(options.html, *page) : Status(page.error());
}

// Tries every output even after one fails. Returns the first failure. For pictures with NaN only --json and --csv are written: there are
// no errors to show.
Status write_outputs(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures, Report& report)
{
    Status first;
    for (const auto& [option, path] : outputs_of(options)) {
        if (figures.nan_pixels && option != "--json" && option != "--csv")
            continue;
        const Status status = option == "--json"   ? write_text(path, json_text(compare_json(options, figures), 2) + "\n")
                              : option == "--csv"  ? write_text(path, csv_text(Json::array({compare_json(options, figures)})))
                              : option == "--html" ? write_page(options, figures, pictures)
                                                   : write_error_map(path, figures.flip.error);
        if (status)
            report.wrote(path);
        else if (first)
            first = status;
        else
            fail(status.error());
    }
    return first;
}

Error not_finite_error(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures)
{
    const bool in_reference = not_finite_pixels(pictures.reference, pictures.reference) != 0;
    const bool in_test = not_finite_pixels(pictures.test, pictures.test) != 0;
    if (!in_reference && !in_test)
        return Error{ExitCode::not_finite, options.second_reference, "",
                     fmt::format("{} of {} pixels are NaN or Inf", figures.nan_pixels, std::int64_t{figures.width} * figures.height)};
    return Error{ExitCode::not_finite, in_test ? options.test : options.reference, "",
                 fmt::format("{} of {} pixels are NaN or Inf{}", figures.nan_pixels, std::int64_t{figures.width} * figures.height,
                             in_test && in_reference ? " here or in " + options.reference : std::string())};
}

int run_compare(const CompareArguments& arguments, const OptionTable& given)
{
    const Result<CompareOptions> checked = check_compare_options(arguments, given);
    if (!checked)
        return fail(checked.error());
    const CompareOptions& options = *checked;
    if (Status paths = check_paths(options); !paths)
        return fail(paths.error());
    if (options.sequence)
        return compare_sequences(options);
    const Jobs jobs(options.threads);
    const Result<Pictures> pictures = read_pictures(options, jobs);
    if (!pictures)
        return fail(pictures.error());
    Report report(options.quiet, options.verbosity);
    report.promise_stdout({options.json, options.csv, options.html});
    report.release();
    for (const std::string& warning : pictures->warnings)
        report.warning(warning);
    if (!pictures->note.empty())
        report.event("note", pictures->note);
    report.detail("pictures", describe(pictures->reference));

    const CompareFigures figures = compare_pictures(options, *pictures, jobs);
    for (const auto& [name, value] : figure_lines(options, figures))
        report.figure(name, value);
    const Status written = write_outputs(options, figures, *pictures, report);
    const Status equal = figures.nan_pixels ? Status(not_finite_error(options, figures, *pictures)) : check_limits(options, figures);
    const int code = equal ? 0 : fail(equal.error());
    return written ? code : fail(written.error());
}

} // namespace

Command compare_command()
{
    auto arguments = std::make_shared<CompareArguments>();
    return {"compare", "Say how far a picture is from its reference", compare_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_compare(*arguments, given); }};
}

} // namespace burnish
