#include "apps/golden/tasks.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <optional>
#include <utility>

#include "apps/golden/golden_report.h"
#include "apps/live/live.h"
#include "core/base/text.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Returns the request of a scene's row, with its paths seen from here. Returns nothing where no page could draw the row.
std::optional<DrawRequest> request_of(const GoldenRow& row, const std::string& folder)
{
    if (row.kind != GoldenKind::scene || !row.environment.empty())
        return std::nullopt;
    const std::vector<std::string> words(row.command.begin() + 1, row.command.end());
    Result<std::optional<DrawRequest>> read = live_request(words);
    if (!read)
        return std::nullopt;
    std::optional<DrawRequest> request = std::move(*read);
    for (std::string* path : {request ? &request->scene : nullptr, request ? &request->environment : nullptr})
        if (path && !path->empty() && path->rfind("builtin:", 0) != 0)
            *path = (fs::path(folder) / *path).string();
    return request;
}

// Returns the scripts that draw anew the rows that differ.
std::string live_html(const std::vector<GoldenResult>& results, const GoldenManifest& manifest, const GoldenArguments& arguments,
                      Report& report)
{
    constexpr std::size_t kMostRows = 100; // as many as have sliders
    LiveWish wish;
    wish.renderer_folder = arguments.renderer, wish.limits = arguments.input;
    for (const GoldenRow& row : manifest.rows)
        for (const GoldenResult& result : results)
            if (result.name == row.name && result.verdict == GoldenVerdict::differs && wish.rows.size() < kMostRows)
                if (std::optional<DrawRequest> request = request_of(row, manifest.folder))
                    wish.rows.push_back({row.name, std::move(*request)});
    const Result<LiveParts> parts = live_parts(wish);
    if (!parts)
        report.warning("--live: " + parts.error().line());
    for (const auto& [name, error] : parts ? parts->left_out : decltype(parts->left_out)())
        report.warning(fmt::format("--live: the page cannot draw '{}': {}", printable(name), error.line()));
    return parts ? parts->html : "";
}

} // namespace

Result<GoldenManifest> manifest_at(const GoldenArguments& arguments)
{
    if (arguments.paths.size() == 2)
        return manifest_of_pairs(arguments.paths[0], arguments.paths[1], arguments.limits, arguments.mask);
    if (arguments.paths.size() != 1)
        return usage_error("PATH", "is one manifest, or two folders or patterns: the expected pictures and the actual ones");
    for (const auto& [option, is_given] : {std::pair{"--flip", arguments.limits.flip.has_value()},
                                           {"--flip-p99", arguments.limits.flip_p99.has_value()},
                                           {"--pattern", arguments.limits.pattern.has_value()},
                                           {"--mask", !arguments.mask.empty()}})
        if (is_given)
            return usage_error(option, "belongs to folders and patterns; rows of a manifest have their own \"hold\" and \"mask\"");
    return read_manifest(arguments.paths[0]);
}

std::vector<std::string> inputs_of(const GoldenArguments& arguments, const GoldenManifest& manifest)
{
    std::vector<std::string> inputs = arguments.paths;
    for (const GoldenRow& row : manifest.rows)
        for (const std::string& path : {row.golden, row.mask, row.kind == GoldenKind::picture ? row.picture : std::string()})
            if (!path.empty())
                inputs.push_back((fs::path(manifest.folder) / path).string());
    return inputs;
}

int conclude_golden(std::vector<GoldenResult> results, const GoldenManifest* manifest, NewResults& fresh, const GoldenArguments& arguments,
                    Report& report)
{
    std::sort(results.begin(), results.end(), [](const GoldenResult& a, const GoldenResult& b) { return a.name < b.name; });
    const std::string live = manifest && arguments.live ? live_html(results, *manifest, arguments, report) : "";
    if (const Status written = write_reports(results, fresh.folder(), live); !written)
        return fail(written.error());
    if (const Status moved = fresh.take_over(); !moved)
        return fail(moved.error());
    if (on_github())
        report.commands(golden_annotations(results));
    if (const char* summary = std::getenv("GITHUB_STEP_SUMMARY"); summary && *summary)
        if (std::ofstream out(summary, std::ios::app); !(out << golden_summary(results) << std::flush))
            report.warning(fmt::format("the step's summary is not written: {}: {}", summary, std::strerror(errno)));
    for (const GoldenResult& r : results)
        if (r.verdict != GoldenVerdict::passed)
            report.figure(verdict_name(r.verdict), printable(r.name + ": " + r.reason));
    const GoldenCounts counts = count_of(results);
    report.figure("golden", fmt::format("{}; {}/index.html", counts_in_words(counts), arguments.results));
    return exit_code_of(counts);
}

} // namespace burnish
