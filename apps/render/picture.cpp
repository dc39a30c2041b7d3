#include "apps/render/picture.h"

#include <chrono>
#include <fmt/core.h>
#include <utility>

#include "apps/cli/environment_text.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/stop_signal.h"
#include "apps/options/scene_view.h"
#include "apps/options/scene_with_view.h"
#include "core/base/check.h"
#include "core/image/image.h"
#include "core/image/io/image_io.h"
#include "raster/frame/upload.h"
#include "raster/session/mirror.h"
#include "raster/tile/twins.h"
#include "shading/bake/tables/phong_files.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

class Stopwatch {
  public:
    double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count(); }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now();
};

// Returns the names that --variant takes.
std::vector<std::string> named_variants(const Scene& scene)
{
    std::vector<std::string> names = scene.variants;
    names.erase(std::remove(names.begin(), names.end(), ""), names.end());
    return names;
}

void report_scene(const SceneData& data, Report& report)
{
    const Scene& scene = data.scene;
    report.event("scene", fmt::format("{}: {}, {}, {}, {}{}", data.name, counted(data.tables.triangle_count(), "triangle"),
                                      counted(scene.materials.size(), "material"), counted(scene.textures.size(), "texture"),
                                      counted(data.tables.lights.size(), "light"),
                                      data.tables.area_lights.empty() ? "" : ", " + counted(data.tables.area_lights.size(), "area light")));
    if (!named_variants(scene).empty())
        report.event("variants", printable(join(named_variants(scene))));
    for (const std::string& warning : scene.warnings)
        report.warning(warning);
}

void report_environment(const Environment& environment, double ms, Report& report)
{
    report.event("environment", fmt::format("{}: {}; {}", environment.name, light_text(environment),
                                            environment.from_cache ? fmt::format("from the cache in {:.0f} ms", ms)
                                                                   : fmt::format("baked in {:.0f} ms", ms)));
    report_extracted_lights(environment, report);
}

// Without a background, coverage becomes the alpha channel.
bool draws_alpha(const RenderOptions& options)
{
    return !options.frame.background;
}

} // namespace

Status write_rendered(const std::string& path, const Rendered& rendered, const RenderOptions& options, const Jobs* jobs)
{
    if (!options.aov.empty() && stores_channels(path))
        return write_channels(path, rendered.layered.image, rendered.layered.names);
    if (!rendered.shown.empty())
        return write_image(path, rendered.shown);
    return write_picture(path, rendered.color, options.tonemap, options.exposure_ev, rendered.parts, options.resolve, jobs);
}

Status check_paths(const RenderOptions& options, const std::vector<std::string>& inputs)
{
    std::vector<std::string> pictures = options.outputs;
    if (!options.variance_file.empty())
        pictures.push_back(options.variance_file);
    if (!options.risks.empty() && options.risks != "-")
        pictures.push_back(options.risks);
    std::vector<std::string> read = inputs;
    if (!options.plan_file.empty())
        read.push_back(options.plan_file);
    return check_outputs(pictures,
                         {{"--stats", options.stats_file},
                          {"--trace", options.trace_file},
                          {"--checkpoint", options.reference.checkpoint},
                          {"--plan-out", options.plan_out}},
                         read);
}

SessionOptions session_options(const RenderOptions& options, std::optional<Error>& lost_checkpoint)
{
    SessionOptions session;
    session.backend = options.backend == "reference" ? Backend::reference : options.backend == "vulkan" ? Backend::vulkan : Backend::tile;
    session.isa = options.isa;
    session.vulkan = options.vulkan;
    session.reference = options.reference;
    if (session.backend == Backend::reference && (!options.reference.checkpoint.empty() || options.in_pieces))
        session.reference.stop = &watch_stop_signals();
    session.reference.lost_checkpoint = [&lost_checkpoint](const Error& error) { lost_checkpoint = error; };
    return session;
}

std::string light_name(const RenderOptions& options, const SceneData& scene)
{
    return options.env_given ? options.env : default_environment(scene);
}

Result<std::shared_ptr<const Environment>> open_light(const RenderOptions& options, const SceneData& scene, const Jobs& jobs)
{
    EnvironmentOptions environment = options.environment;
    environment.picture_only = options.backend == "reference";
    return open_environment(light_name(options, scene), environment, options.limits, jobs);
}

Status read_tables(const RenderOptions& options, SessionParts& parts, Report& report)
{
    if (!options.ltc_table.empty()) {
        Result<std::shared_ptr<const ltc::ShadingTables>> table = load_ltc_table(options.ltc_table, options.frame.brdf);
        BN_TRY(table);
        parts.ltc = std::move(*table);
    }
    if (!options.as_tables.empty()) {
        Result<std::shared_ptr<const PhongFiles>> tables = load_phong_tables(options.as_tables, options.limits);
        BN_TRY(tables);
        if (find_technique(options.frame.technique)->traits & kPhongGrid)
            for (const std::string& warning : (*tables)->warnings(options.frame.samples))
                report.warning(warning);
        parts.phong = std::move(*tables);
    }
    return {};
}

Result<Session> prepare(const RenderOptions& options, RenderFigures& figures, std::optional<Error>& lost_checkpoint, Report& report)
{
    SessionParts parts;
    parts.jobs = std::make_shared<const Jobs>(options.threads);
    figures.threads = parts.jobs->threads();
    BN_TRY(read_tables(options, parts, report));
    // Load the scene, and check it against the options
    const Stopwatch load;
    {
        const TraceSpan span("load scene");
        FloorSettings floor = floor_of(options);
        floor.use_cache = options.environment.use_cache;
        const Result<std::shared_ptr<const SceneData>> data = open_scene(options.scene, options.limits, options.overrides, options.mips,
                                                                         options.moment, options.lights, floor, parts.jobs.get());
        BN_TRY(data);
        parts.scene = *data;
    }
    figures.load_ms = load.ms();
    report_scene(*parts.scene, report);
    if (options.backend != "reference") // the reference bakes nothing, so it checks later
        BN_TRY(check_frame(parts.scene->scene, options.frame));
    BN_TRY(choose_view(options, parts.scene->scene, parts.scene->tables));
    if (options.shadows == Shadows::ratio && parts.scene->tables.area_lights.empty())
        report.warning("--shadows has no effect: nothing in the scene is an area light");
    if (options.backend != "reference")
        warn_of_glass(*parts.scene, report);

    // Open and bake the environment
    const Stopwatch bake;
    {
        const TraceSpan span("environment");
        const Result<std::shared_ptr<const Environment>> environment = open_light(options, *parts.scene, *parts.jobs);
        BN_TRY(environment);
        parts.environment = *environment;
    }
    figures.bake_ms = bake.ms();
    BN_TRY(check_paths(options, parts.environment->files));
    if (options.shadows == Shadows::on && parts.scene->tables.lights.empty() && parts.scene->tables.area_lights.empty() &&
        parts.environment->extracted_lights.empty())
        report.warning("--shadows has no effect: there are no lights besides the environment");
    figures.env = parts.environment->name;
    figures.environment_from_cache = parts.environment->from_cache;
    figures.extracted_lights = turned_extracted_lights(*parts.environment);
    report_environment(*parts.environment, figures.bake_ms, report);
    for (const std::string& warning : parts.environment->warnings)
        report.warning(warning);

    // Make the renderer
    const Stopwatch make;
    const TraceSpan span("prepare renderer");
    Result<Session> session = Session::make(std::move(parts), session_options(options, lost_checkpoint));
    if (session)
        figures.device = session->device();
    figures.prepare_ms = make.ms();
    return session;
}

Result<Rendered> render_frames(const RenderOptions& options, FrameDesc desc, Session& session, RenderFigures figures)
{
    Rendered out;
    Frame last;
    // Ask for the frame's extra outputs
    desc.triangle_ids = desc.triangle_ids || draws_alpha(options);
    desc.parts = needs_parts(options);
    BN_TRY(ask_for_layers(options.aov, desc));
    if (options.show == Shown::lod && session.parts().scene->scene.textures.empty())
        return usage_error("--show", fmt::format("lod: nothing in {} has a texture", options.scene));
    const ShadowSettings shadow_settings{options.shadows, options.shadow_samples, options.isa, options.quiet};
    const bool shadows = casts_shadows(shadow_settings, desc, session);
    const bool mirrors = options.floor == FloorChoice::mirror && options.backend != "reference";
    desc.triangle_ids = desc.triangle_ids || mirrors;
    desc.layers = desc.layers || shadows || options.show != Shown::light;
    Progress progress("frames", static_cast<std::size_t>(options.frames), options.quiet || options.frames == 1);
    // Render the frames, and compare their hashes
    for (int i = 0; i < options.frames; ++i) {
        const TraceSpan span("frame");
        Result<Frame> frame = session.render_any(desc, std::move(last));
        BN_TRY(frame);
        const std::uint64_t hash = pixel_hash(frame->color);
        if (i > 0 && hash != figures.hash)
            return Error{ExitCode::differ, options.scene, fmt::format("frame {}", i),
                         fmt::format("pixel hash {} differs from {} of the frames before", hash_text(hash), hash_text(figures.hash))};
        figures.hash = hash;
        figures.frame = frame->stats;
        figures.frame_ms.push_back(frame->stats.ms);
        last = std::move(*frame);
        progress.step();
    }
    if (options.counts_operations && options.backend == "tile") {
        Result<CountedFrame> counted = draw_counted(session.parts().input(), session.drawn(desc));
        BN_TRY(counted);
        BN_CHECK(pixel_hash(counted->frame.color) == figures.hash);
        figures.work = counted->work;
    }
    // Add shadows, reflections, false colours and risks
    if (shadows) {
        BN_TRY(add_shadows(shadow_settings, desc, session, last));
        figures.hash = pixel_hash(last.color);
    }
    if (mirrors) {
        BN_TRY(add_reflection(shadow_settings, desc, session, last));
        figures.hash = pixel_hash(last.color);
    }
    if (options.show != Shown::light)
        out.shown = false_colour(options.show, last, desc.view);
    if (!options.risks.empty()) {
        const TraceSpan span("risks");
        Result<RiskMap> risks = mark_risks(session, desc);
        BN_TRY(risks);
        out.risks = std::move(*risks);
    }
    // Move the results out
    out.color = std::move(last.color), out.variance = std::move(last.variance);
    figures.nan_pixels = count_not_finite(out.color);
    if (draws_alpha(options))
        out.color = with_coverage(out.color, last.triangle_ids, last.through);
    if (!options.aov.empty()) {
        Result<NamedChannels> layered = with_layers(out.color, last, session.tables(), options.aov);
        BN_TRY(layered);
        out.layered = std::move(*layered);
    }
    out.parts = std::move(last.parts), out.profile = std::move(last.profile);
    out.figures = std::move(figures);
    return out;
}

} // namespace burnish
