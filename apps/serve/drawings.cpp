#include "apps/serve/drawings.h"

#include <algorithm>
#include <system_error>

#include "apps/cli/report.h"
#include "apps/options/scene_view.h"

namespace burnish {
namespace {

constexpr std::size_t kKeptSessions = 4, kKeptPictures = 8;

std::filesystem::file_time_type time_of(const std::string& path)
{
    std::error_code failed;
    const auto time = std::filesystem::last_write_time(path, failed);
    return failed ? std::filesystem::file_time_type::min() : time;
}

} // namespace

Result<Drawings::Prepared> Drawings::prepared(const DrawRequest& request, const RenderOptions& options)
{
    const std::string key = session_key(request);
    const bool reference = request.reference_samples > 0;
    if (!reference) { // a reference's session holds its number of samples
        const std::lock_guard lock(kept_);
        for (auto at = sessions_.begin(); at != sessions_.end(); ++at)
            if (at->key == key) {
                sessions_.splice(sessions_.begin(), sessions_, at);
                return sessions_.front();
            }
    }
    Prepared made;
    made.key = key;
    Report report(true, 0);
    std::optional<Error> lost_checkpoint;
    Result<Session> session = prepare(options, made.figures, lost_checkpoint, report);
    BN_TRY(session);
    made.session = std::make_shared<Session>(std::move(*session));
    made.warnings = report.warnings();
    const std::lock_guard lock(kept_);
    std::vector<std::string> read = made.session->scene().files;
    const std::vector<std::string>& lights = made.session->parts().environment->files;
    read.insert(read.end(), lights.begin(), lights.end());
    for (const std::string& path : read)
        if (std::none_of(files_.begin(), files_.end(), [&](const auto& file) { return file.first == path; }))
            files_.emplace_back(path, time_of(path));
    if (!reference) {
        sessions_.push_front(made);
        if (sessions_.size() > kKeptSessions)
            sessions_.pop_back();
    }
    return made;
}

Result<std::shared_ptr<const Drawn>> Drawings::draw_now(const DrawRequest& request)
{
    auto drawn = std::make_shared<Drawn>();
    RenderArguments arguments;
    Result<RenderOptions> options = render_options_of(request, limits_, threads_, arguments);
    BN_TRY(options);
    options->reference.stop = &stop_reference_;
    Result<Prepared> made = prepared(request, *options);
    BN_TRY(made);
    Session& session = *made->session;
    const Result<ChosenView> view = choose_view(*options, session.scene(), session.tables());
    BN_TRY(view);
    FrameDesc desc = options->frame;
    desc.view = view->view;
    Result<Rendered> rendered = render_frames(*options, desc, session, made->figures);
    BN_TRY(rendered);
    if (rendered->figures.frame.sampling.stopped)
        return Error{ExitCode::differ, "", "", "stopped for another picture"};
    drawn->warnings = made->warnings;
    drawn->warnings.insert(drawn->warnings.begin(), options->warnings.begin(), options->warnings.end());
    const DrawTables& tables = session.tables();
    drawn->centre = 0.5f * (tables.bounds_min + tables.bounds_max);
    drawn->radius = std::max(0.5f * glm::length(tables.bounds_max - tables.bounds_min), 1e-20f);
    drawn->to_eye = -view->view.forward;
    drawn->options = std::move(*options), drawn->rendered = std::move(*rendered);
    return std::shared_ptr<const Drawn>(drawn);
}

Result<std::shared_ptr<const Drawn>> Drawings::draw(const DrawRequest& request)
{
    const bool reference = request.reference_samples > 0;
    stop_reference_ = true; // of an older request
    const std::lock_guard drawing(reference ? reference_ : tile_);
    {
        const std::lock_guard lock(kept_);
        for (auto at = pictures_.begin(); at != pictures_.end(); ++at)
            if (at->first == request) {
                pictures_.splice(pictures_.begin(), pictures_, at);
                return pictures_.front().second;
            }
    }
    if (reference)
        stop_reference_ = ending_.load();
    Result<std::shared_ptr<const Drawn>> drawn = draw_now(request);
    BN_TRY(drawn);
    const std::lock_guard lock(kept_);
    pictures_.emplace_front(request, *drawn);
    if (pictures_.size() > kKeptPictures)
        pictures_.pop_back();
    return drawn;
}

std::uint64_t Drawings::look_for_changes()
{
    const std::lock_guard lock(kept_);
    if (std::any_of(files_.begin(), files_.end(), [](const auto& file) { return time_of(file.first) != file.second; })) {
        sessions_.clear(), pictures_.clear(), files_.clear();
        ++changes_;
    }
    return changes_;
}

} // namespace burnish
