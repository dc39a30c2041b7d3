// `burnish race`: times the tile renderer against Vulkan's CPU devices on one picture.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/field_options.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/lab/race/opaque_scene.h"
#include "apps/lab/race/race_report.h"
#include "apps/options/scene_with_view.h"
#include "apps/render/stats.h"
#include "core/base/clock.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/jobs/activity.h"
#include "core/simd/cpu.h"
#include "raster/tile/tile_renderer.h"
#include "raster/vulkan/lab/lean.h"

namespace burnish {
namespace {

constexpr const char* kRaceFooter =
    R"(The tile renderer and each device draw the same frame in turn, after warming up. The device uses the classical pipeline and its own samplers,
and is timed from submission to the fence. It runs the project's shader, made from the kernels' text, and a lean shader, as an engine would
write it. The ratio compares the process' CPU times, device over tile: above 1, the tile renderer needs less. A frame that differs (mean FLIP
above 0.01 over pixels without silhouettes) is marked and does not count. A row that fails, or that the lean shader cannot draw, is reported,
and the program ends with its exit code.

An engine's shader has no horizon under normal maps and no facets of distant ones, and draws opaque surfaces in a pass of their own. So with
the lean shader no renderer draws these, or materials that let light through or blend. A note counts these materials.

Examples:
  burnish race
  burnish race builtin:spheres --techniques major_axis,mc --size 1920x1080 --msaa 1,4 --json race.json)";

struct RaceArguments {
    RaceArguments()
    {
        render.plain.backend = "vulkan";
        render.plain.vulkan.pipeline = VulkanPipeline::forward, render.plain.vulkan.sampler = VulkanSampler::native;
    }
    RenderArguments render;
    std::vector<std::string> scenes = {"builtin:teapot"}, techniques = *parse_techniques("all"), devices = {"lavapipe", "swiftshader"},
                             shaders = {std::begin(kRaceShaders), std::end(kRaceShaders)};
    std::vector<int> msaa = {1, 4};
    int runs = 5;
    std::string json, csv, pictures;
};

struct Timed {
    std::vector<double> wall_ms, cpu_ms;
    Image picture;
};

// Renders and times a frame. `frame` is the previous frame; its memory is reused.
Status draw_tile(Session& tile, const FrameDesc& desc, Frame& frame, Timed& into)
{
    const double wall = wall_ms(), cpu = process_cpu_ms();
    Result<Frame> drawn = tile.render(desc, std::move(frame));
    into.cpu_ms.push_back(process_cpu_ms() - cpu);
    into.wall_ms.push_back(wall_ms() - wall);
    BN_TRY(drawn);
    frame = std::move(*drawn);
    return {};
}

Status draw_device(Session& device, const FrameDesc& desc, Frame& frame, Timed& into)
{
    Result<Frame> drawn = device.render(desc, std::move(frame));
    BN_TRY(drawn);
    into.cpu_ms.push_back(drawn->stats.device_cpu_ms), into.wall_ms.push_back(drawn->stats.device_ms);
    frame = std::move(*drawn);
    return {};
}

// Writes the tile renderer's picture with the device's to its right.
Status write_beside(const std::string& path, const Image& tile, const Image& device)
{
    Image both = make_image(2 * tile.width, tile.height, tile.channels, tile.type);
    const std::size_t row = tile.bytes.size() / static_cast<std::size_t>(tile.height);
    for (std::size_t y = 0; y < static_cast<std::size_t>(tile.height); ++y) {
        std::copy_n(tile.bytes.data() + y * row, row, both.bytes.data() + 2 * y * row);
        std::copy_n(device.bytes.data() + y * row, row, both.bytes.data() + (2 * y + 1) * row);
    }
    const RenderOptions usual;
    return write_picture(path, both, usual.tonemap, usual.exposure_ev);
}

// Returns the name of a row's picture: its number, and all that tells the row.
std::string picture_name(std::size_t number, const RenderOptions& frame, const std::string& shader, const std::string& device)
{
    std::string name = fmt::format("{:03}-{}-{}-{}x-{}-{}", number, std::filesystem::path(frame.scene).stem().string(),
                                   frame.frame.technique, frame.frame.msaa, shader, device.substr(0, device.find(' ')));
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.')
            c = '_';
    return name + ".png";
}

// Alternates A B A B: a slow phase of the machine slows both. Skips the first round, in which pipelines are compiled.
// picture: written with both frames; empty: none.
Result<RaceRow> race(Session& tile, Session& device, const FrameDesc& desc, int runs, const Jobs& jobs, const std::string& picture)
{
    Timed a, b;
    Frame of_tile, of_device;
    for (int i = 0; i <= runs; ++i) {
        BN_TRY(draw_tile(tile, desc, of_tile, a));
        BN_TRY(draw_device(device, desc, of_device, b));
        if (i == 0)
            a = Timed(), b = Timed();
    }
    RaceRow row;
    row.technique = desc.technique, row.samples = desc.samples, row.msaa = desc.msaa;
    row.tile_ms = median(a.wall_ms), row.device_ms = median(b.wall_ms);
    row.tile_cpu_ms = median(a.cpu_ms), row.device_cpu_ms = median(b.cpu_ms);
    std::vector<std::uint8_t> silhouettes;
    if (desc.msaa > 1) {
        FrameDesc seen = desc;
        seen.triangle_ids = true;
        Result<Frame> ids = tile.render(seen, std::move(of_tile));
        BN_TRY(ids);
        of_tile = std::move(*ids);
        silhouettes = silhouettes_of(of_tile, desc.msaa, tile.tables());
    }
    compare_pictures(of_tile.color, of_device.color, silhouettes, jobs, row);
    if (!picture.empty())
        BN_TRY(write_beside(picture, of_tile.color, of_device.color));
    return row;
}

RaceRow failed_row(const FrameDesc& desc, const Error& error)
{
    RaceRow row;
    row.technique = desc.technique, row.samples = desc.samples, row.msaa = desc.msaa, row.error = line_of(error);
    return row;
}

// All frames to race, by scene.
struct RacePlan {
    std::vector<RenderOptions> frames; // by scene, technique, msaa
    std::vector<std::string> devices, shaders;
    std::string pictures; // folder; empty: none
    int runs = 5;
    bool lean = false; // the lean shader is among them: normal maps have no horizon and no facets, and scenes are opaque
};

Result<RacePlan> check(const RaceArguments& in, const OptionTable& given)
{
    RacePlan plan;
    plan.lean = std::find(in.shaders.begin(), in.shaders.end(), "lean") != in.shaders.end();
    RenderArguments arguments = in.render;
    if (plan.lean)
        arguments.plain.frame.horizon = 0, arguments.plain.mips.facets = false;
    for (const std::string& scene : in.scenes)
        for (const std::string& technique : in.techniques)
            for (const int msaa : in.msaa) {
                arguments.plain.scene = scene, arguments.plain.frame.technique = technique, arguments.plain.frame.msaa = msaa;
                const Result<RenderOptions> checked = check_render_options(arguments, given);
                BN_TRY(checked);
                plan.frames.push_back(*checked);
            }
    plan.devices = in.devices, plan.shaders = in.shaders, plan.runs = in.runs, plan.pictures = in.pictures;
    std::vector<std::string> inputs = in.scenes;
    inputs.push_back(in.render.plain.env);
    BN_TRY(check_outputs({}, {{"--json", in.json}, {"--csv", in.csv}}, inputs));
    if (!in.pictures.empty())
        BN_TRY(check_folder_path(in.pictures));
    return plan;
}

// A device with one of its shaders.
struct Opponent {
    std::shared_ptr<VulkanDevice> device;
    std::string shader;
};

// Opens the available devices. Adds a note for each missing one.
std::vector<Opponent> open_devices(const RacePlan& plan, RaceReport& report, Error& last)
{
    std::vector<Opponent> devices;
    for (const std::string& name : plan.devices)
        for (const std::string& shader : plan.shaders) {
            VulkanOptions options = plan.frames.front().vulkan;
            options.device = name, options.centroid = true; // the device's cheapest mode
            options.shaders = shader == "lean" ? lean_shaders() : nullptr;
            const Result<std::shared_ptr<VulkanDevice>> device = open_vulkan_device(options);
            if (!device) {
                last = device.error();
                report.notes.push_back(name + ": " + line_of(last));
                break;
            }
            devices.push_back({*device, shader});
            if (shader == plan.shaders.front() && (*device)->info().name.find("SwiftShader") != std::string::npos)
                report.notes.push_back(
                    "SwiftShader snaps vertices to 1/16 pixel, so its edges differ by design, and is slow where the level of detail "
                    "varies inside a quad");
        }
    return devices;
}

// State shared by all scenes.
struct Race {
    const RacePlan& plan;
    const std::vector<Opponent>& devices;
    std::shared_ptr<const Environment> environment;
    std::shared_ptr<const Jobs> jobs;
    Report& report;
    RaceReport& out;
    Error first_error; // first error of a row; 77 gives way to other codes; other rows still run
};

void add_row(Race& bench, const RenderOptions& frame, std::size_t device, const Result<RaceRow>& raced)
{
    RaceRow row = raced ? *raced : failed_row(frame.frame, raced.error());
    if (!raced && (bench.first_error.code == ExitCode::ok || bench.first_error.code == ExitCode::unavailable))
        bench.first_error = raced.error();
    row.scene = frame.scene, row.device = bench.devices[device].device->info().name, row.shader = bench.devices[device].shader;
    const std::string outcome = raced ? fmt::format("{:.2f}", row.ratio()) : row.error;
    bench.report.detail("row", fmt::format("{} {} {}x {} {}: {}", row.scene, row.technique, row.msaa, row.shader, row.device, outcome));
    bench.out.rows.push_back(row);
}

// Loads a scene and its view. Leaves out surfaces that the lean shader's pass does not draw, and adds a note. Errors: nothing is left.
Result<SceneWithView> load_raced_scene(Race& bench, const RenderOptions& base)
{
    Result<SceneWithView> scene = load_scene_with_view(base.scene, base, bench.report, *bench.jobs);
    if (!scene || !bench.plan.lean)
        return scene;
    const Result<OpaqueScene> opaque = opaque_scene(scene->data);
    BN_TRY(opaque);
    if (opaque->empty())
        return Error{ExitCode::unavailable, base.scene, "", "nothing is left to draw: all its materials let light through or blend"};
    if (opaque->left_out > 0)
        bench.out.notes.push_back(base.scene + ": " + left_out_note(*opaque));
    scene->data = opaque->data;
    return scene;
}

// Races frames first to last - 1 of the plan, all of one scene.
void race_scene(Race& bench, std::size_t first, std::size_t last)
{
    const std::vector<RenderOptions>& frames = bench.plan.frames;
    const Result<SceneWithView> scene = load_raced_scene(bench, frames[first]);
    if (!scene) {
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t d = 0; d < bench.devices.size(); ++d)
                add_row(bench, frames[i], d, scene.error());
        return;
    }
    const SessionParts parts{scene->data, bench.environment, bench.jobs, {}};
    SessionOptions options;
    options.isa = frames[first].isa;
    Result<Session> tile = Session::make(parts, options);
    options.backend = Backend::vulkan;
    std::vector<Result<Session>> renderers;
    for (const Opponent& opponent : bench.devices) {
        options.device = opponent.device;
        renderers.push_back(Session::make(parts, options));
    }
    for (std::size_t i = first; i < last; ++i)
        for (std::size_t d = 0; d < bench.devices.size(); ++d) {
            FrameDesc desc = frames[i].frame;
            const Activity activity(fmt::format("row {} of {}: {} {}", i * bench.devices.size() + d + 1,
                                                frames.size() * bench.devices.size(), frames[i].scene, desc.technique));
            desc.view = scene->view;
            const Opponent& opponent = bench.devices[d];
            const std::string picture = bench.plan.pictures.empty() ? ""
                                                                    : bench.plan.pictures + "/" +
                                                                          picture_name(i * bench.devices.size() + d + 1, frames[i],
                                                                                       opponent.shader, opponent.device->info().name);
            add_row(bench, frames[i], d,
                    renderers[d] ? race(*tile, *renderers[d], desc, bench.plan.runs, *bench.jobs, picture)
                                 : Result<RaceRow>(renderers[d].error()));
        }
}

int run_race(const RaceArguments& arguments, const OptionTable& given)
{
    const Result<RacePlan> checked = check(arguments, given);
    if (!checked)
        return fail(checked.error());
    const RenderOptions& base = checked->frames.front();
    Report report(base.quiet, base.verbosity);
    const auto jobs = std::make_shared<const Jobs>(base.threads);
    RaceReport out{cpu_name(), isa_name(base.isa), version(), jobs->threads(), base.frame.width, base.frame.height, checked->runs, {}, {}};
    Error none{ExitCode::unavailable, "", "--devices", "no device is given"};
    const std::vector<Opponent> devices = open_devices(*checked, out, none);
    if (devices.empty())
        return fail(none);
    const Result<std::shared_ptr<const Environment>> environment = open_environment(base.env, base.environment, base.limits, *jobs);
    if (!environment)
        return fail(environment.error());
    for (const std::string& warning : (*environment)->warnings)
        report.warning(warning);
    report.release();
    if (!checked->pictures.empty())
        if (const Status made = make_output_folder(checked->pictures); !made)
            return fail(made.error());
    Race bench{*checked, devices, *environment, jobs, report, out, Error{ExitCode::ok, "", "", ""}};
    for (std::size_t i = 0; i < checked->frames.size();) {
        const std::size_t first = i;
        while (i < checked->frames.size() && checked->frames[i].scene == checked->frames[first].scene)
            ++i;
        race_scene(bench, first, i);
    }
    report.promise_stdout({arguments.json, arguments.csv});
    report.figures(race_table(out));
    for (const auto& [path, text] : {std::pair{arguments.json, &race_json}, {arguments.csv, &race_csv}})
        if (!path.empty())
            if (const Status written = write_text(path, text(out)); !written)
                return fail(written.error());
    return bench.first_error.code == ExitCode::ok ? 0 : fail(bench.first_error);
}

OptionTable option_table(RaceArguments& to)
{
    RenderOptions& r = to.render.plain;
    const OptionTable of_render = render_option_table(to.render);
    OptionTable table;
    table.add("", {{"SCENE", "", "A .gltf or .glb file, or builtin:NAME; may be several", scenes(to.scenes)},
                   {"--techniques", "NAMES", "all, or names by commas; see burnish list techniques", techniques_value(to.techniques)},
                   {"--devices", "NAMES", "Devices, separated by commas; absent ones are named and left out", choices(to.devices, {})},
                   {"--shaders", "NAMES",
                    "Shaders, separated by commas: own (the kernels' text) and lean (as an engine would write it). With lean, neither "
                    "renderer draws the horizon and facets of normal maps, nor materials that let light through or blend",
                    choices(to.shaders, {std::begin(kRaceShaders), std::end(kRaceShaders)})},
                   {"--msaa", "N,N", "Samples a pixel, separated by commas", choices(to.msaa, {1, 2, 4, 8, 16})},
                   {"--runs", "N", "Timed frames for every row and renderer, in turn", integer(to.runs, 1, 10000)},
                   {"--json", "FILE", "Rows as JSON; - for standard output", file(to.json)},
                   {"--csv", "FILE", "Rows as CSV; - for standard output", file(to.csv)},
                   {"--pictures", "DIR", "Folder for a picture of each row: the tile renderer's frame, with the device's to its right",
                    folder(to.pictures)}});
    table.take(of_render, "",
               {"--size",
                {"--samples", "Samples of the techniques, if they take any", ""},
                "--env",
                "--env-size",
                "--key-lights",
                "--env-samples"});
    table.add("", {threads_option(r.threads, "Worker threads of the tile renderer"),
                   isa_option(r.isa),
                   {"--shader-folder", "DIR", "Folder with NAME.spv to replace the program's shaders, for tests of this command",
                    folder(r.vulkan.shader_folder)},
                   quiet_option(r.quiet),
                   verbose_option(r.verbosity, "Print rows as they come")});
    return table;
}

} // namespace

Command race_command()
{
    auto arguments = std::make_shared<RaceArguments>();
    return {"race", "Time the tile renderer against Vulkan's CPU devices", option_table(*arguments), kRaceFooter,
            [arguments](OptionTable& given) { return run_race(*arguments, given); }};
}

} // namespace burnish
