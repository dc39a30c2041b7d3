// `burnish render`: renders a scene under an environment to pictures and statistics.
#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/cli/words.h"
#include "apps/options/scene_view.h"
#include "apps/render/bands.h"
#include "apps/render/picture.h"
#include "apps/render/planned.h"
#include "apps/render/reference_pieces.h"
#include "core/image/io/image_io.h"
#include "raster/frame/upload.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(Pictures: .exr .hdr .pfm hold linear Rec.709 radiance as rendered; .png .jpg .tif are exposed, tonemapped and
encoded as sRGB. A file appears under its name only when it is complete. Without -o, the program renders the
frame and prints its figures.

Examples:
  burnish render -o teapot.png
  burnish render lamp.glb --env workshop.hdr --size 1920x1080 --msaa 8 -o lamp.png -o lamp.exr --stats lamp.json
  burnish render lamp.glb --eye 0.2,0.3,1.5 --target 0,0.2,0 --fov 30 -o close.png
  burnish render builtin:spheres --env builtin:sky --env-rotation 90 --exposure -1 -o spheres.png
  burnish render builtin:plate --frames 50 --threads 2 --isa avx2 --stats -
  burnish render --backend vulkan --device lavapipe -o teapot.png
  burnish render builtin:plate --animate roughness=0.1:0.6,tilt=0,0:20,0 --steps 30 -o plate_%03d.png
  burnish render lamp.glb --turntable 60 -o lamp_%03d.png
  burnish render --backend reference --samples 4096 --checkpoint teapot.part -o teapot.exr --variance teapot_var.exr)";

void report_reference(const RenderOptions& options, const RenderFigures& figures, Report& report)
{
    const SamplingStats& s = figures.frame.sampling;
    const std::string before = s.resumed ? fmt::format(", {} of them from {}", s.samples_before, options.reference.checkpoint) : "";
    report.event("reference",
                 fmt::format("{}x{}, {}, {} samples a pixel{}: {:.1f} s, {:.2f} million samples/s, {:.0f} % of the time in rays{}",
                             options.frame.width, options.frame.height, reference_mode_name(options), s.samples, before,
                             figures.frame.ms * 1e-3, s.million_samples_per_second, s.ray_share * 100.0,
                             std::isfinite(s.relative_error) ? fmt::format(", relative error {:.3g}", s.relative_error) : ""));
}

void report_frames(const RenderOptions& options, const RenderFigures& figures, Report& report)
{
    if (options.backend == "reference")
        return report_reference(options, figures, report);
    const FrameDesc& frame = options.frame;
    const std::vector<double>& ms = figures.frame_ms;
    const std::string times = ms.size() == 1 ? fmt::format("{:.2f} ms", ms[0])
                                             : fmt::format("median {:.2f} ms, min {:.2f}, p95 {:.2f} over {} frames", median(ms),
                                                           *std::min_element(ms.begin(), ms.end()), percentile_95(ms), ms.size());
    report.event("frame", fmt::format("{}x{}, {} samples a pixel, {}: {}", frame.width, frame.height, frame.msaa,
                                      figures.planned ? "by the plan" : frame.technique, times));
    if (figures.frame.samples_emulated)
        report.event("samples",
                     fmt::format("emulated: {} passes of one sample, as the device cannot take {} at once", frame.msaa, frame.msaa));
    if (figures.frame.depth_interpolated)
        report.warning(
            "the device has no 64-bit floats: it interpolates depth, so equal depths may be ordered otherwise, and triangles that "
            "reach a million times as far as the near plane may lack pieces");
    report.detail("fragments",
                  fmt::format("{} shaded, {} of {} triangles drawn, {} pixels show the background", figures.frame.visible_fragments,
                              figures.frame.triangles_drawn, figures.frame.triangles, figures.frame.background_pixels));
}

// Tries every output even after one fails. Returns the first failure.
Status write_outputs(const RenderOptions& options, const Rendered& rendered, const Jobs& jobs, Report& report)
{
    Status first;
    const auto note = [&](const std::string& path, const Status& status) {
        if (status)
            report.wrote(path);
        else if (first)
            first = status;
        else
            fail(status.error());
    };
    for (const std::string& path : options.outputs) {
        const TraceSpan span("write picture");
        note(path, write_rendered(path, rendered, options, &jobs));
    }
    if (!options.variance_file.empty())
        note(options.variance_file, write_image(options.variance_file, rendered.variance));
    if (rendered.risks && options.risks != "-")
        note(options.risks, write_image(options.risks, risk_picture(*rendered.risks, options.frame.width, options.frame.height)));
    if (!options.stats_file.empty())
        note(options.stats_file, write_text(options.stats_file, json_text(stats_json(options, rendered.figures), 2) + "\n"));
    if (!options.trace_file.empty())
        note(options.trace_file, write_text(options.trace_file, Trace::json()));
    return first;
}

int finish(const RenderOptions& options, const Rendered& rendered, const Jobs& jobs, Report& report)
{
    const Status written = write_outputs(options, rendered, jobs, report);
    if (rendered.risks) {
        report.detail("risks", fmt::format("found in {:.2f} ms", rendered.risks->ms));
        if (options.risks == "-")
            report.asked_for(risk_lines(*rendered.risks));
        else
            report.figures(risk_lines(*rendered.risks));
    }
    report.event("pixel hash:", hash_text(rendered.figures.hash));
    int code = 0;
    if (rendered.figures.nan_pixels)
        code = fail(Error{ExitCode::not_finite, options.scene, "",
                          fmt::format("{} of {} pixels are NaN or Inf", rendered.figures.nan_pixels,
                                      std::int64_t{options.frame.width} * options.frame.height)});
    return written ? code : fail(written.error());
}

// Refuses options that go with no pieces, or pieces where there is one picture alone.
Status check_pieces(const RenderArguments& arguments, const OptionTable& given, bool row)
{
    BN_TRY(check_piece_options(arguments.pieces));
    if (!any_pieces(arguments.pieces))
        return {};
    for (const char* other : {"--checkpoint", "--target-error", "--frames", "--trace", "--plan", "--plan-out", "--verify", "--risks"})
        if (given.given(other))
            return usage_error(other, "cannot be combined with pieces");
    if (given.given("--budget-ms"))
        return usage_error("--budget-ms", "cannot be combined with pieces: machines would plan otherwise");
    if (given.given("--stats") && row)
        return usage_error("--stats", "cannot be combined with pieces of a row: its times are of one process");
    return {};
}

// Checks the options of one picture, and the paths.
Result<RenderOptions> check_picture_options(RenderArguments& arguments, OptionTable& given)
{
    arguments.may_have_bands = true;
    if (given.given("--steps"))
        return usage_error("--steps", "needs --animate");
    if (given.given("--fps"))
        return usage_error("--fps", "needs --animate or --turntable");
    Result<RenderOptions> checked = check_render_options(arguments, given);
    BN_TRY(checked);
    if (any_pieces(arguments.pieces) && checked->backend != "reference" && !checked->band_rows)
        return usage_error("--backend", "has no pieces: a frame is one; --backend reference, --animate, --turntable and --band-rows have");
    if (any_pieces(arguments.pieces) && checked->band_rows && given.given("--stats"))
        return usage_error("--stats", "cannot be combined with pieces of a picture: its times are of one process");
    checked->mips.frames_override = sets_materials(checked->frame);
    if (any_pieces(arguments.pieces) && !checked->band_rows)
        checked->reference.part = std::make_shared<ReferencePart>(), checked->in_pieces = true;
    BN_TRY(check_paths(*checked, {checked->scene, checked->env}));
    return checked;
}

void report_setup(const Session& session, const ChosenView& view, const RenderFigures& figures, Report& report)
{
    const DrawTables& tables = session.tables();
    const Scene& scene = session.scene();
    report.detail("bounds", fmt::format("{} to {} m", world_place(tables.bounds_min, scene, 5), world_place(tables.bounds_max, scene, 5)));
    report.detail("camera", fmt::format("{}: {}", view.description, camera_options(view.view, scene, tables)));
    report.detail("", fmt::format("world to clip {}", describe_matrix(view.view, scene)));
    report.detail("device", fmt::format("{}, {} threads", figures.device, figures.threads));
}

// Lists or makes pieces of the picture, and returns the exit code. For a merge, takes over all pieces and returns nothing.
std::optional<int> run_picture_pieces(const PieceOptions& asked, const RenderOptions& options, const FrameDesc& desc, Session& session,
                                      Report& report)
{
    const std::vector<JobPiece> pieces = reference_pieces(options, desc, session);
    if (!asked.merge)
        return run_pieces(asked, command_words(), pieces, report);
    const auto files = finished_pieces(asked, command_words(), pieces);
    if (!files)
        return fail(files.error());
    if (const Status taken = take_reference_pieces(options, *files, pieces); !taken)
        return fail(taken.error());
    return {};
}

// A session that is ready to draw one picture, with its figures so far.
struct ReadyPicture {
    const RenderOptions& options;
    Session& session;
    RenderFigures& figures;
    const std::optional<Error>& lost_checkpoint;
    Report& report;
};

// Plans the frame, renders it and writes the outputs. Returns the exit code.
int draw_picture(const ReadyPicture& ready, FrameDesc desc)
{
    const auto& [options, session, figures, lost_checkpoint, report] = ready;
    const Result<std::optional<Plan>> plan = plan_frame(options, desc, session, report);
    if (!plan)
        return fail(plan.error());
    report.release();
    note_plan(options, desc, *plan, figures);
    Result<Rendered> rendered = render_frames(options, desc, session, std::move(figures));
    if (!rendered)
        return fail(rendered.error());
    report_frames(options, rendered->figures, report);
    rendered->figures.warnings = report.warnings();
    if (rendered->figures.frame.sampling.stopped) {
        report.event("stopped", fmt::format("the same command goes on from {}; no picture was written", options.reference.checkpoint));
        return 128 + stop_signal(); // as a shell reports a process ended by a signal
    }
    Status verified;
    if (options.verify)
        verified = verify_plan(options, desc, session, rendered->color, *plan, report);
    int code = finish(options, *rendered, *session.parts().jobs, report);
    if (!verified)
        code = std::max(fail(verified.error()), code);
    return lost_checkpoint ? std::max(fail(*lost_checkpoint), code) : code; // the picture comes first
}

int run_render(RenderArguments& arguments, OptionTable& given)
{
    const bool row = arguments.plain.turntable || !arguments.animate.empty();
    if (const Status pieces = check_pieces(arguments, given, row); !pieces)
        return fail(pieces.error());
    if (row && arguments.band_rows)
        return fail(usage_error("--band-rows", "is for one picture, without --animate and --turntable"));
    if (row)
        return run_animation(arguments, given);
    const Result<RenderOptions> checked = check_picture_options(arguments, given);
    if (!checked)
        return fail(checked.error());
    const RenderOptions& options = *checked;
    if (!options.trace_file.empty())
        Trace::start();

    Report report(options.quiet, options.verbosity);
    report.promise_stdout({options.stats_file, options.plan_out});
    for (const std::string& warning : options.warnings)
        report.warning(warning);
    // Load the scene, bake the environment and make the renderer
    RenderFigures figures;
    std::optional<Error> lost_checkpoint;
    Result<Session> session = prepare(options, figures, lost_checkpoint, report);
    if (!session)
        return fail(session.error());
    if (Status paths = check_paths(options, session->scene().files); !paths) // textures and buffers are known now
        return fail(paths.error());
    const Result<ChosenView> view = choose_view(options, session->scene(), session->tables());
    if (!view)
        return fail(view.error());
    report_setup(*session, *view, figures, report);
    FrameDesc desc = options.frame;
    desc.view = view->view;
    if (options.band_rows)
        return run_bands(arguments, given, options, desc, *session, std::move(figures), report);
    if (Status checkpoint = check_reference_checkpoint(session->parts().input(), session->drawn(desc), options.reference); !checkpoint)
        return fail(checkpoint.error());
    if (any_pieces(arguments.pieces))
        if (const std::optional<int> code = run_picture_pieces(arguments.pieces, options, desc, *session, report))
            return *code;
    return draw_picture({options, *session, figures, lost_checkpoint, report}, desc);
}

} // namespace

Command render_command()
{
    auto arguments = std::make_shared<RenderArguments>();
    OptionTable table = render_option_table(*arguments);
    table.add("Bands, for pictures larger than memory",
              {{"--band-rows", "N",
                "Draw the picture in bands of N rows, with the memory of one band; the default for sides above 16384 pixels, "
                "up to 65536, and for more than 2^28 samples. N is a multiple of 16 from 16 to 16384. Outputs are .exr or .png, drawn "
                "by --backend tile. Not with --frames, --show, --risks, --floor mirror, nor materials that let light through",
                integer(arguments->band_rows, 16, kMaxPictureSide), "the whole picture, else at most 256"}});
    table.add("Pieces, for several processes", piece_options(arguments->pieces));
    return {"render", "Render a scene to pictures", std::move(table), kFooter,
            [arguments](OptionTable& given) { return run_render(*arguments, given); }};
}

} // namespace burnish
