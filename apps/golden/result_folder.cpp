#include "apps/golden/result_folder.h"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <system_error>

#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/golden/check.h"
#include "apps/report/json.h"
#include "core/base/file.h"
#include "core/base/text.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMarker = ".burnish-golden"; // a file in folders of results, whose files alone are replaced
constexpr const char* kReports[] = {"index.html", "results.jsonl", "junit.xml", "summary.md"};

// Returns true if a path lies in a folder, or is it.
bool lies_in(const std::string& path, const std::string& folder)
{
    std::error_code failed;
    const fs::path inner = fs::weakly_canonical(path, failed), outer = fs::weakly_canonical(folder, failed);
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

Status make_empty(const std::string& folder)
{
    std::error_code failed;
    fs::remove_all(folder, failed);
    if (!failed)
        fs::create_directory(folder, failed);
    return failed ? Status(Error{ExitCode::output_failed, folder, "", failed.message()}) : Status();
}

// Moves a file or a folder, if it is there.
Status move_into(const std::string& from, const std::string& to, const char* name)
{
    std::error_code failed;
    fs::rename(from + "/" + name, to + "/" + name, failed);
    if (failed && failed != std::errc::no_such_file_or_directory)
        return Error{ExitCode::output_failed, to + "/" + name, "", failed.message()};
    return {};
}

// Reads a command's words. Returns none for a text that holds no command of a check.
std::vector<std::string> words_of(const std::string& text)
{
    const Json json = Json::parse(text, nullptr, false);
    std::vector<std::string> words;
    for (const Json& word : json.is_array() ? json : Json::array())
        words.push_back(word.is_string() ? word.get<std::string>() : "");
    return words.size() > 2 && words[0] == "golden" && words[1] == "check" ? words : std::vector<std::string>();
}

} // namespace

bool is_result_file(const std::string& path)
{
    const std::size_t slash = path.find('/');
    const std::string name = slash == std::string::npos ? "" : path.substr(slash + 1);
    return !name.empty() && name != "." && name != ".." && name.find_first_of("/\\") == std::string::npos &&
           std::find(std::begin(kResultFolders), std::end(kResultFolders), path.substr(0, slash)) != std::end(kResultFolders);
}

Result<ResultOrigin> origin_of_results(const std::string& folder)
{
    constexpr std::uint64_t kMostMarkerBytes = 1 << 20;
    const Result<std::vector<std::uint8_t>> bytes = read_file(folder + "/" + kMarker, kMostMarkerBytes);
    BN_TRY(bytes);
    const std::string text(bytes->begin(), bytes->end());
    const std::vector<std::string> lines = split(text, '\n');
    const std::string& line = lines.front();
    const std::size_t blank = std::min(line.find(' '), line.size());
    const Result<Share> shard = parse_share(line.substr(0, blank));
    BN_TRY(shard);
    return ResultOrigin{*shard, line.substr(std::min(blank + 1, line.size())), words_of(lines.size() > 2 ? lines[2] : "")};
}

NewResults::~NewResults()
{
    if (!made_)
        return;
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::remove_all(old_, ignored);
}

Status NewResults::make(const std::vector<std::string>& inputs, const ResultOrigin& origin)
{
    for (const std::string& input : inputs)
        if (!input.empty() && lies_in(input, results_))
            return usage_error("-o", fmt::format("'{}' is to be replaced, and holds {}", results_, input));
    std::error_code none;
    const std::string marker = results_ + "/" + kMarker;
    const bool ours = file_exists(marker);
    if (fs::is_directory(results_, none) && !ours && !fs::is_empty(results_, none))
        return usage_error("-o", fmt::format("'{}' holds files, and none of burnish golden", results_));
    BN_TRY(make_output_folder(results_));
    lock_.reset(::open(results_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!lock_)
        return Error{ExitCode::output_failed, results_, "", std::strerror(errno)};
    if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) // file systems without locks take both runs
        return Error{ExitCode::output_failed, results_, "", "another run of burnish golden writes here"};
    const std::string text =
        fmt::format("{}/{} {}\nmade by burnish golden, which replaces these files\n{}", origin.shard.index + 1, origin.shard.count,
                    origin.manifest, origin.words.empty() ? "" : json_text(Json(origin.words), -1) + "\n");
    if (!ours)
        BN_TRY(write_text(marker, text));
    made_ = true;
    BN_TRY(make_empty(folder_));
    for (const char* name : kResultFolders)
        BN_TRY(make_empty(folder_ + "/" + name));
    return write_text(folder_ + "/" + kMarker, text);
}

Status NewResults::take_over()
{
    const Status moved = move_all();
    if (moved)
        return moved;
    for (const auto& names : {std::span<const char* const>(kResultFolders), std::span<const char* const>(kReports)})
        for (const char* name : names)
            if (std::error_code none; fs::exists(old_ + "/" + name, none)) { // bring the earlier results back, as far as they go
                fs::remove_all(results_ + "/" + name, none);
                fs::rename(old_ + "/" + name, results_ + "/" + name, none);
            }
    return moved;
}

Status NewResults::move_all()
{
    // No page stands beside another run's pictures, wherever this stops
    BN_TRY(make_empty(old_));
    for (const char* name : kReports)
        BN_TRY(move_into(results_, old_, name));
    for (const char* name : kResultFolders)
        BN_TRY(move_into(results_, old_, name));
    BN_TRY(move_into(folder_, results_, kMarker));
    for (const char* name : kResultFolders)
        BN_TRY(move_into(folder_, results_, name));
    for (const char* name : kReports)
        BN_TRY(move_into(folder_, results_, name));
    return {};
}

} // namespace burnish
