#include "apps/chart/chart_checkpoint.h"

#include <filesystem>
#include <fmt/core.h>
#include <vector>

#include "apps/cli/outputs.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxResultsBytes = 256ull << 20;
constexpr std::chrono::milliseconds kSaveEvery{300};

// Returns true for a chart's file name: NAME-NUMBER.svg.
bool is_chart(const std::string& file)
{
    const std::size_t dot = file.rfind('.'), dash = file.rfind('-');
    if (dot == std::string::npos || dash == std::string::npos || dash + 1 >= dot || file.substr(dot) != ".svg")
        return false;
    const std::string name = file.substr(0, dash), number = file.substr(dash + 1, dot - dash - 1);
    return number.find_first_not_of("0123456789") == std::string::npos &&
           (name == "time-flip" || name == "samples-flip" || name == "samples-time" || name.rfind("heat-", 0) == 0);
}

// Returns true for file names of row pictures and reference pictures: KEY-SETTINGS.jpg.
bool is_picture(const std::string& file)
{
    constexpr std::size_t kDigits = 16;
    const std::string prefix = "reference-", key = file.substr(file.rfind(prefix, 0) == 0 ? prefix.size() : 0);
    return key.size() > kDigits && key.find_first_not_of("0123456789abcdef") == kDigits && key[kDigits] == '-' && key.ends_with(".jpg");
}

} // namespace

Result<ChartCheckpoint> ChartCheckpoint::open(const std::string& folder, Report& report)
{
    ChartCheckpoint checkpoint;
    checkpoint.folder_ = folder;
    for (const std::string& needed : {folder, folder + "/pictures"})
        BN_TRY(make_output_folder(needed));
    const std::string path = checkpoint.file("rows.json");
    std::error_code ignored; // read_file() reports the reason
    if (fs::status(path, ignored).type() == fs::file_type::not_found)
        return checkpoint;
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMaxResultsBytes);
    BN_TRY(bytes);
    Result<ChartResults> results = parse_chart_results(std::string(bytes->begin(), bytes->end()), path);
    if (results)
        checkpoint.results_ = std::move(*results);
    else
        report.warning(fmt::format("{}: {}: everything is measured anew", path, results.error().reason));
    return checkpoint;
}

Status ChartCheckpoint::save()
{
    saved_ = Clock::now();
    return write_file(file("rows.json"), chart_results_json(results_));
}

Status ChartCheckpoint::save_sometimes()
{
    return Clock::now() - saved_ < kSaveEvery ? Status() : save();
}

void ChartCheckpoint::remove_stale(const std::set<std::string>& used) const
{
    for (const auto& [folder, ours] : {std::pair{folder_, &is_chart}, std::pair{folder_ + "/pictures", &is_picture}}) {
        std::vector<fs::path> stale;
        std::error_code ignored;
        std::error_code failed;
        for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
            const std::string name = at->path().filename().string();
            if (at->is_regular_file(ignored) && ours(name) && !used.count(folder + "/" + name))
                stale.push_back(at->path());
        }
        for (const fs::path& path : stale)
            fs::remove(path, ignored); // a leftover file does no harm
    }
}

} // namespace burnish
