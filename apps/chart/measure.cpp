#include "apps/chart/measure.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <limits>

#include "apps/chart/chart.h"
#include "apps/chart/noise.h"
#include "apps/cli/open.h"
#include "apps/cli/words.h"
#include "apps/options/parameters.h"
#include "apps/options/scene_view.h"
#include "apps/plan/plan.h"
#include "apps/render/cached_reference.h"
#include "apps/render/stats.h"
#include "apps/report/pictures.h"
#include "core/base/clock.h"
#include "core/base/hash.h"
#include "core/base/version.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/image/metrics/pattern.h"
#include "core/jobs/activity.h"
#include "core/simd/cpu.h"
#include "raster/reference/scene_key.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Strips the folders from a file name, to keep lines short.
std::string base_name(const std::string& name)
{
    return fs::path(name).filename();
}

// Formats ", +- 1.2 %". Empty if too few samples give no estimate.
std::string error_text(double relative_error)
{
    return std::isfinite(relative_error) ? fmt::format(", +- {:.2g} %", 100.0 * relative_error) : "";
}

} // namespace

// Reads every file before measuring: an unreadable last file must not cost minutes.
Status Chart::load_all()
{
    for (const std::string& name : options_.scenes) {
        Result<SceneWithView> scene = load_scene_with_view(name, options_.base, report_, *jobs_);
        BN_TRY(scene);
        scenes_.push_back(std::move(*scene));
    }
    for (const std::string& env : options_.envs) {
        Result<std::shared_ptr<const Environment>> environment =
            open_environment(env, options_.base.environment, options_.base.limits, *jobs_);
        BN_TRY(environment);
        for (const std::string& warning : (*environment)->warnings)
            report_.warning(warning);
        environments_.push_back(std::move(*environment));
    }
    const FrameDesc& frame = options_.base.frame;
    out_.machine = {version(), cpu_name(), isa_name(options_.base.isa), jobs_->threads(), {}};
    out_.width = frame.width, out_.height = frame.height, out_.msaa = frame.msaa;
    out_.error_width = options_.error_width, out_.error_height = options_.error_height;
    out_.frame = frame;
    out_.display_flip = options_.display_flip;
    out_.wanted = options_.budgets;
    if (out_.wanted.empty())
        out_.wanted.assign(std::begin(kWantedErrors), std::end(kWantedErrors));
    out_.runs = options_.runs;
    out_.reference_samples = options_.reference_samples;
    if (options_.runs == 0)
        out_.machine = {version(), "", "", 0, {}}; // times alone depend on it
    picture_width_ =
        picture_width(scenes_.size() * environments_.size() * options_.cells.size() * (settings_.size() + options_.budgets.size()));
    return {};
}

std::vector<Chart::Spot> Chart::spots() const
{
    std::vector<Spot> all;
    for (std::size_t s = 0; s < scenes_.size(); ++s)
        for (std::size_t e = 0; e < environments_.size(); ++e)
            for (std::size_t c = 0; c < options_.cells.size(); ++c)
                all.push_back({s, e, c});
    return all;
}

Status Chart::measure()
{
    const std::size_t places = scenes_.size() * environments_.size() * options_.cells.size();
    report_.event("chart", fmt::format("{}: {} of {} at {}, {} each", counted(places * (settings_.size() + options_.budgets.size()), "row"),
                                       counted(settings_.size() + options_.budgets.size(), "setting"),
                                       counted(options_.techniques.size(), "technique"), counted(places, "place"),
                                       counted(static_cast<std::uint64_t>(options_.runs), "run")));
    progress_ = std::make_unique<Progress>(
        "chart", places * (settings_.size() + options_.budgets.size()) * static_cast<std::size_t>(options_.runs + 1), options_.base.quiet);
    for (const Spot& spot : spots()) {
        BN_TRY(at_place(spot, [&](const Place& place) { return measure_place(place); }));
        BN_TRY(checkpoint_->save());
        if (stopped())
            return {};
    }
    progress_.reset();
    return {};
}

// Calls `use` with a place, whose session is made.
Status Chart::at_place(const Spot& spot, const std::function<Status(const Place&)>& use)
{
    const SceneWithView& scene = scenes_[spot.scene];
    const std::string& env = options_.envs[spot.environment];
    SessionOptions of_tile;
    of_tile.isa = options_.base.isa;
    if (!tile_ || pair_ != std::pair(spot.scene, spot.environment)) {
        Result<Session> tile = Session::make({scene.data, environments_[spot.environment], jobs_, {}}, of_tile);
        BN_TRY(tile);
        tile_ = std::move(*tile), pair_ = {spot.scene, spot.environment};
    }
    RenderOptions options = options_.cell_options[spot.cell];
    options.scene = scene.data->name;
    // Make the swept parts of the session anew
    if (options_.sweeps_environments || options_.sweeps_scenes) {
        SessionParts parts = tile_->parts();
        if (options_.sweeps_environments) {
            const auto own = open_environment(env, options.environment, options.limits, *jobs_);
            BN_TRY(own);
            parts.environment = *own;
        }
        if (options_.sweeps_scenes) {
            const auto own =
                open_scene(options.scene, options.limits, options.overrides, options.mips, options.moment, options.lights, {}, jobs_.get());
            BN_TRY(own);
            parts.scene = *own;
        }
        Result<Session> next = Session::make(std::move(parts), of_tile);
        BN_TRY(next);
        tile_ = std::move(*next);
    }
    // Choose the view, and name the place by all that decides its pictures
    const Result<ChosenView> view = choose_view(options, tile_->scene(), tile_->tables());
    BN_TRY(view);
    Place place{scene, *tile_, options.frame, env, options_.cells[spot.cell], options.fixes_area_lights};
    place.desc.width = options_.error_width, place.desc.height = options_.error_height;
    place.desc.view = view->view;
    place.key = reference_key(tile_->parts().input(), tile_->drawn(place.desc), options_.base.reference);
    return use(place);
}

std::string Chart::reference_name(const Place& place) const
{
    return fmt::format("{}-{}", hash_text(place.key), options_.reference_samples);
}

std::string Chart::reference_picture(const Place& place) const
{
    return checkpoint_->picture(
        fmt::format("reference-{}-{}-{:g}", reference_name(place), picture_width_, static_cast<double>(options_.base.exposure_ev)));
}

Status Chart::measure_place(const Place& place)
{
    const Activity activity(fmt::format("{}, {}", place.scene.data->name, describe(place.cell)));
    // Find rows without errors
    std::vector<ChartRow> rows;
    bool complete = true; // every row has been compared with the reference
    Result<std::vector<Setting>> settings = planned_settings(place);
    BN_TRY(settings);
    settings->insert(settings->begin(), settings_.begin(), settings_.end());
    for (const Setting& setting : *settings) {
        rows.push_back(new_row(place, setting));
        complete = complete && rows.back().measured.has_errors;
    }
    // Render the reference and compare, unless all is saved
    const std::string cached_reference = reference_name(place), picture = reference_picture(place);
    complete = complete && checkpoint_->references().count(cached_reference);
    if (std::error_code ignored; !complete || !fs::exists(picture, ignored)) {
        ReferenceNoise noise;
        const Result<Frame> reference = render_reference(place, noise);
        BN_TRY(reference);
        if (stopped())
            return {};
        checkpoint_->references()[cached_reference] = noise;
        if (const Status written = write_small(picture, reference->color, false); !written)
            return written;
        for (ChartRow& row : rows) {
            if (const Status found = row.measured.has_errors ? Status() : find_errors(place, *reference, row); !found)
                return found;
            progress_->step();
            if (stopped())
                return {};
        }
    } else {
        progress_->step(rows.size());
    }
    out_.references[burnish::place(rows.front())] = {picture, checkpoint_->references().at(cached_reference)};
    // Time the rows
    load_.begin();
    const Status timed = time_rows(place, rows);
    load_.end();
    if (!timed)
        return timed;
    out_.rows.insert(out_.rows.end(), rows.begin(), rows.end());
    return {};
}

// Plans the timed frame for each budget. A budget out of reach gets no row.
Result<std::vector<Setting>> Chart::planned_settings(const Place& place)
{
    std::vector<Setting> settings;
    FrameDesc desc = timed_desc_of(place, settings_.front());
    desc.technique = FrameDesc().technique, desc.samples = automatic_technique().default_samples;
    for (const double budget : options_.budgets) {
        const Result<Plan> plan = make_plan(place.tile, desc, {budget, {}, {}}, {"", 0, place.fixes_area_lights});
        if (!plan && plan.error().code != ExitCode::usage)
            return plan.error();
        const std::string reason = !plan ? plan.error().reason : plan->aside;
        if (reason.empty())
            settings.push_back({kPlanned, 1, false, budget, plan->frame()});
        else
            report_.warning(fmt::format("budget {:g} has no row for {}: {}", budget, base_name(place.scene.data->name), reason));
        progress_->step(reason.empty() ? 0 : static_cast<std::size_t>(options_.runs + 1));
    }
    return settings;
}

Result<Frame> Chart::render_reference(const Place& place, ReferenceNoise& noise)
{
    ReferenceOptions options;
    options.samples = options_.reference_samples;
    options.full_textures = options_.base.reference.full_textures;
    options.stop = &stop_;
    options.quiet = options_.base.quiet;
    const ReferenceCache home = {options_.base.environment.use_cache, options_.folder};
    Result<Frame> frame = cached_reference(place.tile, place.desc, options, options_.base.isa, home, report_);
    BN_TRY(frame);
    const SamplingStats& s = frame->stats.sampling;
    if (!s.stopped)
        report_.event("reference", fmt::format("{} under {}, {}: {}{}{}, {:.1f} s", base_name(place.scene.data->name), base_name(place.env),
                                               describe(place.cell), counted(s.samples, "sample"),
                                               s.samples_before ? fmt::format(" ({} cached)", s.samples_before) : "",
                                               error_text(s.relative_error), frame->stats.ms * 1e-3));
    if (const std::uint64_t bad = s.stopped ? 0 : count_not_finite(frame->color))
        return Error{ExitCode::not_finite, place.scene.data->name, "reference", fmt::format("{} pixels are NaN or Inf", bad)};
    if (!s.stopped)
        noise = {s.samples, s.relative_error, noise_flip(frame->color, frame->variance, options_.base.isa, *jobs_)};
    return frame;
}

FrameDesc Chart::desc_of(const Place& place, const Setting& setting) const
{
    FrameDesc desc = place.desc;
    desc.technique = setting.technique;
    desc.samples = setting.samples;
    if (setting.budget > 0.0) {
        desc.technique = FrameDesc().technique, desc.samples = automatic_technique().default_samples;
        setting.planned.put(desc);
    }
    return desc;
}

FrameDesc Chart::timed_desc_of(const Place& place, const Setting& setting) const
{
    FrameDesc desc = desc_of(place, setting);
    desc.width = options_.base.frame.width, desc.height = options_.base.frame.height;
    return desc;
}

// Makes the row from saved measurements. Drops its errors if their pictures are gone.
ChartRow Chart::new_row(const Place& place, const Setting& setting) const
{
    const FrameDesc desc = desc_of(place, setting);
    const FrameDesc& timed = options_.base.frame;
    const std::string machine = options_.runs ? fmt::format("{} {}", place.tile.device(), jobs_->threads()) : "";
    const std::string text =
        fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}{}", program_, place.key, place.tile.parts().environment->content_hash,
                    options_.reference_samples, desc.technique, desc.samples, timed.width, timed.height, desc.msaa, desc.tile_size, machine,
                    parameters_text(desc),
                    options_.display_flip ? fmt::format("{} flip {} {}", describe(place.cell), options_.base.exposure_ev,
                                                        static_cast<int>(options_.base.resolve))
                                          : describe(place.cell));
    std::string planned;
    for (const MaterialTechnique& m : desc.by_material)
        planned += fmt::format(" {} {}", m.technique, m.samples);
    ChartRow row;
    const std::uint64_t plain = hash_bytes(text.data(), text.size());
    row.key = hash_text(planned.empty() ? plain : hash_bytes(planned.data(), planned.size(), plain));
    row.scene = place.scene.data->name, row.env = place.env;
    row.setting = setting, row.cell = place.cell;
    row.measured = checkpoint_->row(row.key);
    const std::string name = fmt::format("{}-{}-{:g}", row.key, picture_width_, static_cast<double>(options_.base.exposure_ev));
    row.picture = checkpoint_->picture(name);
    row.error_map = checkpoint_->picture(name + "-flip");
    std::error_code ignored;
    row.measured.has_errors = row.measured.has_errors && fs::exists(row.picture, ignored) && fs::exists(row.error_map, ignored);
    return row;
}

Status Chart::write_small(const std::string& file, const Image& image, bool errors)
{
    const Image small = shrink(image, picture_width_);
    return write_image(file, errors ? magma_map(small) : tonemap_to_srgb8(small, options_.base.tonemap, options_.base.exposure_ev));
}

// Returns the pattern figures over pixels that the scene covers whole.
static PatternFigures patterns_of(const Frame& frame, const Frame& reference, const Jobs& jobs)
{
    const Image test = with_coverage(frame.color, frame.triangle_ids, frame.through);
    const Image covered = with_alpha(reference.color, [&](std::size_t i) { return test.f32()[4 * i + 3]; });
    return pattern_figures(covered, nullptr, test, jobs, &reference.variance);
}

Status Chart::find_errors(const Place& place, const Frame& reference, ChartRow& row)
{
    FrameDesc desc = desc_of(place, row.setting);
    desc.triangle_ids = true;
    desc.parts = options_.display_flip && options_.base.resolve != Resolve::linear;
    Result<Frame> frame = place.tile.render_any(desc);
    BN_TRY(frame);
    RowErrors& e = row.measured.errors;
    e.nan_pixels = count_not_finite(frame->color);
    Image map = make_image(reference.color.width, reference.color.height, 1, PixelType::f32);
    if (e.nan_pixels) {
        e.flip_mean = e.flip_p99 = e.rel_mse = e.max_abs = e.pattern_rms = e.quad_ratio_x = e.quad_ratio_y =
            std::numeric_limits<double>::quiet_NaN();
    } else {
        FlipOptions flip;
        flip.isa = options_.base.isa;
        const RenderOptions& base = options_.base;
        const auto shown = [&](const Frame& f) { return tonemap_to_srgb8(f.color, base.tonemap, base.exposure_ev, f.parts, base.resolve); };
        map = options_.display_flip ? flip_ldr(shown(reference), shown(*frame), flip, *jobs_).error
                                    : flip_hdr(reference.color, frame->color, flip, *jobs_).error;
        const ErrorSummary errors = summarise_errors(map);
        const PixelFigures pixels = pixel_figures(reference.color, frame->color, *jobs_);
        e.flip_mean = errors.mean, e.flip_p99 = errors.p99;
        e.rel_mse = pixels.rel_mse, e.max_abs = pixels.max_abs;
        const PatternFigures patterns = patterns_of(*frame, reference, *jobs_);
        e.pattern_rms = patterns.pixels ? patterns.rms : std::numeric_limits<double>::quiet_NaN();
        e.quad_ratio_x = patterns.quad_ratio[0], e.quad_ratio_y = patterns.quad_ratio[1];
    }
    for (const Status& written : {write_small(row.picture, frame->color, false), write_small(row.error_map, map, true)})
        if (!written)
            return written;
    row.measured.has_errors = true;
    Measured& saved_row = checkpoint_->row(row.key);
    saved_row.has_errors = true;
    saved_row.errors = e;
    return checkpoint_->save_sometimes();
}

// Times all settings in turn, every other round in reverse order. A slow phase of the machine then slows all settings, and no setting
// always follows the same neighbour.
Status Chart::time_rows(const Place& place, std::vector<ChartRow>& rows)
{
    const std::size_t runs = static_cast<std::size_t>(options_.runs);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].measured.ms.size() < runs)
            order.push_back(i);
    progress_->step((rows.size() - order.size()) * runs);
    Frame last;
    for (const std::size_t i : order) { // warm-up
        if (stopped())
            return {};
        Result<Frame> frame = place.tile.render(timed_desc_of(place, rows[i].setting), std::move(last));
        BN_TRY(frame);
        last = std::move(*frame);
    }
    for (std::size_t run = 0; run < runs; ++run) {
        for (const std::size_t i : order) {
            Measured& saved_row = checkpoint_->row(rows[i].key);
            if (saved_row.ms.size() > run)
                continue;
            const double before = process_cpu_ms();
            Result<Frame> frame = place.tile.render(timed_desc_of(place, rows[i].setting), std::move(last));
            BN_TRY(frame);
            saved_row.ms.push_back(frame->stats.ms);
            saved_row.cpu_ms.push_back(process_cpu_ms() - before);
            last = std::move(*frame);
            progress_->step();
            if (stopped())
                return {};
        }
        std::reverse(order.begin(), order.end());
        if (const Status saved = checkpoint_->save_sometimes(); !saved)
            return saved;
    }
    for (ChartRow& row : rows) {
        const Measured& saved_row = checkpoint_->row(row.key);
        row.measured.ms = saved_row.ms, row.measured.cpu_ms = saved_row.cpu_ms;
        row.measured.ms.resize(runs); // an earlier chart may have had more runs
        row.measured.cpu_ms.resize(runs);
    }
    return {};
}

ChartReport Chart::take()
{
    mark_pareto(out_.rows);
    if (const std::optional<double> others = load_.others())
        checkpoint_->others() = std::max(*others, checkpoint_->others().value_or(0.0));
    out_.machine.others = checkpoint_->others();
    return std::move(out_);
}

Result<MeasuredChart> measure_chart(const ChartOptions& options, const std::shared_ptr<const Jobs>& jobs, ChartCheckpoint& checkpoint,
                                    Report& report)
{
    const auto open_checkpoint = [&]() -> Status {
        Result<ChartCheckpoint> opened = ChartCheckpoint::open(options.folder, report);
        BN_TRY(opened);
        checkpoint = std::move(*opened);
        return {};
    };
    if (!any_pieces(options.pieces)) // before scenes are read: a folder that cannot be written must not cost minutes
        BN_TRY(open_checkpoint());
    Chart chart(options, jobs, checkpoint, report);
    BN_TRY(chart.load_all());
    if (any_pieces(options.pieces)) {
        const Result<std::vector<JobPiece>> pieces = chart.pieces();
        BN_TRY(pieces);
        if (!options.pieces.merge)
            return MeasuredChart{{}, false, run_pieces(options.pieces, command_words(), *pieces, report)};
        const auto files = finished_pieces(options.pieces, command_words(), *pieces);
        BN_TRY(files);
        BN_TRY(open_checkpoint());
        BN_TRY(chart.take(*files, *pieces));
    }
    report.release();
    BN_TRY(chart.measure());
    MeasuredChart measured_chart{chart.take(), chart.stopped(), {}};
    BN_TRY(checkpoint.save());
    return measured_chart;
}

} // namespace burnish
