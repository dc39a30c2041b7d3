#include "apps/parity/options.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <map>

#include "apps/cli/outputs.h"
#include "apps/cli/parse.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"

namespace burnish {
namespace {

// Every built-in scene, also from close by: triangles then cross the near plane and cover more than the picture.
struct SuiteEntry {
    const char *scene, *view;
    float eye[3], target[3];
};
constexpr SuiteEntry kDefaultSuite[] = {
    {"builtin:teapot", "", {}, {}},
    {"builtin:spheres", "", {}, {}},
    {"builtin:plate", "", {}, {}},
    {"builtin:teapot", "close", {0.13f, 0.09f, 0.06f}, {0.0f, 0.06f, 0.0f}},
    {"builtin:spheres", "within", {0.3f, 0.05f, 0.2f}, {0.0f, 0.0f, 0.0f}},
};

Status add_models(const std::string& folder, std::vector<ParityPlace>& places)
{
    std::error_code failed;
    std::vector<std::string> files;
    for (auto at = std::filesystem::recursive_directory_iterator(folder, failed);
         !failed && at != std::filesystem::recursive_directory_iterator(); at.increment(failed))
        if (const std::string kind = at->path().extension(); kind == ".glb" || kind == ".gltf")
            files.push_back(at->path());
    if (failed)
        return Error{ExitCode::bad_input, folder, "--models", failed.message()};
    if (files.empty())
        return Error{ExitCode::bad_input, folder, "--models", "holds no .glb and no .gltf"};
    std::sort(files.begin(), files.end());
    for (const std::string& file : files)
        places.push_back({file, "", {}, {}});
    return {};
}

Status choose_places(const ParityArguments& in, std::vector<ParityPlace>& places)
{
    if (!in.suite.empty() && in.render.plain.eye)
        return usage_error("--eye", "cannot be combined with --suite");
    for (const std::string& scene : in.scenes)
        places.push_back({scene, in.render.plain.eye ? "--eye" : "", {}, {}});
    if (in.suite.empty() && (!places.empty() || !in.models.empty() || in.render.plain.eye)) {
        if (places.empty() && in.models.empty())
            return usage_error("--eye", "needs a SCENE");
    } else {
        for (const SuiteEntry& e : kDefaultSuite) {
            ParityPlace place = {e.scene, e.view, {}, {}};
            if (*e.view)
                place.eye = glm::dvec3(e.eye[0], e.eye[1], e.eye[2]), place.target = glm::dvec3(e.target[0], e.target[1], e.target[2]);
            places.push_back(place);
        }
    }
    return in.models.empty() ? Status() : add_models(in.models, places);
}

// Returns true for options that another look may change: the content, not its size, environment or view.
bool changes_look(const Option& option)
{
    constexpr const char* kLooks[] = {"--technique",  "--msaa",  "--samples",   "--roughness",
                                      "--anisotropy", "--light", "--ltc-table", "--texture-anisotropy"};
    return option.group == "Materials" || option.group == "Parameters of techniques" ||
           std::find(std::begin(kLooks), std::end(kLooks), option.name) != std::end(kLooks);
}

// Sets options from text such as "--tilt 20,-10 --horizon off", in command-line syntax.
Status set_words(const std::string& words, OptionTable& table)
{
    std::vector<std::string> parts = split(words, ' ');
    parts.erase(std::remove(parts.begin(), parts.end(), ""), parts.end());
    std::map<std::string, std::vector<std::string>> given;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Option* option = table.find(parts[i]);
        if (!option || parts[i] != option->name || !changes_look(*option))
            return usage_error("--also", fmt::format("'{}' is no option that another look may change", parts[i]));
        const bool takes = option->takes_value();
        if (takes && i + 1 == parts.size())
            return usage_error("--also", fmt::format("{} needs a value", parts[i]));
        given[parts[i]].push_back(takes ? parts[i + 1] : "");
        i += takes;
    }
    for (const auto& [name, texts] : given)
        BN_TRY(table.set_all(name, texts));
    return parts.empty() ? usage_error("--also", "needs options such as '--tilt 20,-10'") : table.check_needs();
}

Result<std::vector<RenderOptions>> frames_of(const ParityArguments& in, const OptionTable& given)
{
    std::vector<RenderOptions> frames;
    RenderArguments arguments = in.render;
    for (const std::string& technique : in.techniques)
        for (const int msaa : in.msaa) {
            arguments.plain.frame.technique = technique, arguments.plain.frame.msaa = msaa;
            const Result<RenderOptions> checked = check_render_options(arguments, given);
            BN_TRY(checked);
            frames.push_back(*checked);
        }
    return frames;
}

// Returns the same frames with additional options. `given`: the options on the command line.
Result<std::vector<RenderOptions>> frames_of_look(const std::string& also, const ParityArguments& in, const OptionTable& given)
{
    ParityArguments arguments = in;
    OptionTable table = parity_option_table(arguments);
    for (std::size_t i = 0; i < table.options().size(); ++i)
        table.options()[i].given = given.options()[i].given;
    BN_TRY(set_words(also, table));
    return frames_of(arguments, table);
}

} // namespace

OptionTable parity_option_table(ParityArguments& to)
{
    RenderOptions& r = to.render.plain;
    const OptionTable of_render = render_option_table(to.render);
    OptionTable table;
    table.add("", {{"SCENE", "", "A .gltf, .glb or .obj file, or builtin:NAME; may be several", scenes(to.scenes), "the suite 'default'"}});
    table.add(
        "Comparisons",
        {{"--suite", "NAME", "Set of scenes: {} (the built-in ones, from afar and from near)", choice(to.suite, {"default"})},
         {"--models", "DIR", "Folder whose .glb and .gltf files are compared too", folder(to.models)},
         {"--technique", "NAMES", "all, or names by commas; see burnish list techniques", techniques_value(to.techniques)},
         {"--glsl", "FILE", "The technique as GLSL, in place of the program's: a file of burnish export glsl, edited; needs glslc",
          file(to.glsl)},
         {"--msaa", "N,N", "Samples a pixel, separated by commas: 1, 2, 4, 8 or 16", choices(to.msaa, {1, 2, 4, 8, 16})},
         {"--also", "OPTIONS",
          "Options of materials and techniques for a further round, such as '--tilt 20,-10 --horizon off'; may be given several times",
          texts(to.also)}});
    table.take(of_render, "Machine",
               {{"--device", nullptr, "the first CPU device"},
                {"--sampler", "Texture sampler: exact, or native with --pipeline forward"},
                "--validate"});
    table.add("Machine", {{"--pipeline", "NAME",
                           "Pipeline: ids (visibility first, one shading for each visible triangle and pixel) or forward (classical)",
                           choice(r.vulkan.pipeline, {"ids", "forward"})},
                          {"--shaders", "DIR", "Folder with NAME.spv to replace the program's shaders, for tests of this command",
                           folder(r.vulkan.shader_folder)},
                          threads_option(r.threads, "Worker threads of the tile renderer"),
                          isa_option(r.isa)});
    table.add("Output", {{"--json", "FILE", "Rows as JSON; - for standard output", file(to.json)},
                         {"--csv", "FILE", "Rows as CSV, without their stages; - for standard output", file(to.csv)},
                         {"--junit", "FILE", "Rows as JUnit XML", file(to.junit)},
                         {"--html", "FILE", "Rows as one HTML page", file(to.html)},
                         quiet_option(r.quiet),
                         verbose_option(r.verbosity, "Print every row")});
    table.take(of_render, "Output", {"--shadows", "--shadow-samples"});
    table.take(of_render, "Picture",
               {"--size",
                "--eye",
                "--target",
                "--env",
                "--env-size",
                "--key-lights",
                "--env-samples",
                {"--samples", "Samples of the techniques, if they take any", ""},
                {"--roughness", "Override the roughness of every material, {}"},
                {"--anisotropy", "Override the anisotropy eta of every material, {}"},
                "--light",
                "--ltc-table",
                "--as-table",
                "--texture-anisotropy",
                {"--no-cache", "Take neither environments nor pipelines from disk"}});
    table.take_all(of_render, "Materials");
    table.take_all(of_render, "Parameters of techniques");
    return table;
}

Result<ParityOptions> check_parity_options(const ParityArguments& in, const OptionTable& given)
{
    ParityOptions out;
    out.glsl = in.glsl;
    if (!in.glsl.empty()) {
        if (in.techniques.size() != 1 || !given.given("--technique"))
            return usage_error("--glsl", "takes the place of one technique: give --technique NAME");
        if (!find_technique(in.techniques.front()) || in.techniques.front() == "auto")
            return usage_error("--glsl", "takes the place of one technique; auto is none");
        if (given.given("--shaders") || in.render.plain.vulkan.pipeline == VulkanPipeline::forward)
            return usage_error("--glsl", "cannot be used with --shaders or --pipeline forward");
    }
    out.json = in.json, out.csv = in.csv, out.junit = in.junit, out.html = in.html;
    BN_TRY(choose_places(in, out.places));
    for (std::size_t i = 0; i <= in.also.size(); ++i) {
        const std::string also = i ? in.also[i - 1] : "";
        Result<std::vector<RenderOptions>> frames = i ? frames_of_look(also, in, given) : frames_of(in, given);
        BN_TRY(frames);
        out.sets.push_back({also, std::move(*frames)});
    }
    std::vector<std::string> inputs = {in.render.plain.env, in.glsl};
    for (const ParityPlace& place : out.places)
        inputs.push_back(place.scene);
    BN_TRY(check_outputs({}, {{"--json", out.json}, {"--csv", out.csv}, {"--junit", out.junit}, {"--html", out.html}}, inputs));
    return out;
}

} // namespace burnish
