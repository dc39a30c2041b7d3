#include "apps/parity_options.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "apps/chart_plan.h"
#include "apps/command.h"
#include "apps/outputs.h"
#include "apps/parse.h"
#include "apps/report.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(Renders with the tile renderer and with Vulkan, and compares words: clip positions, visibility (the triangle of each sample), depth,
interpolants, material inputs, shaded colour, resolved colour; what follows visibility where visibility agrees. With the exact sampler no
word may differ but visibility, of which one sample in a million may; pictures of --pipeline forward must look the same (mean FLIP below 0.002),
and every pixel that differs is put down to the first stage that differs by more than a thousandth, or to rounding.

Examples:
  burnish parity
  burnish parity lamp.glb --env workshop.hdr --technique major_axis,mc --msaa 1,4 -v
  burnish parity --suite default --models models --junit parity.xml --json parity.json --html parity.html
  burnish parity --pipeline forward --sampler native --msaa 4

Exit codes: 0 as promised, 1 not as promised, 77 no such device, sample count or Vulkan; a row that fails otherwise: its code, at the end.)";

constexpr const char* kUsualSize = "128x72", *kUsualMsaa = "1,4,8";

// Every built-in scene; and closer, so that triangles cross the near plane and fill more than the picture.
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

void add_what(CLI::App& app, ParityArguments& to)
{
    app.add_option("SCENE", to.scenes, "A .gltf or .glb file, or builtin:NAME; may be several (the suite 'default')");
    const auto option = [&app](const char* name, std::string& text, const char* help, const char* type, const char* group) {
        return app.add_option(name, text, help)->type_name(type)->group(group);
    };
    option("--suite", to.suite, "default: the built-in scenes, from afar and from close by", "NAME", "What is compared");
    option("--models", to.models, "Also every .glb and .gltf below this folder", "DIR", "What is compared");
    option("--technique", to.technique, "all, or names by commas; see burnish list techniques (all)", "NAMES", "What is compared");
    option("--msaa", to.msaa, "Samples a pixel, by commas, of 1, 2, 4, 8 and 16 (1,4,8)", "N,N", "What is compared");
    option("--device", to.render.device, "lavapipe, swiftshader, gpu, or a part of a device's name (the first CPU device)", "NAME", "Machine");
    option("--sampler", to.render.sampler, "exact, or native with --pipeline forward (exact)", "NAME", "Machine");
    option("--pipeline", to.render.pipeline, "ids or forward (ids)", "NAME", "Machine");
    app.add_flag("--validate", to.render.validate, "With the Khronos validation layer; fail where it complains")->group("Machine");
    option("--shaders", to.shaders, "Folder of NAME.spv in place of the program's shaders: for tests of this command", "DIR", "Machine");
    option("--json", to.json, "Rows as JSON; - for standard output", "FILE", "Output");
    option("--junit", to.junit, "Rows as JUnit XML", "FILE", "Output");
    option("--html", to.html, "Rows as one page", "FILE", "Output");
    app.add_flag("-q,--quiet", to.render.plain.quiet, "Print errors only")->group("Output");
    app.add_flag("-v,--verbose", to.render.plain.verbosity, "Print every row")->group("Output");
}

void add_picture(CLI::App& app, RenderArguments& to)
{
    const auto option = [&app](const char* name, std::string& text, const char* help, const char* type) {
        app.add_option(name, text, help)->type_name(type)->group("Picture");
    };
    option("--size", to.size, "Width and height in pixels (128x72)", "WxH");
    option("--eye", to.eye, "Camera position, world space", "X,Y,Z");
    option("--target", to.target, "What --eye looks at (the centre of the scene)", "X,Y,Z");
    option("--env", to.plain.env, "Equirectangular picture or builtin:NAME (builtin:studio)", "FILE");
    option("--env-size", to.env_size, "Texels along a cube edge, a power of two (512)", "N");
    option("--env-samples", to.env_samples, "Samples a texel of the prefiltered levels (1024)", "N");
    option("--samples", to.samples, "Samples of the techniques, where they take any", "N");
    option("--roughness", to.roughness, "Override alpha_lin of every material, 0 to 1", "R");
    option("--anisotropy", to.anisotropy, "Override eta of every material, -1 to 1", "A");
    option("--tilt", to.tilt, "Tilt every lobe against its surface", "DEG,DEG");
    option("--dfg", to.dfg, "Directional albedo: table or fit (table)", "NAME");
    option("--texture-anisotropy", to.texture_anisotropy, "Texture taps along the major axis at most (16)", "N");
    app.add_flag("--horizon", to.horizon, "Normal maps reflect nothing from below the surface itself")->group("Picture");
    app.add_flag("--energy-compensation", to.energy_compensation, "Return the light that rough lobes lose")->group("Picture");
    app.add_flag("--no-cache", to.no_cache, "Neither environments nor pipelines from disk")->group("Picture");
    app.add_option("-t,--threads", to.threads, "Worker threads of the tile renderer (all cores)")->type_name("N")->group("Machine");
    app.add_option("--isa", to.isa, "scalar, avx2 or avx512 (the best one)")->type_name("NAME")->group("Machine");
}

Status add_models(const std::string& folder, std::vector<ParityPlace>& places)
{
    std::error_code failed;
    std::vector<std::string> files;
    for (auto at = std::filesystem::recursive_directory_iterator(folder, failed); !failed && at != std::filesystem::recursive_directory_iterator();
         at.increment(failed))
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
    if (!in.suite.empty() && in.suite != "default")
        return usage_error("--suite", fmt::format("'{}' is not one of default", in.suite));
    if (!in.suite.empty() && !in.render.eye.empty())
        return usage_error("--eye", "cannot be combined with --suite");
    for (const std::string& scene : in.scenes)
        places.push_back({scene, in.render.eye.empty() ? "" : "--eye", {}, {}});
    if (in.suite.empty() && (!places.empty() || !in.models.empty() || !in.render.eye.empty())) {
        if (places.empty() && in.models.empty())
            return usage_error("--eye", "needs a SCENE");
    } else {
        for (const SuiteEntry& e : kDefaultSuite) {
            ParityPlace place = {e.scene, e.view, {}, {}};
            if (*e.view)
                place.eye = glm::vec3(e.eye[0], e.eye[1], e.eye[2]), place.target = glm::vec3(e.target[0], e.target[1], e.target[2]);
            places.push_back(place);
        }
    }
    return in.models.empty() ? Status() : add_models(in.models, places);
}

} // namespace

void add_parity_options(CLI::App& app, ParityArguments& arguments)
{
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    add_what(app, arguments);
    add_picture(app, arguments.render);
    refuse_empty_values(app);
    app.get_option("SCENE")->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.footer(kFooter);
}

Result<ParityOptions> check_parity_options(const ParityArguments& in)
{
    ParityOptions out;
    out.json = in.json, out.junit = in.junit, out.html = in.html;
    if (const Status chosen = choose_places(in, out.places); !chosen)
        return chosen.error();
    const Result<std::vector<std::string>> techniques = parse_techniques(in.technique, "--technique");
    if (!techniques)
        return techniques.error();
    RenderArguments arguments = in.render;
    arguments.plain.backend = "vulkan";
    if (arguments.size.empty())
        arguments.size = kUsualSize;
    for (const std::string& technique : *techniques)
        for (const std::string& msaa : split(in.msaa.empty() ? kUsualMsaa : in.msaa, ',')) {
            if (msaa.empty())
                return usage_error("--msaa", "holds an empty entry");
            arguments.technique = technique, arguments.msaa = msaa;
            for (const ParityPlace& place : out.places) {
                arguments.plain.scene = place.scene;
                const Result<RenderOptions> checked = check_render_options(arguments);
                if (!checked)
                    return checked.error();
                if (&place == &out.places.front())
                    out.frames.push_back(*checked);
            }
            out.frames.back().vulkan.prefer_cpu = true;
            out.frames.back().vulkan.shader_folder = in.shaders;
        }
    std::vector<std::string> inputs = {in.render.plain.env};
    for (const ParityPlace& place : out.places)
        inputs.push_back(place.scene);
    if (const Status writable = check_outputs({}, {{"--json", out.json}, {"--junit", out.junit}, {"--html", out.html}}, inputs); !writable)
        return writable.error();
    return out;
}

} // namespace burnish
