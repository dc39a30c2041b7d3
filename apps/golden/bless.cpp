// Takes new pictures over as goldens.
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "apps/golden/golden_report.h"
#include "apps/golden/tasks.h"
#include "apps/report/json.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"
#include "core/image/metrics/metrics.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

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

} // namespace

int bless_goldens(const GoldenArguments& arguments, Report& report)
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
    const Result<ResultOrigin> origin = origin_of_results(arguments.results);
    if (!origin)
        return fail(origin.error());
    if (arguments.paths.size() == 1 && origin->manifest != manifest_hash(*manifest))
        return fail(
            Error{ExitCode::bad_input, arguments.results, "", "was made before the manifest's rows changed: run golden check again"});
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

} // namespace burnish
