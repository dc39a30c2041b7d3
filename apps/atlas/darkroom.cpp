#include "apps/atlas/darkroom.h"

#include <fmt/ranges.h>

#include "apps/atlas/trial_tables.h"
#include "apps/chart/noise.h"
#include "apps/cli/open.h"
#include "apps/cli/scene_view.h"
#include "apps/render/picture.h"
#include "raster/reference/scene_key.h"
#include "raster/tile/double_renderer.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr std::size_t kMostKept = 8; // scenes, environments or sessions: a path may have one a step

Result<Frame> finite(const AtlasSetting& setting, Result<Frame> frame)
{
    if (frame && count_not_finite(frame->color))
        return Error{ExitCode::not_finite, setting.options.scene, setting.values, "the picture holds NaN or Inf"};
    return frame;
}

Result<std::optional<Frame>> some(Result<Frame> frame)
{
    if (!frame)
        return frame.error();
    return std::optional<Frame>(std::move(*frame));
}

template <class T> void make_room(std::map<std::string, T>& kept)
{
    if (kept.size() >= kMostKept)
        kept.clear();
}

} // namespace

Picture picture_of(const AtlasSetting& setting, Frame frame)
{
    const std::size_t pixels = static_cast<std::size_t>(frame.color.width) * static_cast<std::size_t>(frame.color.height);
    const std::size_t msaa = frame.triangle_ids.size() / pixels;
    const RenderOptions& o = setting.options;
    Picture out{{}, std::vector<bool>(pixels)};
    for (std::size_t i = 0; i < frame.triangle_ids.size(); ++i)
        if (frame.triangle_ids.data()[i] != kNoTriangle)
            out.covered[i / msaa] = true;
    out.color =
        setting.displayed ? tonemap_to_srgb8(frame.color, o.tonemap, o.exposure_ev, frame.parts, o.resolve) : std::move(frame.color);
    return out;
}

Result<Session*> Darkroom::session_of(const AtlasSetting& setting)
{
    const RenderOptions& o = setting.options;
    const std::string key =
        fmt::format("{}\n{}\n{} {}", setting.scene_key, setting.environment_key, o.ltc_table, fmt::join(o.as_tables, " "));
    if (const auto found = sessions_.find(key); found != sessions_.end())
        return &found->second;
    if (!scenes_.count(setting.scene_key)) {
        make_room(scenes_);
        Result<std::shared_ptr<const SceneData>> scene = open_scene(o.scene, o.limits, o.dress, o.moment, o.lights);
        if (!scene)
            return scene.error();
        scenes_[setting.scene_key] = std::move(*scene);
    }
    if (!environments_.count(setting.environment_key)) {
        make_room(environments_);
        Result<std::shared_ptr<const Environment>> environment = open_environment(o.env, o.environment, o.limits, *machine_.jobs);
        if (!environment)
            return environment.error();
        environments_[setting.environment_key] = std::move(*environment);
    }
    SessionOptions options;
    options.isa = machine_.isa;
    SessionParts parts{scenes_[setting.scene_key], environments_[setting.environment_key], machine_.jobs, {}};
    RenderOptions files = o;
    if (is_trial_table(o.ltc_table)) {
        Result<std::shared_ptr<const ltc::ShadingTables>> table = trial_table(o.ltc_table, *machine_.jobs);
        if (!table)
            return table.error();
        parts.ltc = std::move(*table), files.ltc_table.clear();
    }
    if (const Status read = read_tables(files, parts, report_); !read)
        return read.error();
    Result<Session> session = Session::make(std::move(parts), options);
    if (!session)
        return session.error();
    make_room(sessions_);
    return &sessions_.emplace(key, std::move(*session)).first->second;
}

Result<Darkroom::Shot> Darkroom::shot_of(const AtlasSetting& setting)
{
    const Result<Session*> session = session_of(setting);
    if (!session)
        return session.error();
    const Result<ChosenView> view = choose_view(setting.options, (*session)->scene(), (*session)->tables());
    if (!view)
        return view.error();
    FrameDesc desc = setting.options.frame;
    desc.view = view->view;
    desc.triangle_ids = true;
    desc.parts = setting.displayed;
    return Shot{*session, desc};
}

Result<Frame> Darkroom::draw(const AtlasSetting& setting)
{
    const Result<Shot> shot = shot_of(setting);
    if (!shot)
        return shot.error();
    return finite(setting, shot->session->render(shot->desc));
}

Result<std::optional<Frame>> Darkroom::draw_in_double(const AtlasSetting& setting)
{
    const Result<Shot> shot = shot_of(setting);
    if (!shot)
        return shot.error();
    const std::unique_ptr<Renderer> renderer = make_double_tile_renderer(shot->session->parts().input());
    if (!renderer)
        return std::optional<Frame>();
    return some(finite(setting, renderer->render(shot->session->drawn(shot->desc), {})));
}

Result<std::shared_ptr<const Truth>> Darkroom::truth(const AtlasSetting& setting)
{
    if (setting.options.backend != "reference") {
        Result<std::optional<Frame>> frame = setting.in_double ? draw_in_double(setting) : some(draw(setting));
        if (!frame)
            return frame.error();
        if (!*frame)
            return Error{ExitCode::unavailable, setting.options.scene, "", "this program draws no frames in double"};
        return std::make_shared<const Truth>(Truth{picture_of(setting, std::move(**frame)), 0.0});
    }
    const Result<Shot> shot = shot_of(setting);
    if (!shot)
        return shot.error();
    FrameDesc desc = shot->desc;
    desc.triangle_ids = false;
    ReferenceOptions options = setting.options.reference;
    options.stop = machine_.stop;
    const std::uint64_t key = reference_key(shot->session->parts().input(), shot->session->drawn(desc), options);
    if (const auto found = truths_.find(key); found != truths_.end())
        return found->second;
    Result<Frame> frame = kept_reference(*shot->session, desc, options, machine_.isa, machine_.home, report_);
    if (!frame)
        return frame.error();
    if (frame->stats.sampling.stopped)
        return std::shared_ptr<const Truth>();
    if (count_not_finite(frame->color))
        return Error{ExitCode::not_finite, setting.options.scene, "reference", "the picture holds NaN or Inf"};
    const double noise = noise_flip(frame->color, frame->variance, machine_.isa, *machine_.jobs);
    return truths_[key] = std::make_shared<const Truth>(Truth{Picture{std::move(frame->color), {}}, noise});
}

void Darkroom::forget()
{
    sessions_.clear();
    truths_.clear();
}

} // namespace burnish
