#include "apps/serve/drawings.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <fmt/core.h>
#include <system_error>
#include <thread>

#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/options/scene_view.h"
#include "core/jobs/control.h"
#include "raster/session/guarded.h"

namespace burnish {
namespace {

constexpr std::size_t kCachedSessions = 4, kCachedPictures = 8;
constexpr std::int64_t kCachedPixels = 8 << 20; // of all cached pictures

std::vector<std::string> files_read(const Session& session)
{
    std::vector<std::string> read = session.scene().files;
    const std::vector<std::string>& lights = session.parts().environment->files;
    read.insert(read.end(), lights.begin(), lights.end());
    return read;
}

Error overtaken()
{
    return Error{ExitCode::differ, "", "", "stopped for another picture"};
}

std::filesystem::file_time_type time_of(const std::string& path)
{
    std::error_code failed;
    const auto time = std::filesystem::last_write_time(path, failed);
    return failed ? std::filesystem::file_time_type::min() : time;
}

#ifdef __EMSCRIPTEN__ // compiled without threads: who does not wait ends the worker
struct Lookout {
    Lookout(const std::function<bool()>&, std::stop_source&) {}
};
#else
constexpr std::chrono::milliseconds kPause(50);

// Stops the picture once nobody waits for it. Ends with the object.
class Lookout {
  public:
    Lookout(const std::function<bool()>& gone, std::stop_source& stop)
        : thread_([this, gone, &stop] {
              std::unique_lock lock(mutex_);
              while (!changed_.wait_for(lock, kPause, [&] { return ended_; }))
                  if (gone && gone())
                      stop.request_stop();
          })
    {
    }
    ~Lookout()
    {
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        changed_.notify_one();
        thread_.join();
    }

  private:
    std::mutex mutex_{};
    std::condition_variable changed_{};
    bool ended_ = false; // under mutex_
    std::thread thread_;
};
#endif

} // namespace

Image shown_picture(const Drawn& drawn)
{
    const RenderOptions& o = drawn.options;
    return drawn.rendered.shown.empty()
               ? display_picture(drawn.rendered.color, o.tonemap, o.exposure_ev, drawn.rendered.parts, o.resolve, drawn.jobs.get())
               : drawn.rendered.shown;
}

void Drawings::note_file(const std::string& path, Time time)
{
    if (std::none_of(files_.begin(), files_.end(), [&](const auto& file) { return file.first == path; }))
        files_.emplace_back(path, time);
}

Result<Drawings::Prepared> Drawings::prepared(const DrawRequest& request, const RenderOptions& options)
{
    const std::string key = session_key(request, options);
    const bool reference = request.reference_samples > 0;
    const Time begin = Time::clock::now();
    std::uint64_t changes = 0;
    {
        const std::lock_guard lock(cache_);
        changes = changes_;
        for (auto at = sessions_.begin(); at != sessions_.end() && !reference; ++at) // a reference's session holds its number of samples
            if (at->key == key) {
                sessions_.splice(sessions_.begin(), sessions_, at);
                return sessions_.front();
            }
        for (const std::string& path : {request.scene, request.environment}) // one that cannot be read may be mended
            if (!path.empty() && path.rfind("builtin:", 0) != 0)
                note_file(path, time_of(path));
    }
    Prepared made;
    made.key = key;
    Report report(true, 0);
    std::optional<Error> lost_checkpoint;
    Result<Session> session = prepare(options, made.figures, lost_checkpoint, report);
    BN_TRY(session);
    made.session = std::make_shared<Session>(std::move(*session));
    made.warnings = report.warnings();
    const std::lock_guard lock(cache_);
    for (const std::string& path : files_read(*made.session)) {
        const Time time = time_of(path);
        note_file(path, time > begin ? Time::min() : time); // changed while it was read
    }
    if (!reference && changes == changes_) {
        sessions_.push_front(made);
        if (sessions_.size() > kCachedSessions)
            sessions_.pop_back();
    }
    return made;
}

Result<Drawings::Opened> Drawings::open(const DrawRequest& request)
{
    RenderArguments arguments;
    Result<RenderOptions> options = render_options_of(request, limits_, threads_, arguments);
    BN_TRY(options);
    options->frame.profile = request.reference_samples == 0;
    Result<Prepared> made = Error{};
    {
        const Controlled controlled({end_.get_token(), {}}); // a session's preparations serve later pictures too
        made = prepared(request, *options);
    }
    if (!made && made.error().code == ExitCode::stopped)
        return overtaken();
    BN_TRY(made);
    const Result<ChosenView> view = choose_view(*options, made->session->scene(), made->session->tables());
    BN_TRY(view);
    options->outputs = {"picture.png"}; // whose edges need the pixels' samples
    FrameDesc desc = options->frame;
    desc.view = view->view;
    return Opened{std::move(*options), std::move(*made), desc};
}

std::shared_ptr<const Drawn> Drawings::drawn_of(Opened opened, Rendered rendered) const
{
    auto drawn = std::make_shared<Drawn>();
    const Session& session = *opened.made.session;
    drawn->warnings = std::move(opened.made.warnings);
    drawn->warnings.insert(drawn->warnings.begin(), opened.options.warnings.begin(), opened.options.warnings.end());
    drawn->files = files_read(session), drawn->jobs = session.parts().jobs;
    const DrawTables& tables = session.tables();
    drawn->view = opened.desc.view, drawn->origin = session.scene().origin;
    drawn->centre = drawn->origin + glm::dvec3(0.5f * (tables.bounds_min + tables.bounds_max));
    drawn->radius = std::max(0.5f * glm::length(tables.bounds_max - tables.bounds_min), 1e-20f);
    drawn->options = std::move(opened.options), drawn->rendered = std::move(rendered);
    return drawn;
}

Result<std::shared_ptr<const Drawn>> Drawings::draw_now(const DrawRequest& request, const std::stop_token& stop)
{
    Result<Opened> opened = open(request);
    BN_TRY(opened);
    const Controlled controlled({stop, {}});
    Result<Rendered> rendered =
        guarded(request.scene, [&] { return render_frames(opened->options, opened->desc, *opened->made.session, opened->made.figures); });
    if (!rendered && rendered.error().code == ExitCode::stopped)
        return overtaken();
    BN_TRY(rendered);
    return drawn_of(std::move(*opened), std::move(*rendered));
}

Result<DrawnBand> Drawings::draw_part(const DrawRequest& request, double from, double to)
{
    const std::lock_guard drawing(tile_);
    Result<Opened> opened = open(request);
    BN_TRY(opened);
    const RenderOptions& options = opened->options;
    if (request.reference_samples > 0 || options.show != Shown::light || options.floor == FloorChoice::mirror)
        return Error{ExitCode::usage, request.scene, "", "is drawn as a whole", "FrameDesc::window"};
    FrameDesc& desc = opened->desc;
    const auto row = [height = desc.height](double share) {
        return share >= 1.0 ? height : static_cast<int>(std::max(share, 0.0) * height) / kWindowStep * kWindowStep;
    };
    const int top = row(from), rows = row(to) - top;
    if (rows <= 0)
        return DrawnBand();
    desc.window.picture_width = desc.width, desc.window.picture_height = desc.height;
    Session& session = *opened->made.session;
    const Bands bands{options, desc, session, opened->made.figures, has_margin(options, desc, session)};
    return guarded(request.scene, [&] { return draw_rows(bands, top, rows); });
}

bool Drawings::keeps(const DrawRequest& request)
{
    const std::lock_guard lock(cache_);
    return std::any_of(pictures_.begin(), pictures_.end(), [&](const auto& entry) { return entry.first == request; });
}

Result<std::shared_ptr<const Drawn>> Drawings::join(const DrawRequest& request, std::vector<DrawnBand> bands, double ms)
{
    const std::lock_guard drawing(tile_);
    Result<Opened> opened = open(request);
    BN_TRY(opened);
    const int width = opened->desc.width, height = opened->desc.height;
    Rendered out;
    out.figures = opened->made.figures;
    BandHash hash(width, height);
    int rows = 0;
    // Append the bands
    for (DrawnBand& band : bands) {
        const auto append = [&](const Image& from, Image& to) {
            if (to.empty()) {
                to = Image{from.width, 0, from.channels, from.type, {}};
                to.bytes.reserve(from.bytes.size() / static_cast<std::size_t>(from.height) * static_cast<std::size_t>(height));
            }
            to.bytes.insert(to.bytes.end(), from.bytes.begin(), from.bytes.end()), to.height += from.height;
            return from.width == width && from.channels == to.channels && from.type == to.type;
        };
        if (band.linear.empty())
            continue;
        if (band.linear.height != band.shown.height || !append(band.linear, out.color) || !append(band.shown, out.shown))
            return usage_error("bands", "differ in their pixels");
        hash.add(band.linear);
        rows += band.linear.height;
        add_stats(band.stats, out.figures.frame);
        out.figures.nan_pixels += band.nan_pixels;
        for (std::size_t i = 0; i < kFrameStages; ++i)
            out.profile.stage_ns[i] += band.stage_ns[i];
        band = {}; // frees its memory
    }
    if (rows != height)
        return usage_error("bands", fmt::format("have {} of {} rows", rows, height));
    out.figures.hash = hash.value(), out.figures.frame_ms = {ms};
    const std::shared_ptr<const Drawn> drawn = drawn_of(std::move(*opened), std::move(out));
    const std::lock_guard lock(cache_);
    keep(request, drawn);
    return drawn;
}

void Drawings::stop_older(bool passing)
{
    for (Running* running : running_)
        if (running->reference || (passing && running->passing))
            running->stop.request_stop();
}

void Drawings::stop()
{
    const std::lock_guard lock(cache_);
    ending_ = true;
    end_.request_stop();
    for (Running* running : running_)
        running->stop.request_stop();
}

Result<std::shared_ptr<const Drawn>> Drawings::draw(const DrawRequest& request, const Call& call)
{
    const bool reference = request.reference_samples > 0;
    const std::uint64_t mine = call.passing ? ++latest_ : 0;
    Running running{{}, reference, call.passing};
    {
        const std::lock_guard lock(cache_);
        stop_older(call.passing);
        running_.push_back(&running);
        if (ending_)
            running.stop.request_stop();
    }
    struct Leave {
        Drawings& of;
        Running* running;
        ~Leave()
        {
            const std::lock_guard lock(of.cache_);
            of.running_.remove(running);
        }
    } leave{*this, &running};
    const std::lock_guard drawing(reference ? reference_ : tile_);
    if ((call.passing && mine != latest_) || (call.gone && call.gone()))
        return overtaken();
    std::uint64_t changes = 0;
    {
        const std::lock_guard lock(cache_);
        changes = changes_;
        for (auto at = pictures_.begin(); at != pictures_.end(); ++at)
            if (at->first == request) {
                pictures_.splice(pictures_.begin(), pictures_, at);
                return pictures_.front().second;
            }
    }
    Result<std::shared_ptr<const Drawn>> drawn = std::shared_ptr<const Drawn>();
    {
        const Lookout lookout(call.gone, running.stop);
        drawn = draw_now(request, running.stop.get_token());
    }
    BN_TRY(drawn);
    const std::lock_guard lock(cache_);
    if (changes != changes_) // of files that are others now
        return drawn;
    keep(request, *drawn);
    return drawn;
}

void Drawings::keep(const DrawRequest& request, const std::shared_ptr<const Drawn>& drawn)
{
    pictures_.remove_if([&](const auto& entry) { return entry.first == request; });
    pictures_.emplace_front(request, drawn);
    std::int64_t pixels = 0;
    std::size_t count = 0;
    auto at = pictures_.begin();
    for (; at != pictures_.end() && count < kCachedPictures; ++at, ++count) {
        pixels += std::int64_t{at->first.width} * at->first.height;
        if (count > 0 && pixels > kCachedPixels)
            break;
    }
    pictures_.erase(at, pictures_.end());
}

std::uint64_t Drawings::look_for_changes()
{
    const std::lock_guard lock(cache_);
    if (std::any_of(files_.begin(), files_.end(), [](const auto& file) { return time_of(file.first) != file.second; })) {
        sessions_.clear(), pictures_.clear(), files_.clear();
        ++changes_;
    }
    return changes_;
}

} // namespace burnish
