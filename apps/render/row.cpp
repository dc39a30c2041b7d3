// A row of pictures: options that change from one to the next, or a way around the scene.
#include <fmt/core.h>
#include <utility>

#include "apps/cli/numbered.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/scene_view.h"
#include "apps/render/animate.h"
#include "apps/render/picture.h"

namespace burnish {
namespace {

// Options of one picture of a row.
struct Step {
    RenderOptions options;
    std::string values; // "roughness 0.1, tilt 0,0": of what changes
    Json json;          // the same by option
};

// A row of pictures: --animate or --turntable.
class Row {
  public:
    static Result<Row> make(RenderArguments& arguments, OptionTable& given)
    {
        Row row(arguments, given);
        const std::string asked = arguments.plain.turntable ? "--turntable" : "--animate";
        for (const char* other : {"--frames", "--checkpoint", "--variance", "--trace"})
            if (given.given(other))
                return usage_error(other, "cannot be combined with " + asked);
        if (arguments.plain.turntable)
            for (const char* other : {"--animate", "--eye", "--target", "--camera"})
                if (given.given(other))
                    return usage_error(other, "cannot be combined with --turntable");
        for (const std::string& pattern : arguments.plain.outputs)
            if (!has_number(pattern))
                return usage_error("-o", fmt::format("'{}' needs a number such as %04d with {}", pattern, asked));
        row.count_ = arguments.plain.turntable ? arguments.plain.turntable : arguments.steps;
        if (!arguments.animate.empty()) {
            Result<std::vector<OptionPath>> paths = parse_option_paths("--animate", arguments.animate, given);
            if (!paths)
                return paths.error();
            row.paths_ = std::move(*paths);
        }
        for (const OptionPath& path : row.paths_)
            row.lights_change_ = row.lights_change_ || given.find(path.option)->group == "Environment";
        for (int i = 0; i < row.count_; ++i) // what is wrong in the middle is said at the beginning
            if (const Result<Step> step = row.step(i); !step)
                return step.error();
        return row;
    }

    int count() const { return count_; }
    bool lights_change() const { return lights_change_; }

    Result<Step> step(int i)
    {
        Step out;
        out.json["step"] = i;
        for (const OptionPath& path : paths_) {
            const std::string value = value_at(path, static_cast<double>(i) / (count_ - 1));
            if (const Status set = given_.set(path.option, value); !set)
                return set.error();
            out.values += fmt::format("{}{} {}", out.values.empty() ? "" : ", ", path.option.substr(2), value);
            out.json[path.option.substr(2)] = value;
        }
        Result<RenderOptions> options = check_render_options(arguments_, given_);
        if (!options)
            return options.error();
        out.options = std::move(*options);
        for (std::string& output : out.options.outputs)
            output = numbered(output, i);
        return out;
    }

  private:
    Row(RenderArguments& arguments, OptionTable& given) : arguments_(arguments), given_(given) {}
    RenderArguments& arguments_;
    OptionTable& given_;
    std::vector<OptionPath> paths_;
    int count_ = 0;
    bool lights_change_ = false;
};

// No picture lies where something is read from, or another one is written.
Status check_row_paths(Row& row, const std::vector<std::string>& inputs)
{
    for (int i = 0; i < row.count(); ++i)
        if (const Status paths = check_paths(row.step(i)->options, inputs); !paths)
            return paths;
    return {};
}

Result<View> view_of_step(const Step& step, int i, const Session& session, const std::vector<View>& turntable)
{
    if (!turntable.empty()) {
        View view = turntable[static_cast<std::size_t>(i)];
        view.tan_half_x /= step.options.zoom, view.tan_half_y /= step.options.zoom;
        return view;
    }
    const Result<ChosenView> view = choose_view(step.options, session.scene(), session.tables());
    if (!view)
        return view.error();
    return view->view;
}

} // namespace

int run_row(RenderArguments& arguments, OptionTable& given)
{
    Result<Row> row = Row::make(arguments, given);
    if (!row)
        return fail(row.error());
    const RenderOptions first = row->step(0)->options;
    if (Status paths = check_row_paths(*row, {first.scene, first.env}); !paths)
        return fail(paths.error());
    Report report(first.quiet, first.verbosity);
    for (const std::string& warning : first.warnings)
        report.warning(warning);
    RenderFigures figures;
    std::optional<Error> lost_checkpoint;
    Result<Session> session = prepare(first, figures, lost_checkpoint, report);
    if (!session)
        return fail(session.error());
    if (Status paths = check_row_paths(*row, session->scene().files); !paths)
        return fail(paths.error());
    std::vector<View> turntable;
    if (first.turntable)
        turntable = turntable_views(session->tables(), first.frame, first.orbit_deg.value_or(kUsualOrbitDeg),
                                    first.fov_y_deg.value_or(kUsualFovDeg) * kRadiansPerDegree, row->count());
    report.release();
    Json steps = Json::array();
    RenderFigures last = figures;
    std::vector<double> times;
    for (int i = 0; i < row->count(); ++i) {
        const Step step = std::move(*row->step(i));
        if (i > 0 && row->lights_change()) {
            SessionParts parts = session->parts();
            const auto environment = open_environment(step.options.env, step.options.environment, step.options.limits, *parts.jobs);
            if (!environment)
                return fail(environment.error());
            parts.environment = *environment;
            Result<Session> next = Session::make(std::move(parts), session_options(step.options, lost_checkpoint));
            if (!next)
                return fail(next.error());
            *session = std::move(*next);
        }
        const Result<View> view = view_of_step(step, i, *session, turntable);
        if (!view)
            return fail(view.error());
        FrameDesc desc = step.options.frame;
        desc.view = *view;
        const Result<Rendered> rendered = render_frames(step.options, desc, *session, figures);
        if (!rendered)
            return fail(rendered.error());
        last = rendered->figures;
        times.push_back(last.frame.ms);
        Json json = step.json;
        json["pixel_hash"] = hash_text(last.hash), json["ms"] = last.frame.ms;
        steps.push_back(json);
        for (const std::string& path : step.options.outputs)
            if (const Status written = write_picture(path, rendered->color, step.options.tonemap, step.options.exposure_ev); !written)
                return fail(written.error());
        report.event(fmt::format("{} of {}", i + 1, row->count()),
                     fmt::format("{}{:.2f} ms, pixel hash {}{}", step.values.empty() ? "" : step.values + ": ", last.frame.ms,
                                 hash_text(last.hash), step.options.outputs.empty() ? "" : ", " + join(step.options.outputs)));
        if (last.nan_pixels)
            return fail(Error{ExitCode::not_finite, first.scene, fmt::format("step {}", i),
                              fmt::format("{} pixels are NaN or Inf", last.nan_pixels)});
    }
    if (first.stats_file.empty())
        return 0;
    last.frame_ms = std::move(times);
    last.warnings = report.warnings();
    Json json = stats_json(row->step(row->count() - 1)->options, last);
    json["steps"] = std::move(steps);
    const Status written = write_text(first.stats_file, json.dump(2) + "\n");
    if (written)
        report.wrote(first.stats_file);
    return written ? 0 : fail(written.error());
}

} // namespace burnish
