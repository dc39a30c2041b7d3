#include "apps/golden/check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <system_error>

#include "apps/golden/child.h"
#include "apps/golden/difference.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/image/io/image_io.h"
#include "core/image/metrics/metrics.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostPictureBytes = 1ull << 30, kMostHashBytes = 1024, kMostStatsBytes = 1 << 20;

std::string in_folder(const std::string& folder, const std::string& path)
{
    return (fs::path(folder) / path).string();
}

std::string absolute(const std::string& path)
{
    std::error_code ignored;
    const fs::path whole = fs::absolute(path, ignored);
    return whole.empty() ? path : whole.string();
}

Error bad(std::string reason)
{
    return Error{ExitCode::bad_input, "", "", std::move(reason)};
}

// A file's identity and the time of its last change, which no program can set.
struct FileState {
    bool there = false;
    std::uint64_t inode = 0;
    std::int64_t seconds = 0, nanoseconds = 0;
    bool operator==(const FileState&) const = default;
};

FileState state_of(const std::string& path)
{
    struct stat found = {};
    if (stat(path.c_str(), &found) != 0)
        return {};
    return {true, found.st_ino, found.st_ctim.tv_sec, found.st_ctim.tv_nsec};
}

// Runs the row's program, so that its picture lies at `to`.
Status make_picture(const GoldenManifest& manifest, const GoldenRow& row, const GoldenSetting& setting, const std::string& to,
                    const std::string& log)
{
    ChildRun run;
    run.words = row.command, run.folder = manifest.folder, run.environment = row.environment, run.seconds = row.seconds;
    run.output = absolute(log), run.stop = setting.stop;
    if (row.kind == GoldenKind::scene) {
        run.words.insert(run.words.begin(), setting.program), run.name = "burnish";
        run.words.insert(run.words.end(), {"-q", "-o", absolute(to)});
        if (row.limits.z)
            run.words.insert(run.words.end(), {"--variance", absolute(to) + ".variance.exr"});
        if (row.limits.operations)
            run.words.insert(run.words.end(), {"--count-operations", "--stats", absolute(to) + ".stats.json"});
        run.hidden = absolute(setting.results) + "/";
        return run_child(run);
    }
    // A picture from before the run must not pass for a new one
    const std::string from = in_folder(manifest.folder, row.picture);
    if (row.kind == GoldenKind::command) {
        std::error_code ignored; // the program says so if its folder is missing
        fs::create_directories(fs::path(from).parent_path(), ignored);
        const FileState before = state_of(from);
        BN_TRY(run_child(run));
        const FileState after = state_of(from);
        if (!after.there || after == before)
            return bad(fmt::format("{} wrote no {}", row.command[0], row.picture));
    }
    const Result<std::vector<std::uint8_t>> bytes = read_file(from, kMostPictureBytes);
    if (!bytes)
        return bad(fmt::format("{}: {}", row.picture, bytes.error().reason));
    return write_file_atomic(to, bytes->data(), bytes->size());
}

// Reads a picture, or tells why not in one sentence.
Result<Image> picture_at(const std::string& path, const std::string& name, const Limits& limits)
{
    PictureNotes notes;
    Result<Image> image = read_colours(path, limits, notes);
    if (!image)
        return bad(fmt::format("{}: {}", name, image.error().reason));
    return image;
}

// Judges the picture by a golden that is a hash.
void judge_hash(const GoldenRow& row, const std::string& golden, const Image& picture, GoldenResult& result)
{
    const Result<std::vector<std::uint8_t>> text = read_file(golden, kMostHashBytes);
    if (!text) {
        result.verdict = GoldenVerdict::failed, result.reason = fmt::format("{}: {}", row.golden, text.error().reason);
        return;
    }
    std::string wanted(text->begin(), text->end());
    wanted.erase(std::remove_if(wanted.begin(), wanted.end(), [](char c) { return c == '\n' || c == '\r' || c == ' '; }), wanted.end());
    const std::string now = golden_hash(picture);
    if (now == wanted)
        set_equal(result);
    else
        result.verdict = GoldenVerdict::differs, result.reason = fmt::format("its hash is {}, the golden's {}", now, wanted.substr(0, 16));
}

// Adds the verdict on the float operations that the picture's statistics tell.
void judge_operations(const std::string& stats, double limit, GoldenResult& result)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(stats, kMostStatsBytes);
    const nlohmann::json json = bytes ? nlohmann::json::parse(bytes->begin(), bytes->end(), nullptr, false) : nlohmann::json();
    const auto found = json.is_object() ? json.find("operations") : json.end();
    if (!json.is_object() || found == json.end() || !found->is_number()) {
        result.verdict = GoldenVerdict::failed, result.reason = "its operations are not known: the tile renderer alone counts";
        return;
    }
    result.operations = found->get<double>();
    if (result.operations <= limit)
        return;
    result.by_operations = result.verdict == GoldenVerdict::passed;
    result.reason += fmt::format("{}a frame takes {:.0f} operations, more than {:.0f}: if the work is right, raise the manifest's limit",
                                 result.reason.empty() ? "" : "; ", result.operations, limit);
    if (result.verdict == GoldenVerdict::passed)
        result.verdict = GoldenVerdict::differs;
}

} // namespace

std::string golden_path(const GoldenManifest& manifest, const GoldenRow& row)
{
    return in_folder(manifest.folder, row.golden);
}

bool file_exists(const std::string& path)
{
    std::error_code ignored;
    return fs::exists(path, ignored);
}

const char* verdict_name(GoldenVerdict verdict)
{
    constexpr const char* kNames[] = {"passed", "differs", "missing", "failed"};
    return kNames[static_cast<std::size_t>(verdict)];
}

std::string golden_hash(const Image& image)
{
    const std::int32_t shape[] = {image.width, image.height, image.channels, static_cast<std::int32_t>(image.type)};
    return fmt::format("{:016x}", hash_bytes(image.bytes.data(), image.bytes.size(), hash_bytes(shape, sizeof(shape))));
}

namespace {

// Returns a result with names alone.
GoldenResult name_result(const GoldenManifest& manifest, const GoldenRow& row)
{
    const std::string stem = file_stem(row.name);
    GoldenResult result;
    result.name = row.name, result.golden = golden_path(manifest, row), result.hash_alone = row.hash_alone;
    result.picture = "pictures/" + stem + row.extension;
    if (row.kind != GoldenKind::picture)
        result.log = "logs/" + stem + ".txt";
    return result;
}

// Makes the row's picture and shows the picture for the page. No limit, mask or golden allows NaN. Only an error's reason counts.
Result<Image> make_finite_picture(const GoldenManifest& manifest, const GoldenRow& row, const GoldenSetting& setting, GoldenResult& result)
{
    const std::string stem = file_stem(row.name), results = setting.results + "/";
    std::error_code ignored;
    fs::remove(results + result.picture, ignored);
    if (const Status made = make_picture(manifest, row, setting, results + result.picture, results + "logs/" + stem + ".txt"); !made) {
        const ExitCode code = made.error().code;
        result.not_finite = row.kind == GoldenKind::scene && code == ExitCode::not_finite;
        result.of_machine = code == ExitCode::unavailable || (row.kind == GoldenKind::scene && code == ExitCode::output_failed);
        return made.error();
    }
    Result<Image> picture = picture_at(results + result.picture, row.picture.empty() ? "its picture" : row.picture, setting.limits);
    BN_TRY(picture);
    result.width = picture->width, result.height = picture->height, result.linear = picture->type == PixelType::f32;
    if (const Status written = show(*picture, 0.0f, results + "shown/" + stem + ".png"); !written) {
        result.of_machine = true;
        return bad(written.error().line());
    }
    if (const std::int64_t bad_pixels = not_finite_pixels(*picture, *picture)) {
        result.not_finite = true;
        return bad(fmt::format("{} of {} pixels are NaN or Inf", bad_pixels, std::int64_t{picture->width} * picture->height));
    }
    return picture;
}

// Reads the golden and all that the row's limits need besides. made: path of the row's picture.
Result<DifferenceInput> read_golden(const GoldenManifest& manifest, const GoldenRow& row, const Image& picture, const std::string& made,
                                    const Limits& limits)
{
    const std::string path = golden_path(manifest, row);
    Result<Image> golden = picture_at(path, row.golden, limits);
    BN_TRY(golden);
    DifferenceInput input{std::move(*golden), picture, {}, {}, {}};
    if (!row.mask.empty()) {
        Result<Image> mask = picture_at(in_folder(manifest.folder, row.mask), row.mask, limits);
        BN_TRY(mask);
        input.mask = std::move(*mask);
    }
    if (row.limits.z) {
        Result<Image> of_golden = picture_at(path + ".variance.exr", row.golden + ".variance.exr", limits);
        BN_TRY(of_golden);
        input.golden_variance = std::move(*of_golden);
        if (file_exists(made + ".variance.exr"))
            if (Result<Image> own = picture_at(made + ".variance.exr", "its variance", limits))
                input.variance = std::move(*own);
    }
    return input;
}

// Makes and judges a row as check_row() tells, but for the copy of the golden.
GoldenResult judged_row(const GoldenManifest& manifest, const GoldenRow& row, const GoldenSetting& setting, const Jobs& jobs)
{
    GoldenResult result = name_result(manifest, row);
    const auto fails = [&](const std::string& reason) {
        result.verdict = GoldenVerdict::failed, result.reason = reason;
        return result;
    };
    const Result<Image> picture = make_finite_picture(manifest, row, setting, result);
    if (!picture)
        return fails(picture.error().reason);
    const std::string made = setting.results + "/" + result.picture;
    if (!file_exists(result.golden)) {
        result.verdict = GoldenVerdict::missing, result.reason = fmt::format("there is no golden {}", row.golden);
    } else if (row.hash_alone) {
        judge_hash(row, result.golden, *picture, result);
    } else {
        Result<DifferenceInput> input = read_golden(manifest, row, *picture, made, setting.limits);
        if (!input)
            return fails(input.error().reason);
        judge(row.limits, std::move(*input), jobs, setting.results + "/shown/" + file_stem(row.name), result);
    }
    if (row.limits.operations && result.verdict != GoldenVerdict::failed)
        judge_operations(made + ".stats.json", *row.limits.operations, result);
    std::error_code ignored;
    fs::remove(made + ".stats.json", ignored); // its times are of this run
    return result;
}

} // namespace

GoldenResult check_row(const GoldenManifest& manifest, const GoldenRow& row, const GoldenSetting& setting, const Jobs& jobs)
{
    GoldenResult result = judged_row(manifest, row, setting, jobs);
    if (result.verdict == GoldenVerdict::passed || row.hash_alone || !file_exists(result.golden))
        return result;
    // The page links the golden, and the results' folder may move to another machine
    const std::string copy = "goldens/" + file_stem(row.name) + fs::path(row.golden).extension().string();
    std::error_code failed;
    fs::copy_file(result.golden, setting.results + "/" + copy, fs::copy_options::overwrite_existing, failed);
    if (!failed)
        result.golden_copy = copy;
    return result;
}

} // namespace burnish
