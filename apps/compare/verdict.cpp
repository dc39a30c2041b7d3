#include "apps/compare/verdict.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/cli/field_options.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/report/assets.h"
#include "apps/report/html.h"
#include "apps/report/json.h"

namespace burnish {
namespace {

constexpr std::pair<const char*, std::optional<double> CompareOptions::*> kLimits[] = {{"fail_flip", &CompareOptions::fail_flip},
                                                                                       {"fail_flicker", &CompareOptions::fail_flicker},
                                                                                       {"fail_max", &CompareOptions::fail_max},
                                                                                       {"fail_fraction", &CompareOptions::fail_fraction},
                                                                                       {"fail_pattern", &CompareOptions::fail_pattern}};

Json limits_json(const CompareOptions& options)
{
    Json limits = Json::object();
    for (const auto& [name, member] : kLimits)
        if (options.*member)
            limits[name] = *(options.*member);
    if (!options.variances.empty())
        limits["fail_z"] = options.fail_z;
    return limits;
}

const char* verdict_word(const Status& verdict)
{
    return verdict ? "passed" : verdict.error().code == ExitCode::differ ? "differs" : "failed";
}

// Returns the reason with the option whose limit is exceeded, and with the file if another than the test is at fault.
std::string reason_of(const std::string& test, const Error& error)
{
    std::string reason = (error.place.empty() ? "" : error.place + ": ") + error.reason;
    return error.file.empty() || error.file == test ? reason : error.file + ": " + reason;
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

Status check_limits(const CompareOptions& options, const CompareFigures& figures)
{
    const auto differ = [&](const std::string& place, const std::string& reason) {
        return Error{ExitCode::differ, options.test, place, reason};
    };
    if (options.fail_flip && figures.errors && figures.errors->mean > *options.fail_flip)
        return differ("--fail-flip", fmt::format("FLIP's mean {:.6g} is more than {:.6g}", figures.errors->mean, *options.fail_flip));
    if (options.fail_max && figures.pixels && figures.pixels->max_abs > *options.fail_max)
        return differ("--fail-max",
                      fmt::format("a channel differs by {:.6g}, more than {:.6g}", figures.pixels->max_abs, *options.fail_max));
    if (options.fail_fraction && figures.pixels && figures.pixels->differing_fraction > *options.fail_fraction)
        return differ("--fail-fraction", fmt::format("{:.6g} of the pixels differ, more than {:.6g}", figures.pixels->differing_fraction,
                                                     *options.fail_fraction));
    if (options.fail_pattern && figures.pattern && figures.pattern->pixels == 0)
        return differ("--fail-pattern", "no pixel lies inside a surface");
    if (options.fail_pattern && figures.pattern && figures.pattern->rms > *options.fail_pattern)
        return differ("--fail-pattern",
                      fmt::format("pattern's RMS {:.6g} is more than {:.6g}", figures.pattern->rms, *options.fail_pattern));
    if (figures.z && figures.z->rejected_fraction > options.fail_z)
        return differ("--variance", fmt::format("the z-test rejects {:.6g} of the pixels, more than {:.6g}", figures.z->rejected_fraction,
                                                options.fail_z));
    return {};
}

} // namespace

Status judge_pictures(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures)
{
    return figures.nan_pixels ? Status(not_finite_error(options, figures, pictures)) : check_limits(options, figures);
}

Json verdict_json(const CompareOptions& options, const Status& verdict)
{
    const Json limits = limits_json(options);
    const bool judged = !verdict || !limits.empty();
    return {{"reference", options.reference},
            {"test", options.test},
            {"verdict", judged ? Json(verdict_word(verdict)) : Json()},
            {"reason", verdict ? Json() : Json(reason_of(options.test, verdict.error()))},
            {"limits", limits}};
}

JunitCase verdict_case(const std::string& name, const Status& verdict)
{
    if (verdict)
        return {name, JunitCase::Outcome::passed, ""};
    const bool differs = verdict.error().code == ExitCode::differ;
    return {name, differs ? JunitCase::Outcome::failure : JunitCase::Outcome::error, reason_of(name, verdict.error())};
}

std::string compare_junit(const std::vector<JunitCase>& cases)
{
    return junit_text("burnish compare", "compare", cases);
}

std::string verdict_html(const CompareOptions& options, const Status& verdict)
{
    if (!verdict)
        return fmt::format("<p class=\"verdict bad\"><strong>Fails.</strong> {}.</p>\n", escaped(reason_of(options.test, verdict.error())));
    const Json limits = limits_json(options);
    if (limits.empty())
        return "<p class=\"verdict\">No limit was given.</p>\n";
    std::string names;
    for (const auto& [name, value] : limits.items()) {
        std::string option = "--" + name;
        option[option.find('_')] = '-';
        names += (names.empty() ? "" : ", ") + fmt::format("{} {:g}", option, value.get<double>());
    }
    return fmt::format("<p class=\"verdict\"><strong>Passes.</strong> Limits: {}.</p>\n", escaped(names));
}

std::string failure_page(const CompareOptions& options, const Error& error)
{
    const std::string title = escaped(options.reference + " and " + options.test);
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>{0}</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>{1}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n"
        "<p class=\"verdict bad\"><strong>Fails.</strong> The comparison failed, and there are no figures.</p>\n<p>{2}</p>\n"
        "</main>\n</body>\n</html>\n",
        title, kChartPageStyle.bytes, escaped(line_of(error)));
}

int fails_unread(const CompareOptions& options, const Error& error)
{
    const Json json = verdict_json(options, error);
    for (const auto& [path, text] : {std::pair{options.json, json_text(json, 2) + "\n"},
                                     {options.csv, csv_text(Json::array({json}))},
                                     {options.junit, compare_junit({verdict_case(options.test, error)})},
                                     {options.html, failure_page(options, error)}})
        if (!path.empty() && error.code != ExitCode::usage)
            if (const Status written = write_text(path, text); !written)
                fail(written.error());
    return fail(error);
}

} // namespace burnish
