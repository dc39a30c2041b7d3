// `burnish profile`: shows how a frame's time is spent.
#include <chrono>
#include <fmt/core.h>
#include <memory>
#include <utility>

#include "apps/cli/command.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/values.h"
#include "apps/options/scene_with_view.h"
#include "apps/profile/report.h"
#include "apps/render/picture.h"
#include "apps/render/stats.h"
#include "core/base/text.h"
#include "raster/frame/upload.h"

namespace burnish {
namespace {

constexpr int kFrames = 10; // profiled frames without --frames

constexpr const char* kFooter =
    R"(After two warm-up frames, the frame is drawn 2 x --frames times (10), with and without clocks in turn. A stage's times are summed over
the threads. --trace shows every stage of every tile on its thread.

Examples:
  burnish profile
  burnish profile lamp.glb --technique major_axis --msaa 8 --json lamp.json --svg lamp.svg
  burnish profile builtin:spheres --threads 1 --frames 30 --trace spheres.trace)";

struct ProfileArguments {
    RenderArguments render;
    std::string json_file, svg_file; // empty: none; "-": standard output
};

Status check_files(const RenderOptions& options, const ProfileArguments& arguments, const std::vector<std::string>& inputs)
{
    return check_outputs(options.outputs, {{"--json", arguments.json_file}, {"--svg", arguments.svg_file}, {"--trace", options.trace_file}},
                         inputs);
}

void add(FrameProfile& to, const FrameProfile& more)
{
    const auto sum = [](auto& a, const auto& b) {
        if (a.size() < b.size())
            a.resize(b.size());
        for (std::size_t i = 0; i < b.size(); ++i)
            a[i] += b[i];
    };
    to.wall_ns += more.wall_ns;
    sum(to.busy_ns, more.busy_ns), sum(to.tile_ns, more.tile_ns);
    to.materials.resize(more.materials.size());
    for (std::size_t i = 0; i < more.materials.size(); ++i) {
        to.materials[i].ns += more.materials[i].ns;
        to.materials[i].lanes.used += more.materials[i].lanes.used, to.materials[i].lanes.all += more.materials[i].lanes.all;
    }
    for (std::size_t i = 0; i < kFrameStages; ++i) {
        to.stage_ns[i] += more.stage_ns[i];
        to.stage_lanes[i].used += more.stage_lanes[i].used, to.stage_lanes[i].all += more.stage_lanes[i].all;
    }
}

// Alternates frames with and without a profile, to measure the profile's cost; all show the same picture. Returns the last frame.
Result<Frame> measure(Renderer& renderer, FrameDesc desc, const std::string& scene, ProfileFigures& figures)
{
    std::vector<double> plain_ms, profiled_ms;
    Frame last;
    for (int i = -2; i < 2 * figures.frames; ++i) { // the first two warm up
        desc.profile = i % 2 != 0;
        Result<Frame> frame = renderer.render(desc, std::move(last));
        BN_TRY(frame);
        const std::uint64_t hash = pixel_hash(frame->color);
        if (i == -2)
            figures.hash = hash;
        else if (hash != figures.hash)
            return Error{ExitCode::differ, scene, fmt::format("frame {}", i + 2),
                         fmt::format("pixel hash {} differs from {} of the frames before", hash_text(hash), hash_text(figures.hash))};
        if (i >= 0) {
            (desc.profile ? profiled_ms : plain_ms).push_back(frame->stats.ms);
            if (desc.profile)
                add(figures.sum, frame->profile);
            figures.stats = frame->stats;
        }
        last = std::move(*frame);
    }
    figures.plain_ms = median(plain_ms), figures.profiled_ms = median(profiled_ms);
    return last;
}

Status write_files(const RenderOptions& options, const ProfileArguments& arguments, const ProfileFigures& figures)
{
    if (!arguments.json_file.empty())
        BN_TRY(write_text(arguments.json_file, profile_json(options, figures)));
    if (!arguments.svg_file.empty())
        BN_TRY(write_text(arguments.svg_file, profile_svg(options, figures)));
    if (!options.trace_file.empty())
        return write_text(options.trace_file, Trace::json());
    return {};
}

// Checks the options, and refuses options of other subcommands.
Result<RenderOptions> check_profile_options(const ProfileArguments& arguments, const OptionTable& given)
{
    Result<RenderOptions> checked = check_render_options(arguments.render, given);
    BN_TRY(checked);
    if (checked->backend != "tile")
        return usage_error("--backend", "only the tile renderer is profiled");
    if (!checked->stats_file.empty())
        return usage_error("--stats", "belongs to burnish render; here figures go to --json");
    for (const char* option : {"--aov", "--risks", "--animate", "--turntable", "--shadows", "--floor", "--budget", "--budget-p99",
                               "--budget-ms", "--plan", "--plan-out", "--verify"})
        if (given.given(option))
            return usage_error(option, "belongs to burnish render; here one picture is drawn, over and over");
    BN_TRY(check_files(*checked, arguments, {checked->scene, checked->env}));
    return checked;
}

// Loads the environment and makes the session. options: with the environment's name.
Result<Session> open_session(const RenderOptions& options, const ProfileArguments& arguments, const SceneWithView& seen,
                             const std::shared_ptr<const Jobs>& jobs, Report& report)
{
    const Result<std::shared_ptr<const Environment>> environment =
        open_environment(options.env, options.environment, options.limits, *jobs);
    BN_TRY(environment);
    BN_TRY(check_files(options, arguments, (*environment)->files));
    for (const std::string& warning : (*environment)->warnings)
        report.warning(warning);
    SessionOptions tile;
    tile.isa = options.isa;
    SessionParts parts = {seen.data, *environment, jobs, {}};
    BN_TRY(read_tables(options, parts, report));
    return Session::make(std::move(parts), tile);
}

// Returns the figures that are known before the first frame.
ProfileFigures start_figures(const Session& session, int frames)
{
    ProfileFigures figures;
    figures.device = session.device(), figures.threads = session.parts().jobs->threads();
    figures.frames = frames;
    for (const Material& material : session.scene().materials)
        figures.materials.push_back(material.name.empty() ? fmt::format("material {}", figures.materials.size()) : material.name);
    return figures;
}

Status write_pictures(const RenderOptions& options, const Frame& last, Report& report)
{
    const Image color = options.frame.background ? last.color : with_coverage(last.color, last.triangle_ids, last.through);
    for (const std::string& path : options.outputs) {
        const TraceSpan span("write picture");
        BN_TRY(write_picture(path, color, options.tonemap, options.exposure_ev, last.parts, options.resolve));
        report.wrote(path);
    }
    return {};
}

int run_profile(const ProfileArguments& arguments, const OptionTable& given)
{
    Result<RenderOptions> checked = check_profile_options(arguments, given);
    if (!checked)
        return fail(checked.error());
    RenderOptions& options = *checked;
    Report report(options.quiet, options.verbosity);
    for (const std::string& warning : options.warnings)
        report.warning(warning);
    const auto jobs = std::make_shared<const Jobs>(options.threads);
    const Result<SceneWithView> seen = load_scene_with_view(options.scene, options, report, *jobs);
    if (!seen)
        return fail(seen.error());
    const Scene& scene = seen->data->scene;
    if (Status files = check_files(options, arguments, scene.files); !files)
        return fail(files.error());
    if (const Status frame = check_frame(scene, options.frame); !frame)
        return fail(frame.error());
    options.env = light_name(options, *seen->data);
    Result<Session> session = open_session(options, arguments, *seen, jobs, report);
    if (!session)
        return fail(session.error());
    report.release();

    // Measure the frames
    FrameDesc desc = options.frame;
    desc.view = seen->view;
    desc.parts = needs_parts(options), desc.triangle_ids = !desc.background;
    ProfileFigures figures = start_figures(*session, given.given("--frames") ? options.frames : kFrames);
    if (!options.trace_file.empty())
        Trace::start();
    const Result<Frame> last = measure(session->renderer(), session->drawn(desc), options.scene, figures);
    if (!last)
        return fail(last.error());
    // Write the pictures and the report
    const std::uint64_t begin = Trace::now_ns();
    if (Status done = write_pictures(options, *last, report); !done)
        return fail(done.error());
    figures.write_ms = static_cast<double>(Trace::now_ns() - begin) * 1e-6;
    if (arguments.json_file != "-" && arguments.svg_file != "-") // standard output holds one thing only
        fmt::print("{}", printable_lines(profile_table(options, figures)));
    if (Status done = write_files(options, arguments, figures); !done)
        return fail(done.error());
    report.event("pixel hash:", hash_text(figures.hash));
    return 0;
}

} // namespace

Command profile_command()
{
    auto arguments = std::make_shared<ProfileArguments>();
    OptionTable table = render_option_table(arguments->render);
    table.add("Output", {{"--json", "FILE", "Figures as JSON; - for standard output", file(arguments->json_file)},
                         {"--svg", "FILE", "Flame graph as SVG; - for standard output", file(arguments->svg_file)}});
    return {"profile", "Show how a frame spends its time", table, kFooter,
            [arguments](OptionTable& given) { return run_profile(*arguments, given); }};
}

} // namespace burnish
