// `burnish golden`: makes pictures, compares them with golden ones, and lets people bless changes.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>

#include "apps/cli/command.h"
#include "apps/cli/lab.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/golden/golden_report.h"
#include "apps/golden/result_folder.h"
#include "apps/live/live.h"
#include "apps/options/options.h"
#include "apps/pieces/words.h"
#include "apps/report/json.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"
#include "core/image/metrics/metrics.h"
#include "core/jobs/cores.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter =
    R"~(check MANIFEST.json: makes the manifest's pictures and compares them with their goldens. check EXPECTED ACTUAL: compares two folders,
or the files of two quoted patterns with one * in the file name.
bless: takes over new pictures of the last check that differ or have no golden; with --from, only those of the list.
merge FOLDER...: joins the results of shards; the files are those of one run.

A manifest is a JSON object. "rows" lists pictures:
  {"name": "pot", "scene": "builtin:teapot", "options": ["--size", "320x180"]}      drawn by burnish render
  {"name": "page", "command": ["node", "draw.js"], "picture": "out/page.png"}       drawn by any program
  {"name": "old", "picture": "out/old.exr"}                                         there already
Rows may have "hold", limits in place of equal values: {"flip": MEAN, "flip_p99": F, "pattern": RMS, "z": SHARE}. "operations": N beside
them limits a frame's float operations, a count that is equal on every machine. "mask" is a picture whose black pixels do not count.
"keep": "hash" makes the golden a hash. Further members: "seconds" (300), "environment" (variables), "format" of
scenes (png), "golden" (goldens/NAME.png). "defaults" holds the same members, and "options" of scenes. Paths are relative to the manifest, and
programs run beside it.

The results' folder gets index.html with the differences, results.jsonl, junit.xml, summary.md, all new pictures and the programs' output. On
GitHub, annotations and the step's summary are written too.

Exit codes, the gravest first: 4 a picture could not be made or the manifest is wrong, 6 a picture holds NaN or Inf, 1 a picture differs,
5 a golden is missing, or a shard to merge, 0 all passed.

Examples:
  burnish golden check goldens.json
  burnish golden check goldens.json --jobs 4 --shard 2/3 -o shard-2
  burnish golden merge shard-1 shard-2 shard-3 -o golden-results
  burnish golden bless goldens.json --from bless.txt
  burnish golden check expected actual --flip 0.01
  burnish golden check 'out/*_golden.png' 'out/*_now.png' --mask mask.png)~";

enum class What { check, bless, merge };

struct GoldenArguments {
    What what = What::check;
    std::vector<std::string> paths;
    std::string results = "golden-results", from, shard, mask;
    GoldenLimits limits; // of folders and patterns, as is the mask
    int jobs = 0;
    bool live = false;    // the page draws rows that differ anew
    std::string renderer; // for the page; empty: beside the program
    Limits input;
    bool quiet = false;
    int verbosity = 0;
};

bool is_folder(const std::string& path)
{
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

// Reads the manifest, or the names in two folders or by two patterns.
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

void sort_by_name(std::vector<GoldenResult>& results)
{
    std::sort(results.begin(), results.end(), [](const GoldenResult& a, const GoldenResult& b) { return a.name < b.name; });
}

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

// Writes the reports, also for GitHub, and puts all files into place. Returns the exit code. live: as golden_page() takes it.
int conclude(std::vector<GoldenResult> results, const std::string& live, NewResults& fresh, const GoldenArguments& arguments,
             Report& report)
{
    sort_by_name(results);
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

// Returns this command without its shard, its folder and its number of jobs.
std::vector<std::string> words_of_shard()
{
    const std::vector<std::string> words = without_pieces(kept_words());
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool apart = words[i] == "-o" || words[i] == "--output" || words[i] == "--jobs";
        if (apart)
            ++i;
        else if (!words[i].starts_with("-o") && !words[i].starts_with("--output=") && !words[i].starts_with("--jobs="))
            kept.push_back(words[i]);
    }
    return kept;
}

int check(const GoldenArguments& arguments, Report& report)
{
    const Result<Share> shard = arguments.shard.empty() ? Result<Share>(Share()) : parse_share(arguments.shard);
    if (!shard)
        return fail(shard.error());
    if (arguments.live)
        if (const Status found = check_renderer(arguments.renderer); !found)
            return fail(found.error());
    Result<GoldenManifest> manifest = manifest_at(arguments);
    if (!manifest)
        return fail(manifest.error());
    std::vector<GoldenRow> rows;
    for (std::size_t i = 0; i < manifest->rows.size(); ++i)
        if (shard->holds(i))
            rows.push_back(manifest->rows[i]);
    std::vector<std::string> inputs = arguments.paths;
    for (const GoldenRow& row : manifest->rows)
        for (const std::string& path : {row.golden, row.mask, row.kind == GoldenKind::picture ? row.picture : std::string()})
            if (!path.empty())
                inputs.push_back((fs::path(manifest->folder) / path).string());
    NewResults fresh(arguments.results);
    if (const Status made =
            fresh.make(inputs, {*shard, manifest_hash(*manifest), shard->count > 1 ? words_of_shard() : std::vector<std::string>()});
        !made)
        return fail(made.error());
    report.release();
    std::signal(SIGCHLD, SIG_DFL); // an ignored signal would hide how programs end
    // Make and judge the rows
    GoldenSetting setting;
    setting.results = fresh.folder(), setting.limits = arguments.input, setting.stop = &watch_stop_signals();
    std::error_code ignored;
    setting.program = fs::read_symlink("/proc/self/exe", ignored).string();
    const int wanted = arguments.jobs > 0 ? arguments.jobs : usable_cores();
    const Jobs side_by_side(std::max(1, std::min(wanted, static_cast<int>(rows.size()))));
    std::vector<GoldenResult> results(rows.size());
    Progress progress("golden pictures", rows.size(), arguments.quiet);
    side_by_side.parallel_for(rows.size(), [&](std::size_t i, int) {
        const Jobs jobs(1);
        results[i] = check_row(*manifest, rows[i], setting, jobs);
        progress.step();
    });
    if (*setting.stop)
        return 128 + stop_signal();
    const std::string live = arguments.live ? live_html(results, *manifest, arguments, report) : "";
    return conclude(std::move(results), live, fresh, arguments, report);
}

// Reads names, one a line, as they are or as JSON texts.
Result<std::set<std::string>> read_list(const std::string& path)
{
    constexpr std::uint64_t kMostListBytes = 64ull << 20;
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostListBytes);
    BN_TRY(bytes);
    std::set<std::string> names;
    const std::string text(bytes->begin(), bytes->end());
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string line = text.substr(begin, end - begin);
        if (!line.empty() && line.back() == '\r')
            line.pop_back();
        const Json json = line.starts_with('"') ? Json::parse(line, nullptr, false) : Json();
        if (!line.empty())
            names.insert(json.is_string() ? json.get<std::string>() : line);
        begin = end + 1;
    }
    return names;
}

// Writes bytes unless the file holds them already. Sets `changed`.
Status replace(const std::string& path, const std::vector<std::uint8_t>& bytes, bool& changed)
{
    constexpr std::uint64_t kMostBytes = 1ull << 30;
    if (const Result<std::vector<std::uint8_t>> before = read_file(path, kMostBytes); before && *before == bytes)
        return {};
    if (const fs::path folder = fs::path(path).parent_path(); !folder.empty()) {
        std::error_code failed;
        fs::create_directories(folder, failed);
        if (failed)
            return Error{ExitCode::output_failed, folder.string(), "", failed.message()};
    }
    changed = true;
    return write_file_atomic(path, bytes.data(), bytes.size());
}

// Makes a row's new picture golden. All paths are the manifest's: results may come from somebody else.
Status bless_row(const GoldenRow& row, const std::string& golden, const GoldenArguments& arguments, bool& changed)
{
    constexpr std::uint64_t kMostBytes = 1ull << 30;
    const std::string picture = arguments.results + "/pictures/" + file_stem(row.name) + row.extension;
    PictureNotes notes; // results may come from somebody else
    const Result<Image> image = read_colours(picture, arguments.input, notes);
    BN_TRY(image);
    if (const std::int64_t bad = not_finite_pixels(*image, *image))
        return Error{ExitCode::not_finite, picture, "", fmt::format("{} pixels are NaN or Inf", bad)};
    if (row.hash_alone) {
        const std::string text = golden_hash(*image) + "\n";
        return replace(golden, {text.begin(), text.end()}, changed);
    }
    for (const char* end : {"", ".variance.exr"}) {
        const Result<std::vector<std::uint8_t>> bytes = read_file(picture + end, kMostBytes);
        if (!bytes && *end)
            continue; // there is no variance
        BN_TRY(bytes);
        BN_TRY(replace(golden + end, *bytes, changed));
    }
    return {};
}

std::string not_blessed(const GoldenResult& result)
{
    return printable(fmt::format("'{}' is not blessed: {}", result.name, result.reason));
}

int bless(const GoldenArguments& arguments, Report& report)
{
    const Result<GoldenManifest> manifest = manifest_at(arguments);
    if (!manifest)
        return fail(manifest.error());
    const Result<std::vector<GoldenResult>> results = read_results(arguments.results);
    if (!results)
        return fail(results.error());
    std::map<std::string, const GoldenResult*> by_name;
    for (const GoldenResult& r : *results)
        by_name[r.name] = &r;
    std::set<std::string> chosen;
    std::map<std::string, const GoldenRow*> rows;
    for (const GoldenRow& row : manifest->rows)
        rows[row.name] = &row;
    if (!arguments.from.empty()) {
        const Result<std::set<std::string>> list = read_list(arguments.from);
        if (!list)
            return fail(list.error());
        chosen = *list;
    } else
        for (const GoldenResult& r : *results)
            if (can_bless(r))
                chosen.insert(r.name);
    if (!results->empty() && std::none_of(results->begin(), results->end(), [&](const GoldenResult& r) { return rows.contains(r.name); }))
        return fail(Error{ExitCode::bad_input, arguments.results, "", "holds no row of the manifest: -o names the folder of its check"});
    // Check every name before the first golden changes
    const std::string source = arguments.from.empty() ? arguments.results : arguments.from;
    for (const std::string& name : chosen)
        if (!rows.contains(name))
            return fail(Error{ExitCode::bad_input, source, "", "'" + name + "' is no row of the manifest"});
        else if (by_name.contains(name) && by_name[name]->not_finite)
            return fail(Error{ExitCode::not_finite, source, "", not_blessed(*by_name[name])});
        else if (!by_name.contains(name) || by_name[name]->verdict == GoldenVerdict::failed)
            return fail(Error{ExitCode::bad_input, source, "", "'" + name + "' has no new picture in the last check"});
        else if (by_name[name]->by_operations)
            return fail(Error{ExitCode::bad_input, source, "", "'" + name + "' takes too many operations: the limit is in the manifest"});
    report.release();
    std::size_t count = 0;
    for (const std::string& name : chosen) {
        bool changed = false;
        const GoldenResult& r = *by_name[name];
        const std::string golden = (fs::path(manifest->folder) / rows[name]->golden).string();
        if (const Status done = bless_row(*rows[name], golden, arguments, changed); !done)
            return fail(done.error());
        if (changed)
            report.figure("blessed", printable(fmt::format("{}: {}", golden, r.verdict == GoldenVerdict::missing ? "new" : r.reason)));
        count += changed;
    }
    report.figure("golden", count == 0 ? "nothing to bless" : counted(count, "picture") + " blessed");
    int code = 0;
    if (arguments.from.empty())
        for (const GoldenResult& r : *results)
            if (r.not_finite && rows.contains(r.name))
                code = fail(Error{ExitCode::not_finite, arguments.results, "", not_blessed(r)});
    return code;
}

// Returns a line for a shell that makes a shard. words: as words_of_shard() returns them; none: an empty text.
std::string command_of_shard(const std::vector<std::string>& words, std::size_t shard, std::size_t count)
{
    if (words.empty())
        return "";
    std::vector<std::string> all = {
        "burnish", words[0], words[1], "--shard", fmt::format("{}/{}", shard, count), "-o", fmt::format("shard-{}-of-{}", shard, count)};
    all.insert(all.end(), words.begin() + 2, words.end());
    return shell_words(all) + "\n";
}

int merge(const GoldenArguments& arguments, Report& report)
{
    std::vector<GoldenResult> all;
    std::set<std::string> names;
    std::map<std::size_t, std::size_t> shards; // shards found, by the number of all
    std::set<std::size_t> indices;
    std::string manifest;
    std::vector<std::string> words; // of the shards' command
    for (const std::string& folder : arguments.paths) {
        if (same_file(folder, arguments.results))
            return fail(usage_error("-o", "is one of the folders to merge"));
        if (!is_folder(folder)) // of a shard that died
            continue;
        const Result<std::vector<GoldenResult>> results = read_results(folder);
        if (!results)
            return fail(results.error());
        const Result<ResultOrigin> origin = origin_of_results(folder);
        if (!origin)
            return fail(origin.error());
        if (shards.empty())
            manifest = origin->manifest;
        words = words.empty() ? origin->words : words;
        if (origin->manifest != manifest)
            return fail(Error{ExitCode::bad_input, folder, "", "is made from other rows than " + arguments.paths.front()});
        if (!indices.insert(origin->shard.index).second)
            return fail(Error{ExitCode::bad_input, folder, "",
                              fmt::format("is shard {}/{}, as an earlier folder is", origin->shard.index + 1, origin->shard.count)});
        ++shards[origin->shard.count];
        for (const GoldenResult& r : *results) {
            if (!names.insert(r.name).second)
                return fail(Error{ExitCode::bad_input, folder, "", "'" + r.name + "' is in an earlier folder too"});
            all.push_back(r);
        }
    }
    if (shards.empty())
        return fail(Error{ExitCode::bad_input, arguments.paths.front(), "", "is no folder"});
    const std::size_t count = shards.rbegin()->first;
    if (shards.size() != 1)
        return fail(Error{ExitCode::bad_input, arguments.paths.front(), "",
                          fmt::format("{} of {} shards are given", arguments.paths.size(), count)});
    if (indices.size() < count) {
        for (std::size_t i = 0; i < count; ++i)
            if (!indices.contains(i))
                std::fputs(command_of_shard(words, i + 1, count).c_str(), stdout);
        return fail(Error{ExitCode::golden_missing, arguments.paths.front(), "",
                          fmt::format("{} of {} shards are given{}", indices.size(), count,
                                      words.empty() ? "" : "; standard output has the commands of the others")});
    }
    NewResults fresh(arguments.results);
    if (const Status made = fresh.make(arguments.paths, {Share{}, manifest}); !made)
        return fail(made.error());
    for (const std::string& folder : arguments.paths)
        for (const char* name : {"/pictures", "/goldens", "/shown", "/logs"}) {
            if (!is_folder(folder + name)) // uploads drop empty folders
                continue;
            std::error_code failed;
            fs::copy(folder + name, fresh.folder() + name, fs::copy_options::recursive | fs::copy_options::overwrite_existing, failed);
            if (failed)
                return fail(Error{ExitCode::output_failed, folder + name, "", failed.message()});
        }
    report.release();
    return conclude(std::move(all), "", fresh, arguments, report);
}

int run_golden(const GoldenArguments& arguments, const OptionTable& given)
{
    Report report(arguments.quiet, arguments.verbosity);
    for (const auto& [option, what] : {std::pair{"--from", What::bless},
                                       {"--shard", What::check},
                                       {"--jobs", What::check},
                                       {"--live", What::check},
                                       {"--renderer", What::check}})
        if (given.given(option) && arguments.what != what)
            return fail(usage_error(option, fmt::format("belongs to `golden {}`", what == What::bless ? "bless" : "check")));
    switch (arguments.what) {
    case What::check:
        return check(arguments, report);
    case What::bless:
        return bless(arguments, report);
    case What::merge:
        return merge(arguments, report);
    }
    return 0;
}

OptionTable golden_option_table(GoldenArguments& to)
{
    OptionTable table;
    table.add(
        "", {{"WHAT", "", "{}", choice(to.what, {"check", "bless", "merge"})},
             Option("PATH", "", "A manifest, two folders or patterns of expected and actual pictures, or results to merge", files(to.paths))
                 .must_be_given()});
    table.add("Goldens",
              {{"-o,--output", "FOLDER", "Folder of the results", folder(to.results)},
               {"--jobs", "N", "Pictures made side by side", integer(to.jobs, 1, 1024), "all cores"},
               {"--shard", "I/N",
                "Makes every N-th row alone, from the I-th; auto: as the engine's environment says; merge joins the shards' results",
                text(to.shard), ""},
               {"--live", "", "check: put the renderer into the page, which then draws scenes that differ anew: see burnish export page",
                flag(to.live)},
               {"--renderer", "FOLDER", "With --live: folder of the npm package, with burnish_core.wasm", folder(to.renderer),
                "beside the program"},
               {"--from", "LIST", "File with names of rows to bless, one a line, as the page saves it", file(to.from), ""},
               {"--flip", "MEAN", "Of folders and patterns: mean FLIP that pictures may differ by, {}", number(to.limits.flip, 0.0, 1.0),
                "not a single value"},
               {"--flip-p99", "F", "Of folders and patterns: 99th percentile of FLIP that pictures may have, {}",
                number(to.limits.flip_p99, 0.0, 1.0), ""},
               {"--pattern", "RMS", "Of folders and patterns: RMS of patterns that pictures may have, {}",
                number(to.limits.pattern, 0.0, 100.0), ""},
               {"--mask", "FILE|FOLDER",
                "Of folders and patterns: picture whose black pixels do not count, or a folder of them by the pictures' names",
                file(to.mask), ""},
               quiet_option(to.quiet),
               verbose_option(to.verbosity)});
    table.add("Limits on input", limit_options(to.input));
    return table;
}

} // namespace

Command golden_command()
{
    auto arguments = std::make_shared<GoldenArguments>();
    return {"golden", "Compare many pictures with golden ones, and bless changes", golden_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_golden(*arguments, given); }};
}

} // namespace burnish
