// `burnish race`: the tile renderer against Vulkan's CPU devices at the same picture.
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "apps/chart_plan.h"
#include "apps/command.h"
#include "apps/loaded_scene.h"
#include "apps/outputs.h"
#include "apps/parse.h"
#include "apps/race_report.h"
#include "apps/render_stats.h"
#include "core/base/clock.h"
#include "core/base/version.h"
#include "core/image/flip.h"
#include "core/image/metrics.h"
#include "core/simd/cpu.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(The tile renderer and each device draw the same frame in turn, warm; the device by the classical pipeline with its own samplers, timed
from submission to the fence. The ratio is of the process' CPU time, device over tile: above 1 the tile renderer needs less. A frame that
differs (mean FLIP above 0.01) is marked and counts for nothing. A row that fails is reported, and its exit code given at the end.

Examples:
  burnish race
  burnish race builtin:spheres --techniques major_axis,mc --size 1920x1080 --msaa 1,4 --json race.json)";

struct RaceArguments {
    RenderArguments render;
    std::vector<std::string> scenes;
    std::string techniques = "all", devices = "lavapipe,swiftshader", msaa = "1,4", runs = "5", json;
};

struct Timed {
    std::vector<double> wall_ms, cpu_ms;
    Image picture;
};

// The frame before, whose memory is used again.
Status draw_tile(Renderer& tile, const FrameDesc& desc, Frame& frame, Timed& into)
{
    const double wall = wall_ms(), cpu = process_cpu_ms();
    Result<Frame> drawn = tile.render(desc, std::move(frame));
    into.cpu_ms.push_back(process_cpu_ms() - cpu);
    into.wall_ms.push_back(wall_ms() - wall);
    if (!drawn)
        return drawn.error();
    frame = std::move(*drawn);
    return {};
}

Status draw_device(Renderer& device, const FrameDesc& desc, Frame& frame, Timed& into)
{
    Result<Frame> drawn = device.render(desc, std::move(frame));
    if (!drawn)
        return drawn.error();
    into.cpu_ms.push_back(drawn->stats.device_cpu_ms), into.wall_ms.push_back(drawn->stats.device_ms);
    frame = std::move(*drawn);
    return {};
}

// A B A B: whatever slows the machine slows both. The first round is not counted: pipelines are made in it.
Result<RaceRow> race(Renderer& tile, Renderer& device, const FrameDesc& desc, int runs, const Jobs& jobs)
{
    Timed a, b;
    Frame of_tile, of_device;
    for (int i = 0; i <= runs; ++i) {
        if (const Status drawn = draw_tile(tile, desc, of_tile, a); !drawn)
            return drawn.error();
        if (const Status drawn = draw_device(device, desc, of_device, b); !drawn)
            return drawn.error();
        if (i == 0)
            a = Timed(), b = Timed();
    }
    RaceRow row;
    row.technique = desc.technique, row.samples = desc.samples, row.msaa = desc.msaa;
    row.tile_ms = median(a.wall_ms), row.device_ms = median(b.wall_ms);
    row.tile_cpu_ms = median(a.cpu_ms), row.device_cpu_ms = median(b.cpu_ms);
    row.flip_mean = not_finite_pixels(of_tile.color, of_device.color)
                        ? 1.0
                        : summarise_errors(flip_hdr(of_tile.color, of_device.color, {}, jobs).error).mean;
    return row;
}

RaceRow failed_row(const FrameDesc& desc, const Error& error)
{
    RaceRow row;
    row.technique = desc.technique, row.samples = desc.samples, row.msaa = desc.msaa, row.error = error.line();
    return row;
}

// Every frame to be raced, with its scene.
struct RacePlan {
    std::vector<RenderOptions> frames; // by scene, technique, msaa
    std::vector<std::string> devices;
    int runs = 5;
};

Result<RacePlan> check(const RaceArguments& in)
{
    RacePlan plan;
    const Result<std::vector<std::string>> techniques = parse_techniques(in.techniques);
    if (!techniques)
        return techniques.error();
    RenderArguments arguments = in.render;
    arguments.plain.backend = "vulkan", arguments.pipeline = "forward", arguments.sampler = "native";
    for (const std::string& scene : in.scenes.empty() ? std::vector<std::string>{"builtin:teapot"} : in.scenes)
        for (const std::string& technique : *techniques)
            for (const std::string& msaa : split(in.msaa, ',')) {
                if (msaa.empty())
                    return usage_error("--msaa", "holds an empty entry");
                arguments.plain.scene = scene, arguments.technique = technique, arguments.msaa = msaa;
                const Result<RenderOptions> checked = check_render_options(arguments);
                if (!checked)
                    return checked.error();
                plan.frames.push_back(*checked);
            }
    plan.devices = split(in.devices, ',');
    for (const std::string& device : plan.devices)
        if (device.empty())
            return usage_error("--devices", "holds an empty name");
    const Result<std::int64_t> runs = parse_integer("--runs", in.runs, 1, 10000);
    if (!runs)
        return runs.error();
    plan.runs = static_cast<int>(*runs);
    std::vector<std::string> inputs = in.scenes;
    inputs.push_back(in.render.plain.env);
    if (const Status writable = check_outputs({}, {{"--json", in.json}}, inputs); !writable)
        return writable.error();
    return plan;
}

// Those that are there; the others get a note.
std::vector<std::shared_ptr<VulkanDevice>> open_devices(const RacePlan& plan, RaceReport& report, Error& last)
{
    std::vector<std::shared_ptr<VulkanDevice>> devices;
    for (const std::string& name : plan.devices) {
        VulkanOptions options = plan.frames.front().vulkan;
        options.device = name, options.centroid = true; // as cheap as the device can
        const Result<std::shared_ptr<VulkanDevice>> device = open_vulkan_device(options);
        if (!device) {
            last = device.error();
            report.notes.push_back(name + ": " + last.line());
            continue;
        }
        devices.push_back(*device);
        if ((*device)->info().name.find("SwiftShader") != std::string::npos)
            report.notes.push_back("SwiftShader snaps vertices to 1/16 pixel, so its edges differ by design, and is slow where the level of detail "
                                   "varies inside a quad");
    }
    return devices;
}

// What all scenes share.
struct Race {
    const RacePlan& plan;
    const std::vector<std::shared_ptr<VulkanDevice>>& devices;
    const Environment& environment;
    const DfgTable& dfg;
    const Jobs& jobs;
    Report& report;
    RaceReport& out;
    Error first_error; // what a row failed of, 77 only where nothing worse; the others are raced nevertheless
};

void add_row(Race& bench, const RenderOptions& frame, std::size_t device, const Result<RaceRow>& raced)
{
    RaceRow row = raced ? *raced : failed_row(frame.frame, raced.error());
    if (!raced && (bench.first_error.code == ExitCode::ok || bench.first_error.code == ExitCode::unavailable))
        bench.first_error = raced.error();
    row.scene = frame.scene, row.device = bench.devices[device]->info().name;
    const std::string outcome = raced ? fmt::format("{:.2f}", row.ratio()) : row.error;
    bench.report.detail("row", fmt::format("{} {} {}x {}: {}", row.scene, row.technique, row.msaa, row.device, outcome));
    bench.out.rows.push_back(row);
}

// Frames first to last - 1 of the plan, which are of one scene.
void race_scene(Race& bench, std::size_t first, std::size_t last)
{
    const std::vector<RenderOptions>& frames = bench.plan.frames;
    const Result<std::unique_ptr<LoadedScene>> scene = load_seen_scene(frames[first].scene, frames[first], bench.report);
    if (!scene) {
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t d = 0; d < bench.devices.size(); ++d)
                add_row(bench, frames[i], d, scene.error());
        return;
    }
    const RenderInput input{(*scene)->scene, (*scene)->tables, bench.environment, bench.dfg, bench.jobs};
    const std::unique_ptr<Renderer> tile = make_tile_renderer(input, frames[first].isa);
    std::vector<Result<std::unique_ptr<Renderer>>> renderers;
    for (const auto& device : bench.devices)
        renderers.push_back(make_vulkan_renderer(input, device));
    for (std::size_t i = first; i < last; ++i)
        for (std::size_t d = 0; d < bench.devices.size(); ++d) {
            FrameDesc desc = frames[i].frame;
            desc.view = (*scene)->view;
            add_row(bench, frames[i], d, renderers[d] ? race(*tile, **renderers[d], desc, bench.plan.runs, bench.jobs) : Result<RaceRow>(renderers[d].error()));
        }
}

int run_race(const RaceArguments& arguments)
{
    const Result<RacePlan> checked = check(arguments);
    if (!checked)
        return fail(checked.error());
    const RenderOptions& base = checked->frames.front();
    Report report(base.quiet, base.verbosity);
    const Jobs jobs(base.threads);
    RaceReport out{cpu_name(), isa_name(base.isa), version(), jobs.threads(), base.frame.width, base.frame.height, checked->runs, {}, {}};
    Error none{ExitCode::unavailable, "", "--devices", "no device is given"};
    const std::vector<std::shared_ptr<VulkanDevice>> devices = open_devices(*checked, out, none);
    if (devices.empty())
        return fail(none);
    const Result<Environment> environment = load_environment(base.env, base.environment, base.limits, jobs);
    if (!environment)
        return fail(environment.error());
    const DfgTable dfg = bake_dfg(kDfgSize, kDfgSamples, jobs);
    report.release();
    Race bench{*checked, devices, *environment, dfg, jobs, report, out, Error{ExitCode::ok, "", "", ""}};
    for (std::size_t i = 0; i < checked->frames.size();) {
        const std::size_t first = i;
        while (i < checked->frames.size() && checked->frames[i].scene == checked->frames[first].scene)
            ++i;
        race_scene(bench, first, i);
    }
    if (!base.quiet)
        std::fputs(race_table(out).c_str(), stderr);
    if (!arguments.json.empty())
        if (const Status written = write_text(arguments.json, race_json(out)); !written)
            return fail(written.error());
    return bench.first_error.code == ExitCode::ok ? 0 : fail(bench.first_error);
}

} // namespace

Command add_race(CLI::App& program)
{
    CLI::App* app = program.add_subcommand("race", "Time the tile renderer against Vulkan's CPU devices");
    auto arguments = std::make_shared<RaceArguments>();
    RaceArguments& to = *arguments;
    const auto option = [app](const char* name, std::string& text, const char* help, const char* type) {
        app->add_option(name, text, help)->type_name(type);
    };
    app->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app->add_option("SCENE", to.scenes, "A .gltf or .glb file, or builtin:NAME; may be several (builtin:teapot)");
    option("--techniques", to.techniques, "all, or names by commas; see burnish list techniques (all)", "NAMES");
    option("--devices", to.devices, "By commas; those that are absent are named and left out (lavapipe,swiftshader)", "NAMES");
    option("--msaa", to.msaa, "Samples a pixel, by commas (1,4)", "N,N");
    option("--runs", to.runs, "Timed frames of every row and renderer, in turn (5)", "N");
    option("--json", to.json, "Rows as JSON; - for standard output", "FILE");
    option("--size", to.render.size, "Width and height in pixels (1280x720)", "WxH");
    option("--samples", to.render.samples, "Samples of the techniques, where they take any", "N");
    option("--env", to.render.plain.env, "Equirectangular picture or builtin:NAME (builtin:studio)", "FILE");
    option("--env-size", to.render.env_size, "Texels along a cube edge, a power of two (512)", "N");
    option("--env-samples", to.render.env_samples, "Samples a texel of the prefiltered levels (1024)", "N");
    option("--threads", to.render.threads, "Worker threads of the tile renderer (all cores)", "N");
    option("--isa", to.render.isa, "scalar, avx2 or avx512 (the best one)", "NAME");
    app->add_flag("-q,--quiet", to.render.plain.quiet, "Print errors only");
    app->add_flag("-v,--verbose", to.render.plain.verbosity, "Print rows as they come");
    refuse_empty_values(*app);
    app->get_option("SCENE")->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app->footer(kFooter);
    return {app, [arguments] { return run_race(*arguments); }};
}

} // namespace burnish
