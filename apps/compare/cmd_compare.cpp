// `burnish compare`: compares a picture with its reference. Reports metrics, an error map, a page and an exit code.
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "apps/cli/command.h"
#include "apps/cli/field_options.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/compare/displayed.h"
#include "apps/compare/figures.h"
#include "apps/compare/folders.h"
#include "apps/compare/options.h"
#include "apps/compare/verdict.h"
#include "apps/live/live.h"
#include "apps/render/rows.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(8- and 16-bit pictures are sRGB and compared by LDR-FLIP; float pictures (exr, hdr, pfm) are linear and compared
by HDR-FLIP. Without a --fail option the exit code says only whether the pictures could be compared.

Of two folders, the pictures of equal relative paths are compared.

Where one picture alone has alpha, alpha must be 1 everywhere. Colours are compared then, and a note says so.

Exit codes: 0 compared, 1 differ by more than a --fail option or the z-test allows, 2 wrong option, 3 size or channels
do not match, 4 unreadable or missing picture, 6 NaN or Inf in a picture, 7 output not written.

Examples:
  burnish compare reference.png test.png
  burnish compare reference.exr test.exr --metric flip-hdr,rel-mse --json -
  burnish compare reference.png test.png --error-map error.png --html report.html
  burnish compare reference.exr test.exr --fail-flip 0.02 --fail-max 0.5
  burnish compare expected/ actual/ --fail-flip 0.01 --junit junit.xml --csv figures.csv
  burnish compare --sequence reference_%04d.exr test_%04d.exr --fail-flicker 0.002 --csv frames.csv
  burnish compare reference.exr test.exr --second-reference other_seed.exr
  burnish compare reference.exr test.exr --html report.html --live "lamp.glb --technique auto --size 640x360"
  burnish compare mean.exr test.exr --variance variance.exr --significance 0.01)";

// Returns each output path with its option.
std::vector<std::pair<std::string, std::string>> outputs_of(const CompareOptions& options)
{
    std::vector<std::pair<std::string, std::string>> outputs;
    for (const auto& [option, path] : {std::pair{"--json", options.json},
                                       {"--csv", options.csv},
                                       {"--junit", options.junit},
                                       {"--html", options.html},
                                       {"--error-map", options.error_map}})
        if (!path.empty())
            outputs.emplace_back(option, path);
    return outputs;
}

Status check_paths(const CompareOptions& options)
{
    const auto outputs = outputs_of(options);
    for (const auto& [option, path] : outputs) {
        const Status status = option == "--error-map" ? check_picture_path(path, compare_inputs(options))
                                                      : check_text_path(option, path, compare_inputs(options));
        BN_TRY(status);
    }
    if (!options.second_reference.empty() && same_file(options.second_reference, options.reference))
        return usage_error("--second-reference", "is the reference itself: take one with another seed");
    for (std::size_t i = 0; i < outputs.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (same_file(outputs[i].second, outputs[j].second))
                return Error{ExitCode::usage, outputs[i].second, "", "is given twice as an output"};
    return {};
}

Status write_error_map(const std::string& path, const Image& error)
{
    return write_image(path, stores_floats(path) ? error : magma_map(error));
}

// Returns false where the picture at `path` cannot be what the page draws: another size, other pixels. Of formats that lose something, only
// the size counts.
bool shows(const LiveParts& parts, const Image& picture, const std::string& path, const DrawRequest& request)
{
    if (picture.width != request.width || picture.height != request.height)
        return false;
    const std::string ending = extension_of(path);
    if (ending != "exr" && ending != "pfm" && ending != "png")
        return true;
    if (picture.type == PixelType::f32) {
        BandHash hash(picture.width, picture.height);
        if (picture.channels >= 3)
            hash.add(picture);
        return picture.channels >= 3 && hash.value() == parts.hash;
    }
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(parts.picture.data());
    const Result<Image> drawn = decode_image(bytes, parts.picture.size(), "picture", Limits());
    return !drawn || drawn->channels != picture.channels || drawn->bytes == picture.bytes; // one picture's alpha may be left out
}

// Returns the scripts that draw TEST anew in the page. Warns if they draw another picture.
Result<std::string> live_html(const CompareOptions& options, const Pictures& pictures, Report& report)
{
    if (options.live.empty())
        return std::string();
    const std::optional<std::vector<std::string>> words = split_words(options.live);
    if (!words)
        return usage_error("--live", "a quote does not end");
    const Result<std::optional<DrawRequest>> request = live_request(*words);
    if (!request)
        return usage_error("--live", line_of(request.error()));
    if (!*request)
        return usage_error("--live", "has an option that reads or writes a file, or that is none of a page's");
    LiveWish wish{{{"0", **request}}, options.renderer, options.limits, options.threads};
    Result<LiveParts> parts = live_parts(wish);
    BN_TRY(parts);
    if (!parts->left_out.empty())
        return parts->left_out.front().second;
    if (!shows(*parts, pictures.test, options.test, **request))
        report.warning(fmt::format("--live draws another picture than {}", options.test));
    return std::move(parts->html);
}

Status write_page(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures, const std::string& live,
                  const Status& verdict)
{
    if (figures.nan_pixels)
        return write_text(options.html, failure_page(options, verdict.error()));
    const ComparePage top{options.reference + " and " + options.test, verdict_html(options, verdict), live};
    const Result<std::string> page = compare_page(top, options, figures, pictures);
    return page ? write_text(options.html, *page) : Status(page.error());
}

// Tries every output even after one fails. Returns the first failure. For pictures with NaN only texts are written: there are no errors to
// show, and the page holds none.
Status write_outputs(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures, const std::string& live,
                     const Status& verdict, Report& report)
{
    Json json = verdict_json(options, verdict);
    json.update(compare_json(options, figures));
    Status first;
    for (const auto& [option, path] : outputs_of(options)) {
        const std::string_view kind = option;
        if (figures.nan_pixels && kind == "--error-map")
            continue;
        const Status status = kind == "--json"    ? write_text(path, json_text(json, 2) + "\n")
                              : kind == "--csv"   ? write_text(path, csv_text(Json::array({json})))
                              : kind == "--junit" ? write_text(path, compare_junit({verdict_case(options.test, verdict)}))
                              : kind == "--html"  ? write_page(options, figures, pictures, live, verdict)
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
    if (options.folders)
        return compare_folders(options);
    const Jobs jobs(options.threads);
    const Result<Pictures> pictures = read_pictures(options, jobs);
    if (!pictures)
        return fails_unread(options, pictures.error());
    Report report(options.quiet, options.verbosity);
    report.promise_stdout({options.json, options.csv, options.junit, options.html});
    report.release();
    for (const std::string& warning : pictures->warnings)
        report.warning(warning);
    if (!pictures->note.empty())
        report.event("note", pictures->note);
    report.detail("pictures", describe(pictures->reference));

    const Result<std::string> live = live_html(options, *pictures, report);
    if (!live)
        return fail(live.error());
    const CompareFigures figures = compare_pictures(options, *pictures, jobs);
    for (const auto& [name, value] : figure_lines(options, figures))
        report.figure(name, value);
    const Status verdict = judge_pictures(options, figures, *pictures);
    const Status written = write_outputs(options, figures, *pictures, *live, verdict, report);
    const int code = verdict ? 0 : fail(verdict.error());
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
