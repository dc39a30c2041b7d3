#include "apps/lab/conform/draw.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/lab/conform/scenes.h"
#include "apps/lab/conform/tile_mutated.h"
#include "core/image/io/image_io.h"
#include "shading/lab/conform/mutated.h"
#include "shading/lang/records.h"

namespace burnish {

std::uint32_t drawn_mutants = 0;

namespace {

constexpr int kMsaa = 8;
constexpr std::uint32_t kLightSamples = 16; // on the area light
// Mistakes that show under an environment alone.
constexpr std::uint32_t kOfImageLight = mutant_bit(KernelMutant::bend_factor) | mutant_bit(KernelMutant::bend_across) |
                                        mutant_bit(KernelMutant::no_bend) | mutant_bit(KernelMutant::mean_width) |
                                        mutant_bit(KernelMutant::no_specular_image);
constexpr int kCubeSize = 256, kBakeSamples = 512;

} // namespace

const std::vector<RightWay>& right_ways()
{
    static const std::vector<RightWay> ways = {
        {"gltf", "the bent normal that KHR_materials_anisotropy recommends", "bent_normal", 1, mutant_bit(KernelMutant::gltf_bend)},
        {"gltf_compensated", "that bent normal, with light that rough lobes lose given back", "bent_normal", 1,
         mutant_bit(KernelMutant::gltf_bend), true},
        {"hdrp", "the bent normal of Unity's HDRP", "bent_normal", 1, 0},
        {"samples", "samples of the lobe", "lobe_line", 16, 0},
    };
    return ways;
}

Result<ConformDrawer> ConformDrawer::open(const ConformFolder& folder, const Limits& limits, std::shared_ptr<const Jobs> jobs)
{
    ConformDrawer drawer;
    drawer.limits_ = limits;
    drawer.jobs_ = std::move(jobs);
    Result<std::shared_ptr<const DfgTable>> dfg = standard_dfg(*drawer.jobs_);
    BN_TRY(dfg);
    drawer.dfg_ = *dfg;
    Result<Image> environment = read_image(folder.path + "/environment.exr", limits);
    BN_TRY(environment);
    if (environment->type != PixelType::f32 || environment->channels != 3)
        return Error{ExitCode::bad_input, folder.path + "/environment.exr", "", "holds no red, green and blue floats"};
    const std::size_t values = environment->bytes.size() / sizeof(float);
    if (std::any_of(environment->f32(), environment->f32() + values, [](float v) { return !(v >= 0.0f && std::isfinite(v)); }))
        return Error{ExitCode::not_finite, folder.path + "/environment.exr", "", "holds values that are negative, NaN or infinite"};
    drawer.environment_ = std::move(*environment);
    for (const FolderScene& scene : folder.scenes) {
        std::vector<AreaLight> lights;
        if (scene.area_light)
            lights.push_back(conform_area_light());
        Result<std::shared_ptr<const SceneData>> data =
            load_scene_data(folder.path + "/" + scene.file, limits, {}, {}, {}, lights, {}, drawer.jobs_.get());
        BN_TRY(data);
        if ((*data)->scene.cameras.empty())
            return Error{ExitCode::bad_input, folder.path + "/" + scene.file, "/cameras", "there is no camera"};
        drawer.scenes_.push_back({*data, scene.environment});
    }
    return drawer;
}

FrameDesc ConformDrawer::desc_of(const Scene& scene) const
{
    FrameDesc desc;
    desc.width = kConformWidth, desc.height = kConformHeight;
    desc.msaa = kMsaa;
    desc.background = false;
    if (const Result<View> view = make_view(scene, 0, desc.width, desc.height))
        desc.view = *view;
    return desc;
}

Result<std::shared_ptr<const Environment>> ConformDrawer::sky(bool lit, const std::vector<MutantSky>& changes)
{
    std::shared_ptr<const Environment>& cached = lit ? skies_[changes] : black_;
    if (cached)
        return cached;
    EnvironmentOptions options;
    options.cube_size = lit ? kCubeSize : 16;
    options.extracted_lights = 0;
    options.samples = kBakeSamples;
    Image picture = lit ? environment_ : make_image(8, 4, 3, PixelType::f32);
    if (lit)
        for (const MutantSky change : changes)
            picture = changed_sky(picture, change);
    Result<Environment> baked = bake_environment(picture, "environment", options, *jobs_);
    BN_TRY(baked);
    cached = std::make_shared<const Environment>(std::move(*baked));
    return cached;
}

Result<std::optional<Image>> ConformDrawer::draw(std::size_t scene, std::span<const int> mistakes)
{
    const Opened& opened = scenes_[scene];
    const bool edits_scene =
        std::any_of(mistakes.begin(), mistakes.end(), [](int m) { return mutants()[static_cast<std::size_t>(m)].scene; });
    // Make the mistakes of the scene
    bool any = mistakes.empty();
    std::shared_ptr<const SceneData> data = opened.data;
    std::uint32_t kernels = way_->kernels;
    std::vector<MutantSky> changes;
    if (edits_scene) {
        Scene edited = data->scene;
        for (const int m : mistakes)
            if (const auto edit = mutants()[static_cast<std::size_t>(m)].scene)
                any = edit(edited) || any;
        if (any) {
            Result<std::shared_ptr<const SceneData>> made = make_scene_data(data->name, std::move(edited), limits_);
            BN_TRY(made);
            data = *made;
        }
    }
    for (const int m : mistakes) {
        const Mutant& mutant = mutants()[static_cast<std::size_t>(m)];
        kernels |= mutant.kernels;
        if (mutant.sky != MutantSky::right && opened.environment)
            changes.push_back(mutant.sky), any = true;
        any =
            any || (mutant.kernels & (opened.environment ? ~0u : ~kOfImageLight)) != 0 || (mutant.frame && !mutant.scene) || mutant.picture;
    }
    if (!any)
        return std::optional<Image>();
    // Draw with the mistakes of kernels and frame
    const Result<std::shared_ptr<const Environment>> environment = sky(opened.environment, changes);
    BN_TRY(environment);
    SessionParts parts;
    parts.scene = data, parts.environment = *environment, parts.jobs = jobs_, parts.dfg = dfg_;
    const std::unique_ptr<Renderer> renderer = make_mutated_tile_renderer(parts.input());
    if (!renderer)
        return Error{ExitCode::unavailable, "", "", "this program has no kernels with mistakes, which burnish-lab has"};
    FrameDesc desc = desc_of(data->scene);
    desc.technique = way_->technique;
    desc.samples = way_->samples;
    desc.energy_compensation = way_->compensates;
    desc.area_way = kAreaWay_mc;
    desc.light_samples = kLightSamples;
    for (const int m : mistakes)
        if (const auto edit = mutants()[static_cast<std::size_t>(m)].frame)
            edit(desc);
    drawn_mutants = kernels;
    Result<Frame> frame = renderer->render(desc, {});
    drawn_mutants = 0;
    BN_TRY(frame);
    Image picture = std::move(frame->color);
    for (const int m : mistakes)
        if (const auto edit = mutants()[static_cast<std::size_t>(m)].picture)
            edit(picture);
    return std::optional<Image>(std::move(picture));
}

Result<SessionParts> ConformDrawer::parts_of(std::size_t scene)
{
    const Result<std::shared_ptr<const Environment>> environment = sky(scenes_[scene].environment, {});
    BN_TRY(environment);
    SessionParts parts;
    parts.scene = scenes_[scene].data, parts.environment = *environment, parts.jobs = jobs_, parts.dfg = dfg_;
    return parts;
}

Result<Image> ConformDrawer::by_technique(std::size_t scene, const TechniqueInfo& technique)
{
    Result<SessionParts> parts = parts_of(scene);
    BN_TRY(parts);
    Result<Session> session = Session::make(std::move(*parts));
    BN_TRY(session);
    FrameDesc desc = desc_of(scenes_[scene].data->scene);
    desc.technique = technique.name;
    desc.samples = technique.default_samples;
    desc.area_way = kAreaWay_mc; // exact for every technique
    desc.light_samples = 4 * kLightSamples;
    Result<Frame> frame = session->render(desc);
    BN_TRY(frame);
    return std::move(frame->color);
}

Result<ConformDrawer::ReferencePicture> ConformDrawer::reference(std::size_t scene, std::uint64_t samples, const std::atomic<bool>* stop)
{
    Result<SessionParts> parts = parts_of(scene);
    BN_TRY(parts);
    SessionOptions options;
    options.backend = Backend::reference;
    options.reference.samples = samples;
    options.reference.stop = stop;
    Result<Session> session = Session::make(std::move(*parts), options);
    BN_TRY(session);
    Result<Frame> frame = session->render(desc_of(scenes_[scene].data->scene));
    BN_TRY(frame);
    if (frame->stats.sampling.stopped)
        return Error{ExitCode::stopped, "", "", "stopped"};
    return ReferencePicture{std::move(frame->color), std::move(frame->variance)};
}

} // namespace burnish
