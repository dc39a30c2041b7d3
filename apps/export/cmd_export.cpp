// `burnish export`: writes techniques for other engines in their languages, and pages with a scene and the renderer inside.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <sstream>

#include "apps/cli/command.h"
#include "apps/cli/field_options.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/export/assets.h"
#include "apps/export/glsl_text.h"
#include "apps/export/shader_text.h"
#include "apps/live/live.h"
#include "apps/options/options.h"
#include "apps/report/html.h"
#include "core/base/version.h"
#include "raster/frame/frame.h"
#include "raster/frame/grid_samples.h"
#include "shading/bake/environment/albedo_tiles.h"
#include "shading/bake/ltc/shipped.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(glsl, essl, hlsl, msl, wgsl: one file for an engine, without includes. Given equal fetches, glsl and hlsl compute burnish's bits where the
device divides and takes roots exactly. msl does too, if the compiler keeps the order of sums. essl, for OpenGL ES 3.00 and WebGL 2, and wgsl
are equal up to rounding. The file documents its arguments and the functions that the engine provides.

three, babylon: a module for three.js or Babylon.js, with the technique and all that connects it. three's draws area lights too. three-node is
for three.js' renderer on WebGPU. godot, bevy: a shader for these engines, whose first lines say what it needs.

page: one file with the scene and the renderer, which draws in any browser with WebAssembly, from disk too. The page says whether it
draws the bits of this machine. It takes the options of the picture, as `burnish render` does.

Examples:
  burnish export glsl --technique major_axis -o major_axis.glsl
  burnish export page lamp.glb --env workshop.hdr -o lamp.html
  burnish export glsl --technique filtered_is --samples 36 -o filtered_is.glsl
  burnish export wgsl --technique lobe_line -o lobe_line.wgsl
  burnish export three --technique lobe_line -o burnish_three.js)";

// Opening comment of the exported file.
constexpr const char* kHeading = R"(// {0}: {1}
// Environment light reflected by an anisotropic specular lobe, from burnish {2} (Apache License 2.0).
//
//     {4}
//
// returns linear radiance. f: burnish_usual_settings(size, levels, samples) with your changes; x: burnish_point_of(...).
// {5}
// --samples was {3}.
)";

// A language: its name on the command line, the call, and the needs of the file.
struct ExportLanguage {
    const char *name, *call, *needs;
    int most_rows; // of a constant array, for the samples of a grid
};
constexpr ExportLanguage kLanguages[] = {
    {"glsl", "vec3 burnish_{0}_specular(burnish_settings f, burnish_shaded_point x)",
     "You provide burnish_radiance(), below: fetches from your environment. Needs GLSL 4.20, ESSL 3.20 or later. `precise` keeps the bits\n"
     "// equal to those of burnish; #define precise leaves it out for speed.",
     1 << 18},
    {"essl", "vec3 burnish_{0}_specular(burnish_settings f, burnish_shaded_point x)",
     "You provide burnish_radiance(), below: fetches from your environment. Needs ESSL 3.00, as in WebGL 2, or later, and floats and\n"
     "// integers of 32 bits: `precision highp float; precision highp int;`.",
     4096},
    {"hlsl", "float3 burnish_{0}_specular(burnish_settings f, burnish_shaded_point x)",
     "You provide burnish_radiance(), below: fetches from your environment. Needs shader model 5 or later. `precise` keeps the bits equal\n"
     "// to those of burnish; #define precise leaves it out for speed.",
     4096},
    {"msl", "float3 burnish_{0}_specular(thread const burnish_environment& burnish_env, burnish_settings f, burnish_shaded_point x)",
     "Above this file, include <metal_stdlib>, write `using namespace metal;`, and define struct burnish_environment with the fetch from\n"
     "// your environment: float4 radiance(int cube, float3 direction, float lod) const; with --ltc, float4 ltc_texel(int at) const too.\n"
     "// Needs Metal 2.0 or later. The bits are those of burnish where the compiler keeps -fno-fast-math and -ffp-contract=off.",
     4096},
    {"wgsl", "fn burnish_{0}_specular(f: burnish_settings, x: burnish_shaded_point) -> vec3<f32>",
     "You provide burnish_radiance(), below: fetches from your environment. Names of overloaded functions end with their result's type.",
     2047},
};

constexpr const char* kDefaultCube = "256"; // texels along an edge: a page bakes its environment before its first picture

struct ExportArguments {
    std::string what = "glsl", technique = "major_axis", output;
    int samples = 0; // 0: the technique's default
    bool ltc = false;
    std::string scene, renderer;
    PictureSize size = {640, 360};
    RenderArguments render; // of a page's picture
    bool quiet = false;
    int verbosity = 0;
};

std::vector<std::string> technique_names()
{
    std::vector<std::string> names;
    for (const TechniqueInfo& technique : techniques())
        names.push_back(technique.name);
    names.push_back("auto");
    return names;
}

// A module for an engine: a template with places for the technique's text.
struct ExportModule {
    const char *name, *language;
    const EmbeddedFile* text;
};
constexpr ExportModule kModules[] = {{"three", "essl", &kThreeModule},
                                     {"three-node", "wgsl-of-cube", &kThreeNodeModule},
                                     {"babylon", "essl", &kBabylonModule},
                                     {"godot", "essl", &kGodotShader},
                                     {"bevy", "wgsl", &kBevyShader}};

bool is_module(const std::string& what)
{
    return std::any_of(std::begin(kModules), std::end(kModules), [&](const ExportModule& module) { return what == module.name; });
}

// Returns the languages, the modules, and a page.
std::vector<std::string> kinds_of_export()
{
    std::vector<std::string> names;
    for (const ExportLanguage& language : kLanguages)
        names.push_back(language.name);
    for (const ExportModule& module : kModules)
        names.push_back(module.name);
    names.push_back("page");
    return names;
}

OptionTable export_option_table(ExportArguments& to)
{
    OptionTable table;
    table.add("", {{"WHAT", "", "{}", choice(to.what, kinds_of_export())},
                   {"SCENE", "", "A .gltf, .glb or .obj file, or builtin:NAME, for a page", text(to.scene), "none"}});
    table.add(
        "The technique",
        {{"--technique", "NAME", "Technique to export, or that draws the page, which alone takes auto: {}",
          choice(to.technique, technique_names()), "a page: auto"},
         {"--samples", "N", "Samples in the file's default settings, or of the page, {}", integer(to.samples, 1, 65536),
          "the technique's default; three, babylon: where pixels would share samples, the most"},
         {"--ltc", "", "Add burnish_quad_light() to glsl, essl, hlsl, msl or wgsl: area lights by transformed cosines", flag(to.ltc)}});
    table.add_needing(
        "WHAT", "page",
        {{"--size", "WxH", "Size of the picture whose bits the page compares", picture_size(to.size)},
         {"--renderer", "FOLDER", "Folder of the npm package, with burnish_core.wasm", folder(to.renderer), "beside the program"}});
    const OptionTable picture = render_option_table(to.render);
    std::vector<Option> rows;
    for (const Option& option : picture.options())
        if (option.needed_option.empty() && (option.name == "--env" || (is_served(option) && !table.find(option.name))))
            rows.push_back(option);
    for (Option& row : rows)
        if (row.name == "--env-size")
            row.initial = kDefaultCube;
    table.add_needing("WHAT", "page", rows);
    table.add("Output", {Option("-o,--output", "FILE", "File to write; - for standard output", file(to.output)).must_be_given(),
                         quiet_option(to.quiet), verbose_option(to.verbosity)});
    return table;
}

// Returns the technique in GLSL, without a heading.
std::string glsl_of_technique(const TechniqueInfo& technique, int samples, bool ltc)
{
    GlslWish wish;
    wish.roots = {std::string(technique.name) + "_specular", "usual_settings", "point_of", "dfg_fit", "albedo_place"};
    if (technique.traits & kSharesSamples)
        wish.roots.push_back(std::string(technique.name) + "_shared");
    if (ltc)
        wish.roots.push_back("quad_light");
    wish.trimmed = {{"settings", "f", "usual_settings"}, {"shaded_point", "x", "point_of"}};
    wish.grid = grid_samples(samples, technique.sampling, technique.traits);
    wish.blocks = technique.traits & kPhongGrid;
    wish.grid_count = grid_count(wish.grid, technique.traits);
    return glsl_of(kFlatTechniques.bytes, wish);
}

std::string language_text(const TechniqueInfo& technique, int samples, bool ltc, const ExportLanguage& language)
{
    const std::string glsl = glsl_of_technique(technique, samples, ltc), name = language.name;
    const std::string heading = fmt::format(kHeading, technique.name, with_options(technique.summary), version(), samples,
                                            fmt::format(fmt::runtime(language.call), technique.name), language.needs);
    return heading + "\n" + (name == "glsl" ? glsl : shader_text(glsl, name));
}

std::string replaced_all(std::string text, const std::string& old, const std::string& by)
{
    for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + by.size()))
        text.replace(at, old.size(), by);
    return text;
}

// Returns the albedo of lobes with two widths as texels of two bytes, in Base64.
std::string albedo_text()
{
    std::string bytes;
    for (const float value : albedo_tiles())
        bytes += static_cast<char>(static_cast<unsigned char>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f))));
    return base64(bytes);
}

// Returns the texture of transformed cosines as halves, in Base64.
std::string ltc_text()
{
    std::string bytes;
    for (const std::uint16_t half : ltc::shipped_texture()) {
        bytes += static_cast<char>(half & 0xff);
        bytes += static_cast<char>(half >> 8);
    }
    return base64(bytes);
}

// Returns the text without comments and empty lines. Babylon.js takes a semicolon in a comment for the end of a statement.
std::string without_comments(const std::string& text)
{
    std::string out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t end = line.substr(0, line.find("//")).find_last_not_of(" \t");
        if (end != std::string::npos)
            out += line.substr(0, end + 1) + "\n";
    }
    return out;
}

// Returns the text without declarations of functions. Godot has none: the template holds the engine's function before the technique.
std::string without_prototypes(const std::string& text)
{
    std::string out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (!(line.size() > 2 && line.ends_with(");") && line[0] != ' ' && line.find('=') == std::string::npos))
            out += line + "\n";
    return out;
}

std::string module_text(const TechniqueInfo& technique, int samples, const ExportModule& module)
{
    std::string shader =
        without_comments(shader_text(glsl_of_technique(technique, samples, std::string(module.name) == "three"), module.language));
    if (std::string(module.name) == "godot")
        shader = without_prototypes(shader);
    std::string text(module.text->bytes);
    for (const auto& [place, value] : {std::pair<std::string, std::string>{"@TECHNIQUE@", technique.name},
                                       {"@VERSION@", version()},
                                       {"@SAMPLES@", std::to_string(samples)},
                                       {"@SHADER@", shader},
                                       {"@ALBEDO@", albedo_text()},
                                       {"@LTC@", ltc_text()}})
        text = replaced_all(text, place, value);
    return text;
}

Result<std::string> technique_text(const ExportArguments& arguments, const OptionTable& given, Report& report)
{
    if (!given.given("--technique"))
        return usage_error("--technique", "is missing");
    if (!arguments.scene.empty())
        return usage_error("SCENE", "is for a page");
    if (arguments.technique == "auto")
        return usage_error("--technique", "auto is for a page: a file holds one technique");
    if (arguments.ltc && is_module(arguments.what))
        return usage_error("--ltc", "is for languages; three brings area lights, the other modules do not");
    const TechniqueInfo& technique = *find_technique(arguments.technique);
    const bool alone = is_module(arguments.what) && (technique.traits & kSharesSamples); // an engine's pixels do not share samples
    const int asked = arguments.samples > 0 ? arguments.samples : alone ? technique.most_samples : technique.default_samples;
    if (asked > technique.most_samples)
        return usage_error("--samples", fmt::format("{} takes at most {}", technique.name, technique.most_samples));
    if (arguments.samples > 0 && technique.sampling == Sampling::none)
        report.warning(fmt::format("--samples has no effect: {} takes none", technique.name));
    const int samples = effective_samples(technique, asked);
    for (const ExportLanguage& language : kLanguages)
        if (arguments.what == language.name) {
            const std::size_t rows = grid_samples(samples, technique.sampling, technique.traits).size() *
                                     ((technique.traits & kPhongGrid) ? 4 : 1) / ((technique.traits & kPhongGrid) ? kPhongBlock : 1);
            if (rows > static_cast<std::size_t>(language.most_rows))
                return usage_error("--samples", fmt::format("{} holds a grid of at most {} values, {} has {}", language.name,
                                                            language.most_rows, technique.name, rows));
            return language_text(technique, samples, arguments.ltc, language);
        }
    const auto module =
        std::find_if(std::begin(kModules), std::end(kModules), [&](const ExportModule& m) { return arguments.what == m.name; });
    if (technique.traits & (kReadsBox + kSamplesLobe))
        return usage_error("--technique",
                           fmt::format("{} reads levels that {} has not; take one that reads prefiltered levels, such as lobe_line",
                                       technique.name, module->name));
    return module_text(technique, samples, *module);
}

// Returns what a page shows first: the options that were given.
DrawRequest request_of(const ExportArguments& arguments, const OptionTable& given)
{
    DrawRequest request;
    request.scene = arguments.scene, request.width = arguments.size.width, request.height = arguments.size.height;
    if (!given.given("--env-size"))
        request.options.emplace_back("--env-size", kDefaultCube);
    for (const Option& option : given.options())
        if (option.given && option.name == "--env")
            request.environment = option.texts.back();
    add_served(given, request);
    return request;
}

Result<std::string> exported_page(const ExportArguments& arguments, const OptionTable& given, Report& report)
{
    if (arguments.ltc)
        return usage_error("--ltc", "is for languages");
    if (arguments.scene.empty())
        return usage_error("SCENE", "is missing: a .gltf, .glb or .obj file, or builtin:NAME");
    LiveWish wish;
    wish.rows = {{"page", request_of(arguments, given)}}, wish.renderer_folder = arguments.renderer;
    Result<LiveParts> page = live_page(wish);
    BN_TRY(page);
    for (const std::string& warning : page->warnings)
        report.warning(warning);
    return std::move(page->html);
}

int run_export(const ExportArguments& arguments, const OptionTable& given)
{
    if (Status path = check_text_path("-o", arguments.output, {}); !path)
        return fail(path.error());
    Report report(arguments.quiet, arguments.verbosity);
    const Result<std::string> text =
        arguments.what == "page" ? exported_page(arguments, given, report) : technique_text(arguments, given, report);
    if (!text)
        return fail(text.error());
    if (Status written = write_text(arguments.output, *text); !written)
        return fail(written.error());
    report.release();
    report.wrote(arguments.output);
    return 0;
}

} // namespace

Command export_command()
{
    auto arguments = std::make_shared<ExportArguments>();
    return {"export", "Write a technique for other engines, or a page with the renderer inside", export_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_export(*arguments, given); }};
}

} // namespace burnish
