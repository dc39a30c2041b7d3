// Picture sequences: options that change from one picture to the next, or a turntable.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/cli/numbered.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/cli/words.h"
#include "apps/options/animate.h"
#include "apps/options/scene_view.h"
#include "apps/pieces/given.h"
#include "apps/pieces/packed.h"
#include "apps/pieces/pieces.h"
#include "apps/render/picture.h"
#include "apps/render/planned.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/image/io/apng.h"
#include "core/image/io/image_io.h"
#include "raster/reference/scene_key.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

bool is_one_of(const std::string& text, const std::vector<std::string>& of)
{
    return std::find(of.begin(), of.end(), text) != of.end();
}

// Options for one picture in a sequence.
struct Step {
    RenderOptions options;
    std::string values; // the changing values, such as "roughness 0.1, tilt 0,0"
    Json json;          // the same values, by option
};

// A picture sequence: --animate or --turntable.
class Animation {
  public:
    static Result<Animation> make(RenderArguments& arguments, OptionTable& given)
    {
        Animation row(arguments, given);
        const std::string asked = arguments.plain.turntable ? "--turntable" : "--animate";
        for (const char* other : {"--frames", "--checkpoint", "--variance", "--trace", "--risks", "--plan", "--verify"})
            if (given.given(other))
                return usage_error(other, "cannot be combined with " + asked);
        if (arguments.plain.turntable)
            for (const char* other : {"--animate", "--steps", "--eye", "--target", "--camera"})
                if (given.given(other))
                    return usage_error(other, "cannot be combined with --turntable");
        for (const std::string& pattern : arguments.plain.outputs)
            if (const std::string extension = fs::path(pattern).extension();
                is_one_of(extension, {".gif", ".webp", ".mp4", ".avi", ".webm", ".mov"}))
                return usage_error("-o", fmt::format("'{}': a moving picture is an .apng, others are not written", pattern));
            else if (extension == ".apng")
                row.movies_.push_back(pattern);
            else if (!has_number(pattern))
                return usage_error("-o", fmt::format("'{}' needs a number such as %04d with {}", pattern, asked));
        if (row.movies_.empty() && given.given("--fps"))
            return usage_error("--fps", "needs -o FILE.apng");
        row.count_ = arguments.plain.turntable ? arguments.plain.turntable : arguments.steps;
        if (!arguments.animate.empty()) {
            std::set<std::string> fixed; // parse_option_paths() gives the moving options values too
            for (const Option& option : given.options())
                if (given.given(option.name))
                    fixed.insert(option.name);
            Result<std::vector<OptionPath>> paths = parse_option_paths("--animate", arguments.animate, given);
            BN_TRY(paths);
            row.paths_ = std::move(*paths);
            for (const OptionPath& path : row.paths_)
                if (fixed.count(path.option))
                    return usage_error(path.option, "cannot be combined with --animate " + path.option.substr(2));
        }
        for (const OptionPath& path : row.paths_) {
            const Option& option = *given.find(path.option);
            row.lights_change_ = row.lights_change_ || option.group == "Environment";
            row.scene_changes_ = row.scene_changes_ || changes_scene(option);
        }
        for (int i = 0; i < row.count_; ++i) // checks every step first: a bad value in the middle ends the run at once
            BN_TRY(row.step(i));
        return row;
    }

    int count() const { return count_; }
    const std::vector<std::string>& movies() const { return movies_; } // files that hold all pictures
    bool lights_change() const { return lights_change_; }
    bool scene_changes() const { return scene_changes_; }

    Result<Step> step(int i)
    {
        Step out;
        out.json["step"] = i;
        for (const OptionPath& path : paths_) {
            const std::string value = value_at(path, static_cast<double>(i) / (count_ - 1));
            BN_TRY(given_.set(path.option, value));
            out.values += fmt::format("{}{} {}", out.values.empty() ? "" : ", ", path.option.substr(2), value);
            out.json[path.option.substr(2)] = value;
        }
        Result<RenderOptions> options = check_render_options(arguments_, given_);
        BN_TRY(options);
        out.options = std::move(*options);
        out.options.in_pieces = any_pieces(arguments_.pieces);
        std::vector<std::string> pictures;
        for (const std::string& output : out.options.outputs)
            if (!is_one_of(output, movies_))
                pictures.push_back(numbered(output, i));
        out.options.outputs = std::move(pictures);
        return out;
    }

  private:
    Animation(RenderArguments& arguments, OptionTable& given) : arguments_(arguments), given_(given) {}
    RenderArguments& arguments_;
    OptionTable& given_;
    std::vector<OptionPath> paths_;
    std::vector<std::string> movies_;
    int count_ = 0;
    bool lights_change_ = false, scene_changes_ = false;
};

// Refuses a picture path that is also an input or another output.
Status check_animation_paths(Animation& row, const std::vector<std::string>& inputs)
{
    for (int i = 0; i < row.count(); ++i)
        if (const Status paths = check_paths(row.step(i)->options, inputs); !paths)
            return paths;
    for (std::size_t i = 0; i < row.movies().size(); ++i) {
        if (const Status path = check_text_path("-o", row.movies()[i], inputs); !path)
            return path;
        for (std::size_t k = 0; k < i; ++k)
            if (same_file(row.movies()[i], row.movies()[k]))
                return usage_error("-o", fmt::format("'{}' is given twice", row.movies()[i]));
    }
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
    BN_TRY(view);
    return view->view;
}

// Plans the first step. Notes the plan's figures.
Result<PlannedFrame> plan_first_step(const Step& step, Session& session, const std::vector<View>& turntable, RenderFigures& figures,
                                     Report& report)
{
    const Result<View> view = view_of_step(step, 0, session, turntable);
    BN_TRY(view);
    FrameDesc desc = step.options.frame;
    desc.view = *view;
    const Result<std::optional<Plan>> plan = plan_frame(step.options, desc, session, report);
    BN_TRY(plan);
    note_plan(step.options, desc, *plan, figures);
    PlannedFrame planned = {desc.by_material, {}};
    if (!desc.by_material.empty() && !step.options.fixes_area_lights)
        planned.area_lights = AreaLightsSetting{desc.area_way, static_cast<int>(desc.light_samples)};
    return planned;
}

// Returns the previous step's parts with the changed parts made anew.
Result<SessionParts> parts_of_step(const RenderOptions& options, SessionParts parts, bool lights, bool scene)
{
    if (lights) {
        const auto environment = open_light(options, *parts.scene, *parts.jobs);
        BN_TRY(environment);
        parts.environment = *environment;
    }
    if (scene) {
        const auto data = open_scene(options.scene, options.limits, options.overrides, options.mips, options.moment, options.lights,
                                     floor_of(options), parts.jobs.get());
        BN_TRY(data);
        parts.scene = *data;
    }
    return parts;
}

// A row of pictures with all that draws them.
struct Row {
    Animation& animation;
    Session& session; // has the parts of step `at`
    const std::vector<View>& turntable;
    const PlannedFrame& planned;
    const RenderFigures& figures;
    std::optional<Error>& lost_checkpoint;
    int at = 0;
};

Result<Rendered> draw_step(Row& row, const Step& step, int i)
{
    // Make the session's changed parts anew
    const bool lights = row.animation.lights_change(), scene = row.animation.scene_changes();
    if (i != row.at && (lights || scene)) {
        Result<SessionParts> parts = parts_of_step(step.options, row.session.parts(), lights, scene);
        BN_TRY(parts);
        Result<Session> next = Session::make(std::move(*parts), session_options(step.options, row.lost_checkpoint));
        BN_TRY(next);
        row.session = std::move(*next);
    }
    row.at = i;
    const Result<View> view = view_of_step(step, i, row.session, row.turntable);
    BN_TRY(view);
    FrameDesc desc = step.options.frame;
    desc.view = *view;
    row.planned.put(desc);
    return render_frames(step.options, desc, row.session, row.figures);
}

Image shown_picture(const Step& step, const Rendered& rendered, const Jobs* jobs)
{
    return display_picture(rendered.color, step.options.tonemap, step.options.exposure_ev, rendered.parts, step.options.resolve, jobs);
}

// Writes the files that hold all pictures.
Status write_movies(const std::vector<std::string>& paths, const MovingPicture& movie, Report& report)
{
    for (const std::string& path : paths) {
        const std::vector<std::uint8_t> bytes = movie.bytes();
        BN_TRY(write_file(path, std::string(bytes.begin(), bytes.end())));
        report.wrote(path);
    }
    return {};
}

// Formats of the row's pictures, each once.
std::set<std::string> formats_of(const Step& step)
{
    std::set<std::string> formats;
    for (const std::string& path : step.options.outputs)
        formats.insert(extension_of(path));
    return formats;
}

// Draws a step into a piece: its picture in each format, and in moving pictures.
Status write_step(Row& row, int i, const std::string& file, const std::string& key)
{
    const Step step = std::move(*row.animation.step(i));
    const Result<Rendered> rendered = draw_step(row, step, i);
    BN_TRY(rendered);
    if (rendered->figures.frame.sampling.stopped)
        return {};
    if (rendered->figures.nan_pixels)
        return Error{ExitCode::not_finite, step.options.scene, fmt::format("step {}", i),
                     fmt::format("{} pixels are NaN or Inf", rendered->figures.nan_pixels)};
    Packed packed;
    for (const std::string& format : formats_of(step)) {
        const std::string own = own_name_beside(file, "." + format);
        BN_TRY(write_rendered(own, *rendered, step.options, row.session.parts().jobs.get()));
        Result<std::vector<std::uint8_t>> bytes = take_file(own);
        BN_TRY(bytes);
        packed.files.push_back({format, std::move(*bytes)});
    }
    if (!row.animation.movies().empty()) {
        const Image shown = shown_picture(step, *rendered, row.session.parts().jobs.get());
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(shown.bytes.data());
        packed.json = Json({shown.width, shown.height, shown.channels}).dump();
        packed.files.push_back({"shown", {bytes, bytes + shown.bytes.size()}});
    }
    return write_piece(file, key, pack(packed));
}

// Returns all that decides the row's pictures, as text: scene and light, and each given option by its name and texts. Files count by their
// content. Outputs count by their formats.
std::string text_of_row(const Row& row, const RenderOptions& first, const OptionTable& given)
{
    const SessionParts& parts = row.session.parts();
    std::string text = fmt::format("{:016x} {:016x} {}", reference_key(parts.input(), row.session.drawn(first.frame), first.reference),
                                   parts.environment->content_hash, row.animation.count());
    text += text_of_scene(first.scene, row.session.scene().files) + text_of_given(given);
    const std::set<std::string> formats = formats_of(std::move(*row.animation.step(0)));
    for (const std::string& format : formats)
        text += "\n" + format;
    return text + (row.animation.movies().empty() ? "" : "\nshown");
}

std::vector<JobPiece> row_pieces(Row& row, const RenderOptions& first, const OptionTable& given)
{
    const std::string text = text_of_row(row, first, given);
    const auto rate = std::make_shared<std::optional<double>>();
    std::vector<JobPiece> pieces;
    for (int i = 0; i < row.animation.count(); ++i) {
        const std::string key = piece_key(fmt::format("step {} {}", i, text));
        const auto seconds = [&row, rate]() -> Result<double> {
            const double begin = wall_ms();
            if (!*rate) {
                BN_TRY(draw_step(row, std::move(*row.animation.step(0)), 0));
                *rate = (wall_ms() - begin) * 1e-3;
            }
            return **rate;
        };
        pieces.push_back({key, seconds, [&row, i, key](const std::string& file) { return write_step(row, i, file, key); }});
    }
    return pieces;
}

// Returns a picture that write_step() packed.
Result<Image> shown_of(const Packed& packed, const PackedFile& file, const std::string& path)
{
    const Error damaged = {ExitCode::bad_input, path, "", "is a damaged piece"};
    const Json size = Json::parse(packed.json, nullptr, false);
    if (!size.is_array() || size.size() != 3 ||
        !std::all_of(size.begin(), size.end(), [](const Json& n) { return n.is_number_unsigned(); }))
        return damaged;
    const auto width = size[0].get<std::uint64_t>(), height = size[1].get<std::uint64_t>(), channels = size[2].get<std::uint64_t>();
    if (width < 1 || height < 1 || channels < 1 || channels > 4 || width > file.bytes.size() || height > file.bytes.size() ||
        width * height * channels != file.bytes.size())
        return damaged;
    Image shown = make_image(static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels), PixelType::u8);
    std::memcpy(shown.bytes.data(), file.bytes.data(), file.bytes.size());
    return shown;
}

// Writes the files of all steps from their pieces.
Status merge_row(Row& row, const std::vector<std::string>& files, const std::vector<JobPiece>& pieces, int fps, Report& report)
{
    MovingPicture movie(fps);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        Result<Packed> packed = unpack(*content, files[i]);
        BN_TRY(packed);
        const auto part = [&](const std::string& name) {
            return std::find_if(packed->files.begin(), packed->files.end(), [&](const PackedFile& f) { return f.name == name; });
        };
        const Step step = std::move(*row.animation.step(static_cast<int>(i)));
        for (const std::string& path : step.options.outputs) {
            const auto found = part(extension_of(path));
            if (found == packed->files.end())
                return Error{ExitCode::bad_input, files[i], "", "is a damaged piece"};
            BN_TRY(write_file_atomic(path, found->bytes.data(), found->bytes.size()));
            report.wrote(path);
        }
        if (row.animation.movies().empty())
            continue;
        const auto found = part("shown");
        if (found == packed->files.end())
            return Error{ExitCode::bad_input, files[i], "", "is a damaged piece"};
        const Result<Image> shown = shown_of(*packed, *found, files[i]);
        BN_TRY(shown);
        BN_TRY(movie.add(row.animation.movies()[0], *shown));
    }
    return write_movies(row.animation.movies(), movie, report);
}

int run_row_pieces(const PieceOptions& options, Row& row, const RenderOptions& first, const OptionTable& given, Report& report)
{
    const std::vector<std::string>& words = command_words();
    const std::vector<JobPiece> pieces = row_pieces(row, first, given);
    if (!options.merge)
        return run_pieces(options, words, pieces, report);
    const auto files = finished_pieces(options, words, pieces);
    if (!files)
        return fail(files.error());
    report.release();
    const Status merged = merge_row(row, *files, pieces, first.fps, report);
    return merged ? 0 : fail(merged.error());
}

// The figures of a row's steps so far.
struct RowFigures {
    RenderFigures last; // of the last step
    std::vector<double> times;
    Json steps = Json::array();
};

// Writes a step's pictures, and adds the picture to the moving ones.
Status write_step_pictures(const Row& row, const Step& step, const Rendered& rendered, MovingPicture& movie)
{
    const Jobs* const jobs = row.session.parts().jobs.get();
    for (const std::string& path : step.options.outputs)
        BN_TRY(write_rendered(path, rendered, step.options, jobs));
    if (!row.animation.movies().empty())
        BN_TRY(movie.add(row.animation.movies()[0], shown_picture(step, rendered, jobs)));
    return {};
}

// Draws each step and writes its files.
Status draw_steps(Row& row, const RenderOptions& first, MovingPicture& movie, RowFigures& figures, Report& report)
{
    for (int i = 0; i < row.animation.count(); ++i) {
        const Step step = std::move(*row.animation.step(i));
        const Result<Rendered> rendered = draw_step(row, step, i);
        BN_TRY(rendered);
        figures.last = rendered->figures;
        const RenderFigures& last = figures.last;
        figures.times.push_back(last.frame.ms);
        Json json = step.json;
        json["pixel_hash"] = hash_text(last.hash), json["ms"] = last.frame.ms;
        figures.steps.push_back(json);
        BN_TRY(write_step_pictures(row, step, *rendered, movie));
        report.event(fmt::format("{} of {}", i + 1, row.animation.count()),
                     fmt::format("{}{:.2f} ms, pixel hash {}{}", step.values.empty() ? "" : step.values + ": ", last.frame.ms,
                                 hash_text(last.hash), step.options.outputs.empty() ? "" : ", " + join(step.options.outputs)));
        if (last.nan_pixels)
            return Error{ExitCode::not_finite, first.scene, fmt::format("step {}", i),
                         fmt::format("{} pixels are NaN or Inf", last.nan_pixels)};
    }
    return {};
}

// Writes the statistics with one entry a step.
Status write_row_stats(Animation& row, RowFigures figures, const std::string& path, Report& report)
{
    figures.last.frame_ms = std::move(figures.times);
    figures.last.warnings = report.warnings();
    Json json = stats_json(row.step(row.count() - 1)->options, figures.last);
    json["steps"] = std::move(figures.steps);
    BN_TRY(write_text(path, json_text(json, 2) + "\n"));
    report.wrote(path);
    return {};
}

// Draws the row, then writes its moving pictures and statistics.
Status draw_row(Row& row, const RenderOptions& first, Report& report)
{
    report.release();
    RowFigures figures;
    figures.last = row.figures;
    MovingPicture movie(first.fps);
    BN_TRY(draw_steps(row, first, movie, figures, report));
    BN_TRY(write_movies(row.animation.movies(), movie, report));
    return first.stats_file.empty() ? Status() : write_row_stats(row.animation, std::move(figures), first.stats_file, report);
}

} // namespace

int run_animation(RenderArguments& arguments, OptionTable& given)
{
    // Check every step, then load the first
    Result<Animation> row = Animation::make(arguments, given);
    if (!row)
        return fail(row.error());
    const RenderOptions first = row->step(0)->options;
    if (Status paths = check_animation_paths(*row, {first.scene, first.env}); !paths)
        return fail(paths.error());
    Report report(first.quiet, first.verbosity);
    for (const std::string& warning : first.warnings)
        report.warning(warning);
    RenderFigures figures;
    std::optional<Error> lost_checkpoint;
    Result<Session> session = prepare(first, figures, lost_checkpoint, report);
    if (!session)
        return fail(session.error());
    for (const std::vector<std::string>& read : {session->scene().files, session->parts().environment->files})
        if (Status paths = check_animation_paths(*row, read); !paths)
            return fail(paths.error());
    // Choose the turntable's views, which keep one distance
    std::vector<View> turntable;
    if (first.turntable)
        turntable = turntable_views(session->tables(), first.frame, first.orbit_deg.value_or(kDefaultOrbitDeg),
                                    first.fov_y_deg.value_or(kDefaultFovDeg) * kRadiansPerDegree, row->count());
    // Plan the first step for all, so that no step changes how a material is drawn
    const Result<PlannedFrame> planned = plan_first_step(*row->step(0), *session, turntable, figures, report);
    if (!planned)
        return fail(planned.error());
    Row drawn{*row, *session, turntable, *planned, figures, lost_checkpoint};
    if (any_pieces(arguments.pieces))
        return run_row_pieces(arguments.pieces, drawn, first, given, report);
    const Status done = draw_row(drawn, first, report);
    return done ? 0 : fail(done.error());
}

} // namespace burnish
