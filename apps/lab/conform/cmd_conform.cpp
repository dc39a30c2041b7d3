// `burnish conform`: writes a conformance folder, or judges an engine's pictures of its scenes.
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <optional>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/cli/words.h"
#include "apps/lab/conform/draw.h"
#include "apps/lab/conform/folder.h"
#include "apps/lab/conform/judge.h"
#include "apps/lab/conform/page.h"
#include "apps/lab/conform/pictures.h"
#include "apps/lab/conform/scenes.h"
#include "apps/pieces/packed.h"
#include "apps/pieces/pieces.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "shading/lab/conform/mutated.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(conform --write DIR makes scenes as glTF files, their environment and the reference's pictures of them. DIR/README.md says how an engine
draws them. conform DIR PICTURES then compares the engine's pictures with the reference's, and names the mistakes that explain the difference.

Exit codes: 0 every picture is right; 1 a picture is wrong or missing; 4 one cannot be read, or has another size; 6 one holds NaN or
infinities.

Examples:
  burnish conform --write conform
  burnish conform conform pictures --html conform.html --junit conform.xml)";

struct ConformArguments {
    std::string folder, pictures, write, html, json, junit;
    std::vector<std::string> without, mistakes;
    std::string technique = right_ways().front().name;
    PieceOptions pieces;
    bool draw = false;
    int samples = 1024, threads = 0, verbosity = 0;
    bool quiet = false;
    Limits limits;
};

constexpr const char* kExposed = "exposure"; // a stop too much; judged by its amount, so no mutant

std::vector<std::string> mistake_names()
{
    std::vector<std::string> names;
    for (const Mutant& mutant : mutants())
        names.emplace_back(mutant.name);
    names.emplace_back(kExposed);
    return names;
}

// Returns the right ways, then the techniques.
const std::vector<std::string>& drawing_names()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const RightWay& way : right_ways())
            all.emplace_back(way.name);
        for (const TechniqueInfo& technique : techniques())
            all.emplace_back(technique.name);
        return all;
    }();
    return names;
}

// Mistakes of the bent normal of KHR_materials_anisotropy.
constexpr std::uint32_t kOfGltfBend = mutant_bit(KernelMutant::bend_factor) | mutant_bit(KernelMutant::bend_across) |
                                      mutant_bit(KernelMutant::no_bend) | mutant_bit(KernelMutant::mean_width);

bool is_gltf(const std::string& way)
{
    return way.rfind("gltf", 0) == 0;
}

std::string ways_in_words()
{
    std::vector<std::string> names;
    for (const RightWay& way : right_ways())
        names.emplace_back(way.name);
    return join(names);
}

OptionTable conform_option_table(ConformArguments& to)
{
    OptionTable table;
    table.add("",
              {{"DIR", "", "Conformance folder", text(to.folder), "none"},
               {"PICTURES", "", "Folder of the engine's pictures: NAME.exr, .hdr, .pfm or .png for each scene", text(to.pictures), "none"},
               {"--without", "NAME,...", "Leave out scenes, which the engine cannot draw", choices(to.without, scene_names())}});
    table.add("Write", {{"--write", "DIR", "Write a conformance folder", folder(to.write)},
                        {"--samples", "N", "Samples a pixel of the reference's pictures, {}", integer(to.samples, 64, 65536)}});
    table.add("Judge", {{"--html", "FILE", "Page with pictures, error maps and mistakes", file(to.html)},
                        {"--json", "FILE", "Results as JSON; - for standard output", file(to.json)},
                        {"--junit", "FILE", "Results as JUnit XML; - for standard output", file(to.junit)}});
    table.add("Draw", {{"--draw", "", "Draw the scenes into PICTURES by burnish, in place of judging them", flag(to.draw)},
                       {"--mistake", "NAME,...", "With mistakes that engines make, to see what they look like",
                        choices(to.mistakes, mistake_names())},
                       {"--technique", "NAME", "Technique: {}", choice(to.technique, drawing_names())}});
    table.add("Output", {quiet_option(to.quiet), verbose_option(to.verbosity)});
    table.add("Pieces, for several processes", piece_options(to.pieces));
    table.add("Machine", {threads_option(to.threads)});
    table.add("Limits", limit_options(to.limits));
    return table;
}

Status check_conform_arguments(const ConformArguments& a, const OptionTable& given)
{
    if (a.write.empty() && a.folder.empty())
        return usage_error("DIR", "no conformance folder is given; --write makes one");
    if (!a.write.empty())
        for (const char* other : {"DIR", "PICTURES", "--without", "--html", "--json", "--junit", "--draw"})
            if (given.given(other))
                return usage_error(other, "does not go with --write");
    if (a.write.empty() && a.pictures.empty())
        return usage_error("PICTURES", "no folder of pictures is given");
    BN_TRY(check_piece_options(a.pieces));
    if (a.write.empty() && any_pieces(a.pieces))
        return usage_error("--write", "is what has pieces");
    if (a.write.empty() && given.given("--samples"))
        return usage_error("--samples", "needs --write");
    for (const char* option : {"--mistake", "--technique"})
        if (!a.draw && given.given(option))
            return usage_error(option, "needs --draw");
    if (!a.mistakes.empty() && find_technique(a.technique))
        return usage_error("--technique",
                           fmt::format("{} is drawn without mistakes alone; {} are drawn with them", a.technique, ways_in_words()));
    if (a.without.size() >= conform_scenes().size())
        return usage_error("--without", "leaves no scene");
    if (a.write.empty() && same_file(a.pictures, a.folder))
        return usage_error("PICTURES", "is the conformance folder: give a folder of its own");
    for (const char* references : kReferenceFolders)
        if (same_file(a.pictures, a.folder + "/" + references))
            return usage_error("PICTURES", "is the folder of references");
    for (const std::string& name : a.mistakes)
        for (const Mutant& mutant : mutants())
            if (mutant.name == name && mutant.kernels != 0 && (mutant.kernels & kOfGltfBend) != 0 && !is_gltf(a.technique))
                return usage_error("--mistake", fmt::format("{} is a mistake of --technique gltf", name));
    for (const char* option : {"--html", "--json", "--junit"})
        if (a.draw && given.given(option))
            return usage_error(option, "does not go with --draw");
    std::vector<std::string> inputs = {a.folder + "/conform.json", a.folder + "/environment.exr", a.folder + "/environment.hdr"};
    ConformFolder folder = conform_folder(a.folder);
    for (const char* references : kReferenceFolders) {
        folder.references = references;
        for (const FolderScene& scene : folder.scenes)
            inputs.insert(inputs.end(), {a.folder + "/" + scene.file, folder.reference_of(scene.name), folder.variance_of(scene.name)});
    }
    for (const char* name : {"/README.md", "/pages/three.html", "/pages/babylon.html", "/pages/pictures.js"})
        inputs.push_back(a.folder + name);
    for (const std::string& name : scene_names())
        for (const char* extension : kPictureExtensions)
            inputs.push_back(a.pictures + "/" + name + extension);
    return check_outputs({}, {{"--html", a.html}, {"--json", a.json}, {"--junit", a.junit}}, inputs);
}

// Draws a scene's reference into a piece: its picture and its variance.
Status write_reference_piece(ConformDrawer& drawer, std::size_t scene, std::uint64_t samples, const std::string& file,
                             const std::string& key)
{
    const std::atomic<bool>& stop = watch_stop_signals();
    const Result<ConformDrawer::ReferencePicture> reference = drawer.reference(scene, samples, &stop);
    BN_TRY(reference);
    if (stop.load())
        return {};
    Packed packed;
    for (const auto& [name, image] : {std::pair{"color", &reference->color}, {"variance", &reference->variance}}) {
        const std::string own = own_name_beside(file, ".exr");
        BN_TRY(write_image(own, *image));
        Result<std::vector<std::uint8_t>> bytes = take_file(own);
        BN_TRY(bytes);
        packed.files.push_back({name, std::move(*bytes)});
    }
    return write_piece(file, key, pack(packed));
}

// Returns the references of a folder as pieces. drawer: makes them; null for a merge.
std::vector<JobPiece> conform_pieces(const ConformArguments& a, const ConformFolder& folder, ConformDrawer* drawer = nullptr)
{
    const auto samples = static_cast<std::uint64_t>(a.samples);
    const auto rate = std::make_shared<std::optional<double>>();
    std::vector<JobPiece> pieces;
    for (std::size_t i = 0; i < folder.scenes.size(); ++i) {
        const std::string key = piece_key(fmt::format("conform {} {}", folder.scenes[i].name, samples)); // the build makes the scenes
        const auto seconds = [drawer, rate, samples]() -> Result<double> {
            constexpr std::uint64_t kProbe = 64;
            const double begin = wall_ms();
            if (!*rate) {
                BN_TRY(drawer->reference(0, kProbe, nullptr));
                *rate = (wall_ms() - begin) * 1e-3 / static_cast<double>(kProbe);
            }
            return **rate * static_cast<double>(samples);
        };
        pieces.push_back({key, seconds, [drawer, i, samples, key](const std::string& file) {
                              return write_reference_piece(*drawer, i, samples, file, key);
                          }});
    }
    return pieces;
}

// Writes the references of a folder from their pieces.
Status take_references(const ConformFolder& folder, const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        const Result<Packed> packed = unpack(*content, files[i]);
        BN_TRY(packed);
        if (packed->files.size() != 2)
            return Error{ExitCode::bad_input, files[i], "", "is a damaged piece"};
        const std::string paths[] = {folder.reference_of(folder.scenes[i].name), folder.variance_of(folder.scenes[i].name)};
        for (std::size_t k = 0; k < 2; ++k)
            BN_TRY(write_file_atomic(paths[k], packed->files[k].bytes.data(), packed->files[k].bytes.size()));
    }
    return {};
}

// Lists or makes references as pieces, by scenes in a folder of its own.
int make_references(const ConformArguments& a, Report& report)
{
    namespace fs = std::filesystem;
    std::error_code ignored;
    const std::string scenes = own_name_beside((fs::temp_directory_path(ignored) / "burnish-conform").string(), "");
    const auto made = [&]() -> Result<int> {
        BN_TRY(write_conform_files(scenes));
        const ConformFolder folder = conform_folder(scenes);
        Result<ConformDrawer> drawer = ConformDrawer::open(folder, a.limits, std::make_shared<const Jobs>(a.threads));
        BN_TRY(drawer);
        return run_pieces(a.pieces, command_words(), conform_pieces(a, folder, &*drawer), report);
    }();
    fs::remove_all(scenes, ignored);
    return made ? *made : fail(made.error());
}

int write_folder(const ConformArguments& a, Report& report)
{
    if (!reference_available())
        return fail(Error{ExitCode::unavailable, "", "", "this program was built without Embree 3, which makes the references"});
    if (any_pieces(a.pieces) && !a.pieces.merge)
        return make_references(a, report);
    if (a.pieces.merge) // before a file is written
        if (const auto files = finished_pieces(a.pieces, command_words(), conform_pieces(a, conform_folder(a.write))); !files)
            return fail(files.error());
    const std::atomic<bool>& stop = watch_stop_signals();
    if (const Status written = write_conform_files(a.write); !written)
        return fail(written.error());
    const ConformFolder folder = conform_folder(a.write);
    Result<ConformDrawer> drawer = ConformDrawer::open(folder, a.limits, std::make_shared<const Jobs>(a.threads));
    if (!drawer)
        return fail(drawer.error());
    if (a.pieces.merge) {
        const std::vector<JobPiece> pieces = conform_pieces(a, folder);
        const auto files = finished_pieces(a.pieces, command_words(), pieces);
        if (!files)
            return fail(files.error());
        if (const Status taken = take_references(folder, *files, pieces); !taken)
            return fail(taken.error());
    }
    report.release();
    for (std::size_t i = 0; i < folder.scenes.size() && !a.pieces.merge; ++i) {
        const FolderScene& scene = folder.scenes[i];
        const Result<ConformDrawer::ReferencePicture> reference = drawer->reference(i, static_cast<std::uint64_t>(a.samples), &stop);
        if (!reference)
            return fail(reference.error());
        for (const auto& [path, image] :
             {std::pair{folder.reference_of(scene.name), &reference->color}, {folder.variance_of(scene.name), &reference->variance}})
            if (const Status written = write_image(path, *image); !written)
                return fail(written.error());
        report.detail("scene", scene.name + ": " + scene.about);
    }
    if (const Status written = write_conform_list(a.write); !written)
        return fail(written.error());
    report.event("wrote", fmt::format("{}: {}; README.md says how an engine draws them", a.write, counted(folder.scenes.size(), "scene")));
    return 0;
}

void tell(const Judgement& judgement, Report& report)
{
    for (const SceneJudgement& s : judgement.scenes) {
        if (s.outcome == SceneJudgement::Outcome::missing || s.outcome == SceneJudgement::Outcome::unusable) {
            report.figure(s.name, s.reason);
            continue;
        }
        std::string line = fmt::format("{:5} FLIP {:.3f} to the reference, {:.3f} to what is right ({:.3f} from the reference)",
                                       outcome_name(s.outcome), s.to_reference, s.to_right, s.way_to_reference);
        if (s.outcome == SceneJudgement::Outcome::wrong && s.nearest != kNoMistake)
            line += fmt::format("; nearest: {}, FLIP {:.3f}", mistake_words(s.nearest, s.nearest_ev), s.to_nearest);
        report.figure(s.name, line);
    }
    if (judgement.way_is_known())
        report.figure("way", std::string("like ") + judgement.way->words);
    for (const FoundMistake& m : judgement.mistakes)
        report.figure("mistake", fmt::format("{} ({}; FLIP {:.3f} with it, {:.3f} without)", mistake_words(m.mutant, judgement.exposure_ev),
                                             counted(m.scenes.size(), "scene"), m.after, m.before));
    if (const std::vector<std::string> names = judgement.unexplained(); !names.empty())
        report.figure("mistake", fmt::format("none of ours looks like {}", join(names)));
}

// Reads the folder without the scenes that are left out.
Result<ConformFolder> kept_folder(const ConformArguments& a)
{
    Result<ConformFolder> folder = read_conform_folder(a.folder);
    if (folder)
        std::erase_if(folder->scenes,
                      [&](const FolderScene& s) { return std::find(a.without.begin(), a.without.end(), s.name) != a.without.end(); });
    return folder;
}

// Draws a scene with mistakes, or without where they change nothing in it.
Result<Image> drawn_with(ConformDrawer& drawer, std::size_t scene, const std::vector<int>& mistakes)
{
    Result<std::optional<Image>> drawn = drawer.draw(scene, mistakes);
    if (drawn && !*drawn)
        drawn = drawer.draw(scene, {});
    BN_TRY(drawn);
    return std::move(**drawn);
}

int draw_folder(const ConformArguments& a, Report& report)
{
    const Result<ConformFolder> folder = kept_folder(a);
    if (!folder)
        return fail(folder.error());
    if (const Status made = make_output_folder(a.pictures); !made)
        return fail(made.error());
    Result<ConformDrawer> drawer = ConformDrawer::open(*folder, a.limits, std::make_shared<const Jobs>(a.threads));
    if (!drawer)
        return fail(drawer.error());
    const TechniqueInfo* const technique = find_technique(a.technique);
    for (const RightWay& way : right_ways())
        if (way.name == a.technique)
            drawer->set_way(way);
    std::vector<int> mistakes;
    for (const std::string& name : a.mistakes)
        for (std::size_t m = 0; m < mutants().size(); ++m)
            if (mutants()[m].name == name)
                mistakes.push_back(static_cast<int>(m));
    const bool exposed = std::find(a.mistakes.begin(), a.mistakes.end(), kExposed) != a.mistakes.end();
    report.release();
    for (std::size_t i = 0; i < folder->scenes.size(); ++i) {
        Result<Image> picture = technique ? drawer->by_technique(i, *technique) : drawn_with(*drawer, i, mistakes);
        if (!picture)
            return fail(picture.error());
        for (std::size_t v = 0; exposed && v < picture->bytes.size() / sizeof(float); ++v)
            picture->f32()[v] *= 2.0f;
        if (const Status written = write_image(a.pictures + "/" + folder->scenes[i].name + ".exr", *picture); !written)
            return fail(written.error());
    }
    report.event("wrote", fmt::format("{}: {}", a.pictures, counted(folder->scenes.size(), "picture")));
    return 0;
}

int judge_folder(const ConformArguments& a, Report& report)
{
    report.promise_stdout({a.json, a.junit});
    const Result<ConformFolder> folder = kept_folder(a);
    if (!folder)
        return fail(folder.error());
    const Result<ConformPictures> pictures = read_conform_pictures(*folder, a.pictures, a.limits, report);
    if (!pictures)
        return fail(pictures.error());
    const std::shared_ptr<const Jobs> jobs = std::make_shared<const Jobs>(a.threads);
    Result<ConformDrawer> drawer = ConformDrawer::open(*folder, a.limits, jobs);
    if (!drawer)
        return fail(drawer.error());
    report.release();
    const Result<Judgement> judgement = judge_pictures(*drawer, *folder, pictures->references, pictures->engine, *jobs);
    if (!judgement)
        return fail(judgement.error());
    tell(*judgement, report);
    const Result<std::string> page = a.html.empty() ? std::string() : conform_page(*judgement, *folder, *pictures, *drawer, *jobs);
    if (!page)
        return fail(page.error());
    for (const auto& [path, text] : {std::pair{a.html, *page}, {a.json, conform_json(*judgement)}, {a.junit, conform_junit(*judgement)}})
        if (!path.empty()) {
            if (const Status written = write_text(path, text); !written)
                return fail(written.error());
            report.wrote(path);
        }
    return judgement->all_right() ? 0 : fail(conform_error(*judgement));
}

int run_conform(const ConformArguments& a, const OptionTable& given)
{
    if (const Status good = check_conform_arguments(a, given); !good)
        return fail(good.error());
    Report report(a.quiet, a.verbosity);
    if (!a.write.empty())
        return write_folder(a, report);
    return a.draw ? draw_folder(a, report) : judge_folder(a, report);
}

} // namespace

Command conform_command()
{
    auto arguments = std::make_shared<ConformArguments>();
    return {"conform", "Judge an engine's anisotropy by its pictures, and name its mistakes", conform_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_conform(*arguments, given); }};
}

} // namespace burnish
