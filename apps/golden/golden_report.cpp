#include "apps/golden/golden_report.h"

#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>
#include <tuple>

#include "apps/cli/outputs.h"
#include "apps/golden/result_folder.h"
#include "apps/report/html.h"
#include "apps/report/json.h"
#include "apps/report/junit.h"
#include "core/base/file.h"
#include "core/base/text.h"

namespace burnish {
namespace {

constexpr std::uint64_t kMostResultBytes = 256ull << 20;

// Escapes characters with a meaning in GitHub's commands.
std::string annotation_text(const std::string& text, bool in_property)
{
    std::string out;
    for (const char c : text)
        if (c == '%' || c == '\n' || c == '\r' || (in_property && (c == ',' || c == ':')))
            out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        else
            out += c;
    return out;
}

// Escapes Markdown and HTML within a table's cell. A word joiner, which shows nothing, keeps GitHub from making links of addresses, names
// and numbers: of "https://", "www.", "@" and "#".
std::string markdown_text(const std::string& name)
{
    constexpr const char* kJoiner = "&#8288;";
    const std::string text = printable(without_controls(name));
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '.' && i > 0 && (text[i - 1] == 'w' || text[i - 1] == 'W'))
            out += kJoiner;
        if (std::string_view("\\`*_{}[]()#+-!|~@").find(c) != std::string_view::npos)
            out += std::string("\\") + c;
        else
            out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
        if (c == '@' || c == '#' || (c == ':' && i + 1 < text.size() && text[i + 1] == '/'))
            out += kJoiner;
    }
    return out;
}

Json number_or_null(const std::optional<double>& value)
{
    return value ? Json(*value) : Json();
}

std::optional<double> optional_number(const Json& json)
{
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

Json json_of(const GoldenResult& r)
{
    return {{"name", r.name},
            {"verdict", verdict_name(r.verdict)},
            {"reason", r.reason},
            {"width", r.width},
            {"height", r.height},
            {"flip_mean", number_or_null(r.flip)},
            {"flip_p99", number_or_null(r.flip_p99)},
            {"differing_fraction", number_or_null(r.differing)},
            {"max_abs", number_or_null(r.largest)},
            {"operations", r.operations},
            {"golden", r.golden},
            {"picture", r.picture},
            {"log", r.log},
            {"hash_alone", r.hash_alone},
            {"linear", r.linear},
            {"by_operations", r.by_operations},
            {"not_finite", r.not_finite},
            {"golden_copy", r.golden_copy}};
}

GoldenResult result_of(const Json& json)
{
    GoldenResult r;
    r.name = json.at("name").get<std::string>(), r.reason = json.at("reason").get<std::string>();
    const std::string verdict = json.at("verdict").get<std::string>();
    bool known = false;
    for (const GoldenVerdict v : {GoldenVerdict::passed, GoldenVerdict::differs, GoldenVerdict::missing, GoldenVerdict::failed})
        if (verdict == verdict_name(v))
            r.verdict = v, known = true;
    if (!known)
        throw Json::other_error::create(501, "unknown verdict", &json);
    r.width = json.at("width").get<int>(), r.height = json.at("height").get<int>();
    r.flip = optional_number(json.at("flip_mean")), r.flip_p99 = optional_number(json.at("flip_p99"));
    r.differing = optional_number(json.at("differing_fraction")), r.largest = optional_number(json.at("max_abs"));
    r.operations = json.at("operations").get<double>();
    r.golden = json.at("golden").get<std::string>(), r.picture = json.at("picture").get<std::string>();
    r.log = json.at("log").get<std::string>(), r.hash_alone = json.at("hash_alone").get<bool>();
    r.linear = json.at("linear").get<bool>(), r.by_operations = json.at("by_operations").get<bool>();
    r.golden_copy = json.at("golden_copy").get<std::string>(), r.not_finite = json.at("not_finite").get<bool>();
    return r;
}

// Returns the name of the first path that is no file of its folder of results, or "".
std::string outside_path(const GoldenResult& r)
{
    for (const auto& [name, path, folder] :
         {std::tuple<const char*, const std::string&, std::string_view>{"picture", r.picture, "pictures/"},
          {"log", r.log, "logs/"},
          {"golden_copy", r.golden_copy, "goldens/"}}) {
        if (!path.empty() && !(path.starts_with(folder) && is_result_file(path)))
            return name;
    }
    return "";
}

} // namespace

GoldenCounts count_of(const std::vector<GoldenResult>& results)
{
    GoldenCounts counts;
    for (const GoldenResult& r : results)
        switch (r.verdict) {
        case GoldenVerdict::passed:
            ++counts.passed;
            break;
        case GoldenVerdict::differs:
            ++counts.differs;
            break;
        case GoldenVerdict::missing:
            ++counts.missing;
            break;
        case GoldenVerdict::failed:
            ++(r.not_finite ? counts.not_finite : counts.failed);
            break;
        }
    return counts;
}

std::string counts_in_words(const GoldenCounts& counts)
{
    return fmt::format("{} passed, {} differ, {} have no golden, {} could not be made, {} hold NaN or Inf", counts.passed, counts.differs,
                       counts.missing, counts.failed, counts.not_finite);
}

bool can_bless(const GoldenResult& result)
{
    return result.verdict == GoldenVerdict::missing || (result.verdict == GoldenVerdict::differs && !result.by_operations);
}

int exit_code_of(const GoldenCounts& counts)
{
    const ExitCode code = counts.failed       ? ExitCode::bad_input
                          : counts.not_finite ? ExitCode::not_finite
                          : counts.differs    ? ExitCode::differ
                          : counts.missing    ? ExitCode::golden_missing
                                              : ExitCode::ok;
    return static_cast<int>(code);
}

std::string results_text(const std::vector<GoldenResult>& results)
{
    std::string text;
    for (const GoldenResult& r : results)
        text += json_text(json_of(r), -1) + "\n";
    return text;
}

Result<std::vector<GoldenResult>> read_results(const std::string& folder)
{
    const std::string path = folder + "/results.jsonl";
    std::error_code ignored;
    if (std::filesystem::file_size(path, ignored) == 0 && !ignored) // a shard without rows
        return std::vector<GoldenResult>();
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostResultBytes);
    if (!bytes)
        return Error{ExitCode::bad_input, path, "", bytes.error().reason + "; `burnish golden check` writes it"};
    return results_of_text({bytes->begin(), bytes->end()}, path);
}

Result<std::vector<GoldenResult>> results_of_text(const std::string& text, const std::string& path)
{
    std::vector<GoldenResult> results;
    for (std::size_t begin = 0, line = 1; begin < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        try {
            results.push_back(result_of(Json::parse(text.substr(begin, end - begin))));
        } catch (const Json::exception&) {
            return Error{ExitCode::bad_input, path, fmt::format("line {}", line), "is no result of a golden"};
        }
        if (const std::string name = outside_path(results.back()); !name.empty())
            return Error{ExitCode::bad_input, path, fmt::format("line {}", line), "'" + name + "' leaves the folder of results"};
        begin = end + 1;
    }
    return results;
}

std::string golden_junit(const std::vector<GoldenResult>& results)
{
    std::vector<JunitCase> cases;
    for (const GoldenResult& r : results)
        cases.push_back({r.name,
                         r.verdict == GoldenVerdict::passed   ? JunitCase::Outcome::passed
                         : r.verdict == GoldenVerdict::failed ? JunitCase::Outcome::error
                                                              : JunitCase::Outcome::failure,
                         r.reason});
    return junit_text("burnish golden", "golden", cases);
}

std::string golden_summary(const std::vector<GoldenResult>& results)
{
    const GoldenCounts counts = count_of(results);
    std::string text = fmt::format("### Golden pictures: {} of {} passed\n\n", counts.passed, results.size());
    if (counts.passed == results.size())
        return text;
    text += "| picture | verdict | why |\n| --- | --- | --- |\n";
    for (const GoldenResult& r : results)
        if (r.verdict != GoldenVerdict::passed)
            text += fmt::format("| {} | {} | {} |\n", markdown_text(r.name), verdict_name(r.verdict), markdown_text(r.reason));
    return text;
}

std::string golden_annotations(const std::vector<GoldenResult>& results)
{
    std::string text;
    for (const GoldenResult& r : results)
        if (r.verdict != GoldenVerdict::passed)
            text += fmt::format("::error title={}::{}\n", annotation_text("golden " + r.name + " " + verdict_name(r.verdict), true),
                                annotation_text(r.reason, false));
    return text;
}

Status write_reports(const std::vector<GoldenResult>& results, const std::string& folder, const std::string& live)
{
    const Result<std::string> page = golden_page(results, folder, live);
    BN_TRY(page);
    for (const auto& [name, text] : {std::pair<const char*, std::string>{"results.jsonl", results_text(results)},
                                     {"junit.xml", golden_junit(results)},
                                     {"summary.md", golden_summary(results)},
                                     {"index.html", *page}})
        BN_TRY(write_text(folder + "/" + name, text));
    return {};
}

} // namespace burnish
