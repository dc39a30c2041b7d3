#include "apps/chart_keeper.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "core/base/file.h"
#include "core/image/image_io.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxKeptBytes = 256ull << 20;
constexpr std::chrono::milliseconds kSaveEvery{300};

Status make_folder(const std::string& folder)
{
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (!fs::is_directory(folder))
        return Error{ExitCode::output_failed, folder, "", failed ? failed.message() : "is not a folder"};
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{ExitCode::output_failed, folder, "", std::strerror(errno)};
    return {};
}

} // namespace

Result<Keeper> Keeper::open(const std::string& folder, Report& report)
{
    Keeper keeper;
    keeper.folder_ = folder;
    for (const std::string& needed : {folder, folder + "/pictures"})
        if (const Status made = make_folder(needed); !made)
            return made.error();
    const std::string path = keeper.file("rows.json");
    if (!fs::exists(path))
        return keeper;
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMaxKeptBytes);
    if (!bytes)
        return bytes.error();
    Result<KeptRows> rows = parse_kept(std::string(bytes->begin(), bytes->end()), path);
    if (rows)
        keeper.rows_ = std::move(*rows);
    else
        report.warning(fmt::format("{}: {}: everything is measured anew", path, rows.error().reason));
    return keeper;
}

Status Keeper::save()
{
    saved_ = Clock::now();
    return write_file(file("rows.json"), kept_json(rows_));
}

Status Keeper::save_sometimes()
{
    return Clock::now() - saved_ < kSaveEvery ? Status() : save();
}

} // namespace burnish
