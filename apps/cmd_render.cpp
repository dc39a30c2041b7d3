// `burnish render`: a scene under an environment to pictures and figures.
#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <utility>

#include "apps/command.h"
#include "apps/loaded_scene.h"
#include "apps/outputs.h"
#include "apps/render_options.h"
#include "apps/render_stats.h"
#include "apps/report.h"
#include "apps/scene_view.h"
#include "apps/stop_signal.h"
#include "core/image/image_io.h"
#include "core/scene/gltf.h"

namespace burnish {
namespace {


class Stopwatch {
  public:
    double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count(); }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now();
};

// Everything that is made once and drawn from many times. The renderer refers to the rest, so it stays where
// it is.
struct Stage {
    Scene scene;
    DrawTables tables;
    Environment environment;
    DfgTable dfg;
    std::unique_ptr<Renderer> renderer;
};

struct Rendered {
    Image color, variance;
    RenderFigures figures;
};

// `inputs`: files that must not be written over.
Status check_paths(const RenderOptions& options, const std::vector<std::string>& inputs)
{
    std::vector<std::string> pictures = options.outputs;
    if (!options.variance_file.empty())
        pictures.push_back(options.variance_file);
    return check_outputs(pictures, {{"--stats", options.stats_file}, {"--trace", options.trace_file}, {"--checkpoint", options.reference.checkpoint}}, inputs);
}

void report_scene(const RenderOptions& options, const Stage& stage, Report& report)
{
    const Scene& scene = stage.scene;
    report.event("scene", fmt::format("{}: {} triangles, {} materials, {} textures, {} lights", options.scene,
                                      stage.tables.triangle_count(), scene.materials.size(),
                                      scene.textures.size(), stage.tables.lights.size()));
    for (const std::string& warning : scene.warnings)
        report.warning(warning);
}

void report_environment(const RenderOptions& options, const Environment& environment, double ms,
                        Report& report)
{
    report.event("environment",
                 fmt::format("{}: mean radiance {:.6g} in the source, {:.6g} in the cube, peak {:.6g}; {}",
                             options.env, environment.energy_source, environment.energy_cube,
                             static_cast<double>(environment.peak_source),
                             environment.from_cache ? fmt::format("from the cache in {:.0f} ms", ms)
                                                    : fmt::format("baked in {:.0f} ms", ms)));
}

Status prepare(const RenderOptions& options, const Jobs& jobs, Stage& stage, RenderFigures& figures,
               Report& report)
{
    const Stopwatch load;
    {
        const TraceSpan span("load scene");
        Result<Scene> scene = load_scene(options.scene, options.limits);
        if (!scene)
            return scene.error();
        stage.scene = std::move(*scene);
        update_world(stage.scene);
        if (Status size = check_draw_size(stage.scene, options.limits, options.scene); !size)
            return size.error();
        stage.tables = make_draw_tables(stage.scene);
    }
    figures.load_ms = load.ms();
    report_scene(options, stage, report);

    const Stopwatch bake;
    {
        const TraceSpan span("environment");
        Result<Environment> environment =
            load_environment(options.env, options.environment, options.limits, jobs);
        if (!environment)
            return environment.error();
        stage.environment = std::move(*environment);
    }
    figures.bake_ms = bake.ms();
    figures.environment_from_cache = stage.environment.from_cache;
    report_environment(options, stage.environment, figures.bake_ms, report);

    const Stopwatch make;
    const TraceSpan span("prepare renderer");
    stage.dfg = bake_dfg(kDfgSize, kDfgSamples, jobs);
    const RenderInput input{stage.scene, stage.tables, stage.environment, stage.dfg, jobs};
    if (options.backend == "reference") {
        ReferenceOptions reference = options.reference;
        if (!reference.checkpoint.empty())
            reference.stop = &watch_stop_signals();
        Result<std::unique_ptr<Renderer>> renderer = make_reference_renderer(input, reference);
        if (!renderer)
            return renderer.error();
        stage.renderer = std::move(*renderer);
    } else if (options.backend == "vulkan") {
        const Result<std::shared_ptr<VulkanDevice>> device = open_vulkan_device(options.vulkan);
        if (!device)
            return device.error();
        Result<std::unique_ptr<Renderer>> renderer = make_vulkan_renderer(input, *device);
        if (!renderer)
            return renderer.error();
        stage.renderer = std::move(*renderer);
    } else {
        stage.renderer = make_tile_renderer(input, options.isa);
    }
    figures.prepare_ms = make.ms();
    figures.device = stage.renderer->device();
    return {};
}

// All frames show the same picture: a renderer that does not repeat itself is caught here.
Result<Rendered> render_frames(const RenderOptions& options, const FrameDesc& desc, Renderer& renderer,
                               RenderFigures figures)
{
    Rendered out;
    Frame last;
    Progress progress("frames", static_cast<std::size_t>(options.frames), options.quiet || options.frames == 1);
    for (int i = 0; i < options.frames; ++i) {
        const TraceSpan span("frame");
        Result<Frame> frame = renderer.render(desc, std::move(last));
        if (!frame)
            return frame.error();
        const std::uint64_t hash = pixel_hash(frame->color);
        if (i > 0 && hash != figures.hash)
            return Error{ExitCode::differ, options.scene, fmt::format("frame {}", i),
                         fmt::format("pixel hash {} differs from {} of the frames before", hash_text(hash),
                                     hash_text(figures.hash))};
        figures.hash = hash;
        figures.frame = frame->stats;
        figures.frame_ms.push_back(frame->stats.ms);
        last = std::move(*frame);
        progress.step();
    }
    out.color = std::move(last.color), out.variance = std::move(last.variance);
    figures.nan_pixels = count_not_finite(out.color);
    out.figures = std::move(figures);
    return out;
}

void report_reference(const RenderOptions& options, const RenderFigures& figures, Report& report)
{
    const SamplingStats& s = figures.frame.sampling;
    const std::string before = s.resumed ? fmt::format(", {} of them from {}", s.samples_before, options.reference.checkpoint) : "";
    report.event("reference", fmt::format("{}x{}, {}, {} samples a pixel{}: {:.1f} s, {:.2f} million samples/s, {:.0f} % of the time in rays, "
                                          "relative error {:.3g}",
                                          options.frame.width, options.frame.height, options.reference_mode_name, s.samples, before,
                                          figures.frame.ms * 1e-3, s.million_samples_per_second, s.ray_share * 100.0, s.relative_error));
}

void report_frames(const RenderOptions& options, const RenderFigures& figures, Report& report)
{
    if (options.backend == "reference")
        return report_reference(options, figures, report);
    const FrameDesc& frame = options.frame;
    const std::vector<double>& ms = figures.frame_ms;
    const std::string times =
        ms.size() == 1 ? fmt::format("{:.2f} ms", ms[0])
                       : fmt::format("median {:.2f} ms, min {:.2f}, p95 {:.2f} over {} frames", median(ms),
                                     *std::min_element(ms.begin(), ms.end()), percentile_95(ms), ms.size());
    report.event("frame", fmt::format("{}x{}, {} samples a pixel, {}: {}", frame.width, frame.height,
                                      frame.msaa, frame.technique, times));
    if (figures.frame.samples_emulated)
        report.event("samples", fmt::format("emulated: {} passes of one sample, as the device cannot take {} at once", frame.msaa, frame.msaa));
    if (figures.frame.depth_interpolated)
        report.event("depth", "interpolated by the device, which has no 64-bit floats: equal depths may be ordered otherwise");
    report.detail("fragments",
                  fmt::format("{} shaded, {} of {} triangles drawn, {} pixels show the background",
                              figures.frame.visible_fragments, figures.frame.triangles_drawn,
                              figures.frame.triangles, figures.frame.background_pixels));
}

// Tries every output even where one fails; the first failure decides.
Status write_outputs(const RenderOptions& options, const Rendered& rendered, Report& report)
{
    Status first;
    const auto note = [&](const std::string& path, const Status& status) {
        if (status)
            report.event("wrote", path);
        else if (first)
            first = status;
        else
            fail(status.error());
    };
    for (const std::string& path : options.outputs) {
        const TraceSpan span("write picture");
        note(path, write_picture(path, rendered.color, options.tonemap, options.exposure_ev));
    }
    if (!options.variance_file.empty())
        note(options.variance_file, write_image(options.variance_file, rendered.variance));
    if (!options.stats_file.empty())
        note(options.stats_file, write_text(options.stats_file, stats_json(options, rendered.figures)));
    if (!options.trace_file.empty())
        note(options.trace_file, write_text(options.trace_file, Trace::json()));
    return first;
}

int finish(const RenderOptions& options, const Rendered& rendered, Report& report)
{
    const Status written = write_outputs(options, rendered, report);
    report.event("pixel hash:", hash_text(rendered.figures.hash));
    int code = 0;
    if (rendered.figures.nan_pixels)
        code = fail(Error{ExitCode::not_finite, options.scene, "",
                          fmt::format("{} of {} pixels are NaN or Inf", rendered.figures.nan_pixels,
                                      std::int64_t{options.frame.width} * options.frame.height)});
    return written ? code : fail(written.error());
}

int run_render(const RenderArguments& arguments)
{
    Result<RenderOptions> checked = check_render_options(arguments);
    if (!checked)
        return fail(checked.error());
    const RenderOptions& options = *checked;
    if (Status paths = check_paths(options, {options.scene, options.env}); !paths)
        return fail(paths.error());
    if (!options.trace_file.empty())
        Trace::start();

    Report report(options.quiet, options.verbosity);
    for (const std::string& warning : options.warnings)
        report.warning(warning);
    const Jobs jobs(options.threads);
    RenderFigures figures;
    figures.threads = jobs.threads();
    Stage stage;
    if (Status ready = prepare(options, jobs, stage, figures, report); !ready)
        return fail(ready.error());
    if (Status paths = check_paths(options, stage.scene.files); !paths) // textures and buffers are known now
        return fail(paths.error());
    const Result<ChosenView> view = choose_view(options, stage.scene, stage.tables);
    if (!view)
        return fail(view.error());
    report.detail("camera",
                  fmt::format("{}, world to clip {}", view->description, describe_matrix(view->view)));
    report.detail("device", fmt::format("{}, {} threads", figures.device, figures.threads));
    FrameDesc desc = options.frame;
    desc.view = view->view;
    if (Status checkpoint = check_reference_checkpoint({stage.scene, stage.tables, stage.environment, stage.dfg, jobs}, desc, options.reference);
        !checkpoint)
        return fail(checkpoint.error());
    report.release();
    const Result<Rendered> rendered = render_frames(options, desc, *stage.renderer, std::move(figures));
    if (!rendered)
        return fail(rendered.error());
    report_frames(options, rendered->figures, report);
    if (rendered->figures.frame.sampling.stopped) {
        report.event("stopped", fmt::format("the same command goes on from {}; no picture was written", options.reference.checkpoint));
        return 128 + stop_signal(); // as a shell reports a process that a signal ended
    }
    return finish(options, *rendered, report);
}

} // namespace

Command add_render(CLI::App& program)
{
    CLI::App* app = program.add_subcommand("render", "Render a scene to pictures");
    auto arguments = std::make_shared<RenderArguments>();
    add_render_options(*app, *arguments);
    return {app, [arguments] { return run_render(*arguments); }};
}

} // namespace burnish
