#include "apps/lab/atlas/picture_cache.h"

#include <fmt/ranges.h>

#include "apps/chart/noise.h"
#include "apps/cli/open.h"
#include "apps/lab/atlas/trial_tables.h"
#include "apps/options/scene_view.h"
#include "apps/render/picture.h"
#include "raster/reference/scene_key.h"
#include "raster/tile/twins.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr std::size_t kMostCached = 8;       // scenes, environments or sessions: a path may need one for each step
constexpr std::size_t kMostReferences = 256; // pictures

Result<Frame> finite(const AtlasSetting& setting, Result<Frame> frame)
{
    if (frame && count_not_finite(frame->color))
        return Error{ExitCode::not_finite, setting.options.scene, setting.values, "the picture holds NaN or Inf"};
    return frame;
}

Result<std::optional<Frame>> some(Result<Frame> frame)
{
    BN_TRY(frame);
    return std::optional<Frame>(std::move(*frame));
}

template <class Cached> void make_room(Cached& entries, std::size_t most = kMostCached)
{
    if (entries.size() >= most)
        entries.clear();
}

// Returns the file of --as-table; empty: none.
std::string as_table_of(const RenderOptions& options)
{
    return options.as_tables.empty() ? "" : options.as_tables.back();
}

// Returns a key of all inputs to a session.
std::string parts_key(const AtlasSetting& setting)
{
    const RenderOptions& o = setting.options;
    const bool of_lobe = is_trial_table(as_table_of(o));
    return fmt::format("{}\n{}\n{} {} {}", setting.scene_key, setting.environment_key, o.ltc_table, fmt::join(o.as_tables, " "),
                       of_lobe ? fmt::format("{} {}", o.frame.roughness, o.frame.anisotropy) : "");
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

Result<const SessionParts*> PictureCache::parts_of(const AtlasSetting& setting)
{
    const RenderOptions& o = setting.options;
    const std::string key = parts_key(setting), as_table = as_table_of(o);
    if (const auto found = parts_.find(key); found != parts_.end())
        return &found->second;
    if (!scenes_.count(setting.scene_key)) {
        make_room(scenes_);
        Result<std::shared_ptr<const SceneData>> scene =
            open_scene(o.scene, o.limits, o.overrides, o.mips, o.moment, o.lights, {}, machine_.jobs.get());
        BN_TRY(scene);
        scenes_[setting.scene_key] = std::move(*scene);
    }
    if (!environments_.count(setting.environment_key)) {
        make_room(environments_);
        Result<std::shared_ptr<const Environment>> environment = open_environment(o.env, o.environment, o.limits, *machine_.jobs);
        BN_TRY(environment);
        environments_[setting.environment_key] = std::move(*environment);
    }
    SessionParts parts{scenes_[setting.scene_key], environments_[setting.environment_key], machine_.jobs, {}};
    RenderOptions files = o;
    if (is_trial_table(o.ltc_table)) {
        Result<std::shared_ptr<const ltc::ShadingTables>> table = trial_table(o.ltc_table, *machine_.jobs);
        BN_TRY(table);
        parts.ltc = std::move(*table), files.ltc_table.clear();
    }
    if (is_trial_table(as_table)) {
        Result<std::shared_ptr<const PhongFiles>> table =
            trial_half_vectors(as_table, static_cast<double>(o.frame.roughness), static_cast<double>(o.frame.anisotropy));
        BN_TRY(table);
        parts.phong = std::move(*table), files.as_tables.clear();
    }
    BN_TRY(read_tables(files, parts, report_));
    make_room(parts_);
    return &(parts_[key] = std::move(parts));
}

Result<Session*> PictureCache::session_of(const AtlasSetting& setting)
{
    const std::string key = parts_key(setting);
    if (const auto found = sessions_.find(key); found != sessions_.end())
        return &found->second;
    const Result<const SessionParts*> parts = parts_of(setting);
    BN_TRY(parts);
    SessionOptions options;
    options.isa = machine_.isa;
    Result<Session> session = Session::make(**parts, options);
    BN_TRY(session);
    make_room(sessions_);
    return &sessions_.emplace(key, std::move(*session)).first->second;
}

Result<Session*> PictureCache::reference_session(const AtlasSetting& setting, const ReferenceOptions& options)
{
    const std::string key =
        fmt::format("{}\n{} {} {} {} {} {} {}", parts_key(setting), options.samples, options.full_textures, static_cast<int>(options.mode),
                    static_cast<int>(options.strategy), options.bounces, options.area_lights_only, options.target_error);
    if (const auto found = reference_sessions_.find(key); found != reference_sessions_.end())
        return &found->second;
    const Result<const SessionParts*> parts = parts_of(setting);
    BN_TRY(parts);
    SessionOptions of_reference;
    of_reference.backend = Backend::reference, of_reference.isa = machine_.isa, of_reference.reference = options;
    Result<Session> session = Session::make(**parts, of_reference);
    BN_TRY(session);
    make_room(reference_sessions_);
    return &reference_sessions_.emplace(key, std::move(*session)).first->second;
}

Result<FrameDesc> PictureCache::desc_of(const AtlasSetting& setting)
{
    const Result<const SessionParts*> parts = parts_of(setting);
    BN_TRY(parts);
    const Result<ChosenView> view = choose_view(setting.options, (*parts)->scene->scene, (*parts)->scene->tables);
    BN_TRY(view);
    FrameDesc desc = setting.options.frame;
    desc.view = view->view;
    desc.triangle_ids = true;
    desc.glass = setting.options.reference.mode == ReferenceMode::path; // else as the reference has it
    desc.parts = setting.displayed;
    return desc;
}

Result<Frame> PictureCache::draw(const AtlasSetting& setting)
{
    const Result<FrameDesc> desc = desc_of(setting);
    BN_TRY(desc);
    const Result<Session*> session = session_of(setting);
    return session ? finite(setting, (*session)->render(*desc)) : session.error();
}

Result<std::optional<Frame>> PictureCache::draw_in_double(const AtlasSetting& setting)
{
    const Result<FrameDesc> desc = desc_of(setting);
    BN_TRY(desc);
    const Result<Session*> session = session_of(setting);
    BN_TRY(session);
    const std::unique_ptr<Renderer> renderer = make_double_tile_renderer((*session)->parts().input());
    if (!renderer)
        return std::optional<Frame>();
    return some(finite(setting, renderer->render((*session)->drawn(*desc), {})));
}

Result<std::shared_ptr<const ReferencePicture>> PictureCache::reference(const AtlasSetting& setting)
{
    if (setting.options.backend != "reference") {
        Result<std::optional<Frame>> frame = setting.in_double ? draw_in_double(setting) : some(draw(setting));
        BN_TRY(frame);
        if (!*frame)
            return Error{ExitCode::unavailable, setting.options.scene, "", "this program draws no frames in double"};
        return std::make_shared<const ReferencePicture>(ReferencePicture{picture_of(setting, std::move(**frame)), 0.0, {}});
    }
    Result<FrameDesc> desc = desc_of(setting);
    BN_TRY(desc);
    desc->triangle_ids = false;
    ReferenceOptions options = setting.options.reference;
    options.stop = machine_.stop;
    options = cached_reference_options(options, machine_.home, report_);
    const Result<Session*> session = reference_session(setting, options);
    BN_TRY(session);
    const std::uint64_t key = reference_key((*session)->parts().input(), (*session)->drawn(*desc), options) ^ options.samples;
    if (const auto found = reference_pictures_.find(key); found != reference_pictures_.end())
        return found->second;
    Result<Frame> frame = cached_reference(**session, *desc, options, report_);
    BN_TRY(frame);
    if (frame->stats.sampling.stopped)
        return std::shared_ptr<const ReferencePicture>();
    if (count_not_finite(frame->color))
        return Error{ExitCode::not_finite, setting.options.scene, "reference", "the picture holds NaN or Inf"};
    const double noise = noise_flip(frame->color, frame->variance, machine_.isa, *machine_.jobs);
    make_room(reference_pictures_, kMostReferences);
    return reference_pictures_[key] = std::make_shared<const ReferencePicture>(
               ReferencePicture{Picture{std::move(frame->color), {}}, noise, std::move(frame->variance)});
}

} // namespace burnish
