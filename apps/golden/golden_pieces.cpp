#include "apps/golden/golden_pieces.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <memory>
#include <optional>
#include <system_error>

#include "apps/cli/command_line.h"
#include "apps/cli/shared_options.h"
#include "apps/golden/golden_report.h"
#include "apps/golden/result_folder.h"
#include "apps/options/options.h"
#include "apps/pieces/given.h"
#include "apps/pieces/packed.h"
#include "apps/pieces/words.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/scene/gltf/gltf.h"
#include "core/scene/image_light.h"
#include "core/scene/material_overrides.h"
#include "core/scene/mtlx/mtlx.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kProbes = 3; // rows of a kind that are made for an estimate

// Paths of a row count from the manifest's folder.
class InFolder {
  public:
    explicit InFolder(const std::string& folder) : before_(fs::current_path(ignored_)) { fs::current_path(folder, ignored_); }
    InFolder(const InFolder&) = delete;
    InFolder& operator=(const InFolder&) = delete;
    ~InFolder() { fs::current_path(before_, ignored_); }

  private:
    std::error_code ignored_;
    fs::path before_;
};

// Files that were read for a scene, by the words that name them and limit reading: many rows draw one scene.
using SceneFiles = std::map<std::string, std::vector<std::string>>;

// Returns files that are read for a row's scene, its material and its light. Errors: as where they are read.
Result<std::vector<std::string>> files_of_drawn(const RenderOptions& options)
{
    Result<Scene> scene = load_scene(options.scene, options.limits);
    BN_TRY(scene);
    if (options.overrides.material_is_document())
        BN_TRY(apply_mtlx(*scene, options.overrides.material, options.limits));
    BN_TRY(apply_material_overrides(*scene, options.overrides, options.limits));
    std::vector<std::string> files = std::move(scene->files);
    for (const AreaLight& light : options.lights)
        if (!light.texture_file.empty())
            files.push_back(light.texture_file);
    if (!options.env.starts_with("builtin:") && is_gltf(options.env)) {
        const Result<ImageLight> light = load_image_light(options.env, options.limits);
        BN_TRY(light);
        files.insert(files.end(), light->files.begin(), light->files.end());
    }
    return files;
}

Result<std::string> text_of_drawn(const GoldenRow& row, SceneFiles& scenes)
{
    RenderArguments arguments;
    Command render{"render", "", render_option_table(arguments), "", {}};
    const std::vector<std::string> words(row.command.begin() + 1, row.command.end());
    if (!read_command_line(render, words))
        return std::string(); // the row fails, and its words are in its key
    std::string names;
    for (const Option& option : render.options.options())
        if (option.given && (option.value.kind == ValueKind::file || option.value.kind == ValueKind::folder || option.positional() ||
                             option.name.starts_with("--limit-") || option.name == "--light"))
            names += option.name + " " + shell_words(option.texts) + "\n";
    auto found = scenes.find(names);
    if (found == scenes.end()) {
        Result<std::vector<std::string>> files = files_of_drawn(arguments.plain);
        BN_TRY(files);
        found = scenes.emplace(names, std::move(*files)).first;
    }
    return text_of_given(render.options) + text_of_scene(arguments.plain.scene, found->second);
}

// Returns the limits on input, which refuse pictures, goldens and masks.
std::string text_of_limits(Limits limits)
{
    std::string text;
    for (const Option& option : limit_options(limits))
        text += option.name + " " + option.value.get() + "\n";
    return text;
}

// Returns the content of files that a program's words name.
std::string text_of_program(const GoldenRow& row)
{
    std::vector<std::string> files;
    std::error_code ignored;
    for (const std::string& word : row.command)
        for (const std::string& path : {word, word.substr(std::min(word.find('=') + 1, word.size()))})
            if (fs::is_regular_file(path, ignored))
                files.push_back(path);
    return text_of_scene("program", files);
}

Result<std::string> row_key(const GoldenManifest& manifest, const GoldenRow& row, const Limits& limits, SceneFiles& scenes)
{
    const InFolder inside(manifest.folder);
    std::string text = "golden " + manifest_hash({"", {row}}) + "\n" + text_of_limits(limits);
    for (const std::string& path :
         {row.golden, row.limits.z ? row.golden + ".variance.exr" : "", row.mask, row.kind == GoldenKind::picture ? row.picture : ""})
        text += path.empty() ? "\n" : text_of_scene("", {path});
    if (row.kind == GoldenKind::scene) {
        const Result<std::string> drawn = text_of_drawn(row, scenes);
        BN_TRY(drawn);
        text += *drawn;
    }
    if (row.kind == GoldenKind::command)
        text += text_of_program(row);
    return piece_key(text);
}

// A folder for one row's files, removed with this object.
class RowFolder {
  public:
    explicit RowFolder(std::string folder) : folder_(std::move(folder)) {}
    RowFolder(const RowFolder&) = delete;
    RowFolder& operator=(const RowFolder&) = delete;
    ~RowFolder()
    {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }

    Status make() const
    {
        for (const char* name : kResultFolders) {
            std::error_code failed;
            fs::create_directories(folder_ + "/" + name, failed);
            if (failed)
                return Error{ExitCode::output_failed, folder_, "", failed.message()};
        }
        return {};
    }

  private:
    std::string folder_;
};

// Makes a row in a folder of its own. Returns nothing where a signal stopped the process.
Result<std::optional<Packed>> made_row(const GoldenManifest& manifest, const GoldenRow& row, const GoldenSetting& setting, const Jobs& jobs,
                                       const std::string& scratch)
{
    const RowFolder folder(scratch);
    BN_TRY(folder.make());
    GoldenSetting own = setting;
    own.results = scratch;
    const GoldenResult result = check_row(manifest, row, own, jobs);
    if (setting.stop && *setting.stop)
        return std::optional<Packed>();
    if (result.of_machine)
        return Error{ExitCode::output_failed, row.name, "", result.reason};
    Packed packed{results_text({result}), {}};
    std::vector<std::string> names;
    std::error_code failed;
    for (const char* name : kResultFolders)
        for (fs::directory_iterator at(scratch + "/" + name, failed), end; !failed && at != end; at.increment(failed))
            names.push_back(std::string(name) + "/" + at->path().filename().string());
    if (failed)
        return Error{ExitCode::output_failed, scratch, "", failed.message()};
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
        const bool is_empty = fs::file_size(scratch + "/" + name, failed) == 0 && !failed; // of a program that printed nothing
        Result<std::vector<std::uint8_t>> bytes = is_empty ? std::vector<std::uint8_t>() : take_file(scratch + "/" + name);
        BN_TRY(bytes);
        packed.files.push_back({name, std::move(*bytes)});
    }
    return std::optional(std::move(packed));
}

// Returns the pixels of a drawn row, else 1.
double size_of(const GoldenRow& row)
{
    RenderArguments arguments;
    Command render{"render", "", render_option_table(arguments), "", {}};
    if (row.kind != GoldenKind::scene || !read_command_line(render, {row.command.begin() + 1, row.command.end()}))
        return 1.0;
    return static_cast<double>(arguments.size.width) * arguments.size.height;
}

// Estimates times from a few rows of each kind, of which drawn ones count by their pixels. A program has its limit.
class RowTimes {
  public:
    RowTimes(const GoldenManifest& manifest, const GoldenSetting& setting, const Jobs& jobs)
        : manifest_(manifest), setting_(setting), jobs_(jobs)
    {
    }

    Result<double> seconds(const GoldenRow& row)
    {
        if (row.kind == GoldenKind::command)
            return row.seconds;
        if (!rates_.contains(row.kind))
            BN_TRY(measure(row.kind));
        return rates_[row.kind] * size_of(row);
    }

  private:
    Status measure(GoldenKind kind)
    {
        std::vector<const GoldenRow*> rows;
        for (const GoldenRow& row : manifest_.rows)
            if (row.kind == kind)
                rows.push_back(&row);
        std::error_code failed;
        const std::string scratch = own_name_beside((fs::temp_directory_path(failed) / "burnish").string(), ".estimate");
        double seconds = 0.0, size = 0.0;
        for (std::size_t i = 0; i < std::min(kProbes, rows.size()); ++i) {
            const GoldenRow& row = *rows[(2 * i + 1) * rows.size() / (2 * std::min(kProbes, rows.size()))];
            const double begin = wall_ms();
            const auto made = made_row(manifest_, row, setting_, jobs_, scratch);
            BN_TRY(made);
            seconds += (wall_ms() - begin) * 1e-3, size += size_of(row);
        }
        rates_[kind] = seconds / size;
        return {};
    }

    const GoldenManifest& manifest_;
    const GoldenSetting& setting_;
    const Jobs& jobs_;
    std::map<GoldenKind, double> rates_; // s a pixel or a picture
};

} // namespace

Result<std::vector<JobPiece>> golden_pieces(const GoldenManifest& manifest, const GoldenSetting& setting, const Jobs& jobs)
{
    SceneFiles scenes;
    const auto times = std::make_shared<RowTimes>(manifest, setting, jobs);
    std::vector<JobPiece> pieces;
    for (const GoldenRow& row : manifest.rows) {
        const Result<std::string> found = row_key(manifest, row, setting.limits, scenes);
        BN_TRY(found);
        const std::string key = *found;
        const auto make = [&manifest, &row, &setting, &jobs, key](const std::string& file) -> Status {
            const auto made = made_row(manifest, row, setting, jobs, own_name_beside(file, ".row"));
            BN_TRY(made);
            return *made ? write_piece(file, key, pack(**made)) : Status();
        };
        pieces.push_back({key, [times, &row] { return times->seconds(row); }, make});
    }
    return pieces;
}

Result<std::vector<GoldenResult>> take_golden_pieces(const GoldenManifest& manifest, const std::vector<std::string>& files,
                                                     const std::vector<JobPiece>& pieces, const std::string& folder)
{
    std::vector<GoldenResult> results;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        const Result<Packed> packed = unpack(*content, files[i]);
        BN_TRY(packed);
        Result<std::vector<GoldenResult>> rows = results_of_text(packed->json, files[i]);
        BN_TRY(rows);
        if (rows->size() != 1 || rows->front().name != manifest.rows[i].name)
            return Error{ExitCode::bad_input, files[i], "", "is not the row " + manifest.rows[i].name};
        for (const PackedFile& file : packed->files) {
            if (!is_result_file(file.name))
                return Error{ExitCode::bad_input, files[i], "", "holds a file that leaves the folder of results"};
            BN_TRY(write_file_atomic(folder + "/" + file.name, file.bytes.data(), file.bytes.size()));
        }
        results.push_back(std::move(rows->front()));
        results.back().golden = golden_path(manifest, manifest.rows[i]); // of this machine
    }
    return results;
}

} // namespace burnish
