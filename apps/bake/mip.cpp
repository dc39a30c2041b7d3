#include "apps/bake/mip.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "apps/bake/mip_textures.h"
#include "apps/cli/command.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/values.h"
#include "apps/cli/words.h"
#include "apps/pieces/given.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/jobs/jobs.h"
#include "raster/frame/colours.h"
#include "shading/bake/mip/pyramid_file.h"
#include "shading/lang/tables.h"

namespace burnish {

namespace {

std::byte mip_code(float unit)
{
    return static_cast<std::byte>(static_cast<int>(std::clamp(unit, 0.0f, 1.0f) * 255.0f + 0.5f));
}

// Returns the base colour, metalness and height maps of all materials, without duplicates.
struct MaterialMap {
    const Material* material;
    UsedMap map;
    MapId id;
};
std::vector<MaterialMap> all_maps(const Scene& scene, const SceneMips& mips, const Jobs& jobs)
{
    std::vector<MaterialMap> maps;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        for (const UsedMap& map : used_maps(scene, m, mips.of(i))) {
            const MapId id = map_id(scene, m, map, jobs);
            if (std::none_of(maps.begin(), maps.end(), [&](const MaterialMap& there) { return there.id == id; }))
                maps.push_back({&m, map, id});
        }
    }
    return maps;
}

Preview preview_of(const Scene& scene, const MaterialLevels& levels)
{
    std::vector<std::string> materials;
    for (const Material& m : scene.materials)
        materials.push_back(m.name);
    const std::vector<std::string> names = plain_names(materials);
    Preview all;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const auto here = levels.begin() + static_cast<std::ptrdiff_t>(i);
        if (!levels[i] || std::find(levels.begin(), here, levels[i]) != here)
            continue;
        for (PreviewPicture& picture : mip_pictures(names[i], *levels[i]))
            all.push_back(std::move(picture));
    }
    return all;
}

// Filters the levels of some materials, or of all, with one progress bar a material.
MaterialLevels levels_of_materials(const Scene& scene, const SceneMips& mips, const Jobs& jobs, bool quiet,
                                   const std::vector<bool>* wanted = nullptr)
{
    std::optional<Progress> progress;
    std::size_t told = 0;
    return filtered_levels(
        scene, mips, jobs,
        [&](std::size_t done, std::size_t all) {
            if (done < told) // of the next material
                progress.reset(), told = 0;
            if (!progress)
                progress.emplace("texels", all, quiet);
            progress->step(done - told);
            told = done;
        },
        wanted);
}

std::size_t texels_of(const Scene& scene, std::size_t material)
{
    const MipSource source = mip_source(scene, scene.materials[material]);
    return static_cast<std::size_t>(source.width()) * static_cast<std::size_t>(source.height());
}

// Returns true for levels of equal maps, which a file holds once.
bool same(const MipLevels& a, const MipLevels& b)
{
    return a.source == b.source && a.gained == b.gained && mip_file_bytes({{&a}, 0, {}}) == mip_file_bytes({{&b}, 0, {}});
}

// A piece holds the levels of one material, as a pyramid file. Materials with equal maps share a piece.
std::vector<JobPiece> material_pieces(const MipBake& bake, const Scene& scene, const SceneMips& mips, const Jobs& jobs)
{
    const std::string text = text_of_given(bake.given);
    const auto rate = std::make_shared<std::optional<double>>(); // seconds a texel, by the material with the fewest
    std::vector<JobPiece> pieces;
    std::size_t fewest = 0, fewest_texels = std::numeric_limits<std::size_t>::max();
    for (const std::size_t i : filtered_materials(scene, mips))
        if (const std::size_t texels = texels_of(scene, i); texels < fewest_texels)
            fewest = i, fewest_texels = texels;
    for (const std::size_t i : filtered_materials(scene, mips)) {
        const std::uint64_t source = mip_source(scene, scene.materials[i]).hash(jobs);
        const std::string key = piece_key(fmt::format("mip {:016x} {}{}", source, is_metal(scene, scene.materials[i]), text));
        if (std::any_of(pieces.begin(), pieces.end(), [&](const JobPiece& there) { return there.key == key; }))
            continue;
        const auto levels = [&scene, &mips, &jobs](std::size_t of) {
            std::vector<bool> wanted(scene.materials.size());
            wanted[of] = true;
            return levels_of_materials(scene, mips, jobs, true, &wanted)[of];
        };
        const auto seconds = [levels, rate, fewest, fewest_texels, texels = texels_of(scene, i)]() -> Result<double> {
            if (!*rate) {
                const double begin = wall_ms();
                levels(fewest);
                *rate = (wall_ms() - begin) * 1e-3 / static_cast<double>(fewest_texels);
            }
            return **rate * static_cast<double>(texels);
        };
        const auto make = [levels, key, i](const std::string& file) -> Status {
            const std::shared_ptr<const MipLevels> made = levels(i);
            return write_piece(file, key, mip_file_bytes({{made.get()}, 0, {}}));
        };
        pieces.push_back({key, seconds, make});
    }
    return pieces;
}

// Lets the scene's filters find the levels that the pieces hold.
Status take_levels(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces, SceneMips& mips)
{
    auto all = std::make_shared<MipFile>();
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        Result<MipFile> file = parse_mip_file(*content, files[i]);
        BN_TRY(file);
        std::move(file->materials.begin(), file->materials.end(), std::back_inserter(all->materials));
    }
    mips.cached = std::move(all);
    return {};
}

const char* name_filter(MipFilter filter)
{
    return mip_filters()[static_cast<std::size_t>(filter)].name;
}

// Checks the options that need no file.
Status check_mip_bake(const MipBake& bake)
{
    const MipArguments& a = bake.options;
    if (bake.material.empty())
        return usage_error("PICTURE", "is needed: a scene, or a folder of a material's pictures");
    if (!makes_lobes(a.filter))
        return usage_error("--mip-filter", fmt::format("{} makes no levels of lobes", name_filter(a.filter)));
    if (bake.output.empty())
        return usage_error("-o", "is needed");
    const bool pyramid = a.format == MipFormat::pyramid;
    if (!pyramid && !bake.preview.empty() && same_file(bake.preview, bake.output))
        return usage_error("--preview", "is the folder of -o, whose textures it could write over");
    if (pyramid)
        BN_TRY(check_text_path("-o", bake.output, {bake.material}));
    if (!pyramid)
        BN_TRY(check_folder_path(bake.output));
    if (!bake.preview.empty())
        BN_TRY(check_folder_path(bake.preview));
    return {};
}

MipSettings choose_mip_settings(const MipArguments& a)
{
    MipSettings mips;
    mips.filter = a.filter;
    mips.couple_albedo = a.couple_albedo, mips.kaiser_colours = a.color_kernel == ColourKernel::kaiser;
    mips.net = a.net, mips.fallback = a.fallback, mips.brdf = a.brdf, mips.gains = a.gains;
    if (a.kappa)
        mips.kappa = static_cast<float>(*a.kappa);
    return mips;
}

// Opens the scene, or a sphere with the material from a folder of pictures.
Result<std::shared_ptr<const SceneData>> open_baked_scene(const MipBake& bake, const Jobs& jobs)
{
    MaterialOverrides overrides;
    std::error_code none;
    const bool is_folder = std::filesystem::is_directory(bake.material, none);
    if (is_folder)
        overrides.material = bake.material;
    return open_scene(is_folder ? "builtin:sphere" : bake.material, bake.limits, overrides, choose_mip_settings(bake.options), {}, {}, {},
                      &jobs);
}

// Lists or makes pieces, and returns the exit code. For a merge, takes the pieces' levels into `mips` and returns nothing.
std::optional<int> run_mip_pieces(const MipBake& bake, const Scene& scene, SceneMips& mips, const Jobs& jobs, Report& report)
{
    const std::vector<JobPiece> pieces = material_pieces(bake, scene, mips, jobs);
    if (!bake.pieces.merge)
        return run_pieces(bake.pieces, command_words(), pieces, report);
    const auto files = finished_pieces(bake.pieces, command_words(), pieces);
    if (!files)
        return fail(files.error());
    if (const Status taken = take_levels(*files, pieces, mips); !taken)
        return fail(taken.error());
    return {};
}

// Returns the materials' levels, without duplicates.
std::vector<const MipLevels*> collect_levels(const MaterialLevels& levels)
{
    std::vector<const MipLevels*> each;
    for (const std::shared_ptr<const MipLevels>& of : levels)
        if (of && std::none_of(each.begin(), each.end(), [&](const MipLevels* there) { return there == of.get() || same(*there, *of); }))
            each.push_back(of.get());
    return each;
}

Status write_pyramid(const std::string& output, const SceneData& data, const std::vector<const MipLevels*>& each, const Jobs& jobs,
                     Report& report)
{
    const Scene& scene = data.scene;
    const std::vector<MaterialMap> maps = all_maps(scene, data.mips, jobs);
    const auto levels_of = [&](std::size_t i) { return map_levels(scene, *maps[i].material, maps[i].map, maps[i].id, jobs); };
    BN_TRY(write_mip_file(output, {each, maps.size(), levels_of}));
    report.release();
    report.wrote(output);
    return {};
}

Status write_textures(const MipBake& bake, const SceneData& data, const MaterialLevels& levels, const Jobs& jobs, Report& report)
{
    const Result<WrittenTextures> written = write_mip_textures(bake.output, data, levels, bake.options, jobs);
    BN_TRY(written);
    report.release();
    for (const std::string& file : written->files)
        report.detail("wrote", file);
    report.event("wrote", fmt::format("{}: {}", bake.output, counted(written->files.size(), "file")));
    report.figures(written->figures);
    return {};
}

} // namespace

Value lobe_value(int& to)
{
    std::vector<std::string> names;
    for (int lobe = 0; lobe < kLobeCount; ++lobe)
        names.emplace_back(lobe_model(lobe).name);
    return value_detail::name(
        names, [&to](std::size_t i) { to = static_cast<int>(i); }, [&to] { return static_cast<std::size_t>(to); });
}

std::vector<std::string> plain_names(const std::vector<std::string>& materials)
{
    constexpr std::size_t kMostLetters = 100; // a file name has at most 255 bytes
    std::vector<std::string> names;
    std::set<std::string> taken;
    std::map<std::string, int> last;
    for (const std::string& material : materials) {
        std::string plain = material.empty() ? "material" : material.substr(0, kMostLetters);
        for (char& c : plain)
            if (!std::isalnum(static_cast<unsigned char>(c)))
                c = '_';
        std::string name = plain;
        for (int& i = last[plain]; !taken.insert(name).second;)
            name = fmt::format("{}_{}", plain, (i = std::max(i, 1) + 1));
        names.push_back(name);
    }
    return names;
}

Preview mip_pictures(const std::string& material, const MipLevels& levels)
{
    Preview pictures;
    for (std::size_t l = 0; l < levels.levels.size(); ++l) {
        const MipLevel& level = levels.levels[l];
        Image normals = make_image(level.width, level.height, 3, PixelType::u8), lobes = normals;
        for (std::size_t i = 0; i < level.texels.size(); ++i) {
            const MipTexel& t = level.texels[i];
            const float z = std::sqrt(std::max(1.0f - (t.nx * t.nx + t.ny * t.ny), 0.0f));
            const float normal[3] = {0.5f + 0.5f * t.nx, 0.5f + 0.5f * t.ny, 0.5f + 0.5f * z};
            const float lobe[3] = {std::sqrt(t.b), std::sqrt(t.a), 0.5f - 0.5f * t.c / std::sqrt(t.a * t.b)}; // M_xx is b
            for (std::size_t c = 0; c < 3; ++c)
                normals.bytes[3 * i + c] = mip_code(normal[c]), lobes.bytes[3 * i + c] = mip_code(lobe[c]);
        }
        pictures.push_back({fmt::format("{}_normal_{:02}", material, l + 1), std::move(normals)});
        pictures.push_back({fmt::format("{}_lobe_{:02}", material, l + 1), std::move(lobes)});
    }
    return pictures;
}

MipArguments::MipArguments() : filter(kMipFilter_kappa) {}

std::vector<Option> mip_options(MipArguments& to)
{
    std::vector<std::string> names;
    for (const MipFilterInfo& filter : mip_filters())
        names.emplace_back(filter.name);
    return {{"--mip-filter", "NAME", "Filter that makes the levels: {}", choice(to.filter, names)},
            {"--mip-kappa", "K",
             "For the kappa filter, and for taps under mipnet and teacher: share of the normals' covariance that widens lobes, {}",
             number(to.kappa, 0.0, kMostKappa), fmt::format("{}", kDefaultMipKappa).c_str()},
            {"--mip-net", "FILE", "For the mipnet and teacher filters: weights from burnish train mip", file(to.net),
             "the program's own for --brdf"},
            {"--fallback", "NAME", "For the mipnet filter: {}; auto takes kappa or baseline for materials where the net is worse",
             choice(to.fallback, {"auto", "off"})},
            {"--mip-gain", "NAME",
             "For the ssgt, kappa, mipnet and teacher filters: {}; on scales each level's colours to reflect as much lamp light as "
             "the finest level",
             choice(to.gains, {"off", "on"})},
            {"--couple", "NAME", "Weights of base colours and metalness: none, or albedo (texels that face light and eye weigh more)",
             choice(to.couple_albedo, {"none", "albedo"})},
            {"--color-kernel", "NAME", "Averaging kernel for base colours and metalness: {}", choice(to.color_kernel, {"box", "kaiser"})}};
}

int run_mip(const MipBake& bake)
{
    const MipArguments& a = bake.options;
    if (const Status options = check_mip_bake(bake); !options)
        return fail(options.error());
    const Jobs jobs(bake.threads);
    const auto data = open_baked_scene(bake, jobs);
    if (!data)
        return fail(data.error());
    const Scene& scene = (*data)->scene;
    // Check the output again, with the scene's own files as inputs
    std::vector<std::string> inputs = scene.files;
    inputs.push_back(bake.material);
    const bool pyramid = a.format == MipFormat::pyramid;
    if (pyramid)
        if (const Status path = check_text_path("-o", bake.output, inputs); !path)
            return fail(path.error());
    Report report(bake.quiet, bake.verbosity);
    for (const std::string& warning : scene.warnings)
        report.warning(warning);
    if (a.gains && !takes_gains(a.filter))
        report.warning(fmt::format("--mip-gain has no effect with --mip-filter {}", name_filter(a.filter)));
    const double begin_ms = wall_ms();
    SceneMips scene_mips = (*data)->mips;
    if (any_pieces(bake.pieces))
        if (const std::optional<int> code = run_mip_pieces(bake, scene, scene_mips, jobs, report))
            return *code;
    const MaterialLevels levels = levels_of_materials(scene, scene_mips, jobs, bake.quiet);
    const std::vector<const MipLevels*> each = collect_levels(levels);
    if (each.empty())
        return fail({ExitCode::bad_input, bake.material, "", "has no maps of normals, roughness or anisotropy"});
    report.event("levels",
                 fmt::format("of {} by {} in {:.0f} ms", counted(each.size(), "material"), name_filter(a.filter), wall_ms() - begin_ms));
    // Make the preview before writing anything
    Preview preview;
    if (!bake.preview.empty())
        preview = preview_of(scene, levels);
    inputs.push_back(bake.output);
    if (const Status fits = check_preview(bake.preview, preview, inputs); !fits)
        return fail(fits.error());
    const Status made =
        pyramid ? write_pyramid(bake.output, **data, each, jobs, report) : write_textures(bake, **data, levels, jobs, report);
    if (!made)
        return fail(made.error());
    if (const Status written = write_preview(bake.preview, preview, report); !written)
        return fail(written.error());
    return 0;
}

} // namespace burnish
