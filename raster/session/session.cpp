#include "raster/session/session.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "core/jobs/activity.h"
#include "core/scene/check_scene.h"
#include "core/scene/directional_roughness.h"
#include "core/scene/gltf/gltf.h"
#include "core/scene/height_map.h"
#include "core/scene/mtlx/mtlx.h"
#include "core/scene/origin.h"
#include "raster/frame/mip_files.h"
#include "raster/frame/pyramids.h"
#include "raster/session/check_parts.h"
#include "raster/session/guarded.h"
#include "raster/tile/tile_types.h"
#include "shading/bake/environment/turn.h"
#include "shading/bake/ltc/shipped.h"
#include "shading/bake/tables/phong_files.h"

namespace burnish {
namespace {

// Opens a device where options gives none, and keeps it there for later renderers.
Result<std::unique_ptr<Renderer>> make_renderer(const RenderInput& input, SessionOptions& options)
{
    const std::vector<Isa> known = isas_with<TileFns>(); // tests link more lanes than the program knows
    if (std::find(known.begin(), known.end(), options.isa) == known.end())
        return Error{ExitCode::unavailable, "", "SessionOptions::isa", "this processor or this program has no such instruction set"};
    switch (options.backend) {
    case Backend::reference: {
        ReferenceOptions reference = options.reference;
        reference.isa = options.isa;
        return make_reference_renderer(input, reference);
    }
    case Backend::vulkan: {
        if (!options.device) {
            Result<std::shared_ptr<VulkanDevice>> opened = open_vulkan_device(options.vulkan);
            BN_TRY(opened);
            options.device = std::move(*opened);
        }
        return make_vulkan_renderer(input, options.device);
    }
    case Backend::tile:
        return make_tile_renderer(input, options.isa);
    }
    return Error{ExitCode::usage, "", "", fmt::format("{} is no backend", static_cast<int>(options.backend)), "SessionOptions::backend"};
}

// Turns the normals and tangents of the frame's layers back to the scene's world space.
void turn_layers(const glm::dmat3& world_from_drawn, Frame& frame)
{
    const auto turn = [&](float(&v)[3]) {
        const glm::dvec3 turned = world_from_drawn * glm::dvec3(glm::vec3(v[0], v[1], v[2]));
        for (int i = 0; i < 3; ++i)
            v[i] = static_cast<float>(turned[i]);
    };
    for (PixelLayers& p : frame.layers)
        turn(p.normal), turn(p.tangent);
}

} // namespace

Result<std::shared_ptr<const ltc::ShadingTables>> load_ltc_table(const std::string& path, int lobe)
{
    using Made = Result<std::shared_ptr<const ltc::ShadingTables>>;
    return guarded(path, [&]() -> Made {
        if (lobe < 0 || lobe >= kLobeCount)
            return Error{ExitCode::usage, path, "lobe", fmt::format("{} is none of the models", lobe)};
        const Result<ltc::Table> table = ltc::read_table(path, 0);
        BN_TRY(table);
        Result<ltc::ShadingTables> tables = ltc::with_table(*table, path);
        BN_TRY(tables);
        const char* const model = ltc::kModelNames[static_cast<int>(tables->model)];
        if (tables->model != ltc::Model::ggx && lobe_model(lobe).name != std::string_view(model))
            return Error{ExitCode::bad_input, path, "byte 16",
                         fmt::format("is of {} lobes, which frames with FrameDesc::brdf {} have not", model, lobe_model(lobe).name)};
        return std::make_shared<const ltc::ShadingTables>(std::move(*tables));
    });
}

Result<std::shared_ptr<const PhongFiles>> load_phong_tables(const std::vector<std::string>& paths, const Limits& limits)
{
    using Made = Result<std::shared_ptr<const PhongFiles>>;
    return guarded(paths.empty() ? "" : paths.front(), [&]() -> Made {
        Result<PhongFiles> tables = PhongFiles::read(paths, limits);
        BN_TRY(tables);
        return std::make_shared<const PhongFiles>(std::move(*tables));
    });
}

namespace {

// Facts for mip filters, once all maps and heights are in place.
Status settle_mips(SceneData& data, const MipSettings& given, const MipSettings& asked, const Limits& limits)
{
    if (data.mips.baked && given.filter == MipFilter{})
        take_filters_of_mips(data.scene, data.mips);
    else
        BN_TRY(settle_nets(data.scene, data.mips, asked, limits));
    return data.mips.baked ? check_mips(data.scene, data.mips, given.pyramid) : Status();
}

// Returns true where a triangle of the primitive has an area in floats.
bool has_area(const Scene& scene, const Primitive& primitive)
{
    const VertexTable& v = scene.vertices;
    const auto place = [&](std::uint32_t i) {
        const std::uint32_t at = scene.indices[primitive.first_index + i];
        return glm::vec3(v.px[at], v.py[at], v.pz[at]);
    };
    for (std::uint32_t t = 0; t < primitive.index_count; t += 3)
        if (glm::cross(place(t + 1) - place(t), place(t + 2) - place(t)) != glm::vec3(0.0f)) // NaN: beyond floats, an area
            return true;
    return false;
}

// Refuses nodes that draw a mesh without triangles, or with triangles of which none has an area.
Status check_meshes_drawn(const Scene& scene, const std::string& name)
{
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == kNone)
            continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)];
        std::uint64_t indices = 0;
        bool seen = false;
        for (std::uint32_t k = 0; k < mesh.primitive_count; ++k) {
            const Primitive& primitive = scene.primitives[mesh.first_primitive + k];
            indices += primitive.index_count;
            seen = seen || has_area(scene, primitive);
        }
        if (!seen)
            return Error{ExitCode::bad_input, name, fmt::format("/nodes/{}/mesh", i),
                         indices == 0 ? "has no triangles" : "its triangles have no area in 32-bit floats"};
    }
    return {};
}

Result<std::shared_ptr<const SceneData>> make_settled_data(const std::string& name, Scene scene, const Limits& limits,
                                                           const MipSettings& given, const FloorSettings& floor = {})
{
    using Made = Result<std::shared_ptr<const SceneData>>;
    return guarded(name, [&]() -> Made {
        auto data = std::make_shared<SceneData>();
        data->name = name;
        data->scene = std::move(scene);
        MipSettings asked = given; // with the filter of the file of levels, where none is given
        std::shared_ptr<const MipFile> baked;
        if (!given.pyramid.empty()) {
            Result<std::shared_ptr<const MipFile>> read = read_mips(asked, limits);
            BN_TRY(read);
            baked = std::move(*read);
        }
        data->asked = asked;
        data->mips = asked_mips(asked, data->scene.materials.size());
        data->mips.baked = std::move(baked);
        BN_TRY(lay_directional_roughness(data->scene, limits, name));
        BN_TRY(pack_height_maps(data->scene, limits, name));
        settle_origin(data->scene);
        BN_TRY(add_emitters(data->scene, limits.area_lights, name));
        update_world(data->scene);
        Result<Column<float>> visibility = lay_floor(data->scene, floor, limits, name);
        BN_TRY(visibility);
        data->visibility = std::move(*visibility);
        data->mips.materials.resize(data->scene.materials.size());
        update_world(data->scene);
        BN_TRY(check_draw_size(data->scene, limits, name));
        data->tables = make_draw_tables(data->scene);
        darken_vertices(data->tables, data->visibility);
        BN_TRY(check_draw_range(data->scene, data->tables, name));
        warn_of_steps(data->scene);
        warn_of_unfiltered(data->scene, data->mips);
        BN_TRY(settle_mips(*data, given, asked, limits));
        return std::shared_ptr<const SceneData>(std::move(data));
    });
}

} // namespace

Result<std::shared_ptr<const SceneData>> make_scene_data(const std::string& name, Scene scene, const Limits& limits,
                                                         const MipSettings& mips)
{
    return guarded(name, [&]() -> Result<std::shared_ptr<const SceneData>> {
        fill_missing_columns(scene);
        update_world(scene);
        BN_TRY(check_scene(scene, limits, name));
        BN_TRY(check_mip_settings(mips));
        BN_TRY(check_meshes_drawn(scene, name));
        Result<std::shared_ptr<const SceneData>> data = make_settled_data(name, std::move(scene), limits, mips);
        if (data && (*data)->tables.draws.empty())
            return Error{ExitCode::bad_input, name, "/nodes", "draw nothing: no node has a mesh with an area"};
        return data;
    });
}

Result<std::shared_ptr<const SceneData>> load_scene_data(const std::string& spec, const Limits& limits, const MaterialOverrides& overrides,
                                                         const MipSettings& mips, const Moment& moment,
                                                         const std::vector<AreaLight>& lights, const FloorSettings& floor, const Jobs* jobs)
{
    using Made = Result<std::shared_ptr<const SceneData>>;
    return guarded(spec, [&]() -> Made {
        BN_TRY(check_mip_settings(mips));
        std::optional<Activity> activity("reading " + spec);
        Result<Scene> scene = load_scene(spec, limits, moment, jobs);
        BN_TRY(scene);
        if (overrides.material_is_document())
            BN_TRY(apply_mtlx(*scene, overrides.material, limits, jobs));
        BN_TRY(apply_material_overrides(*scene, overrides, limits, jobs));
        for (AreaLight light : lights) {
            BN_TRY(read_area_texture(*scene, light, limits));
            add_area_light(*scene, light);
        }
        activity.emplace("placing triangles and choosing mip filters");
        return make_settled_data(spec, std::move(*scene), limits, mips, floor);
    });
}

Result<std::shared_ptr<const Environment>> load_shared_environment(const std::string& spec, const EnvironmentOptions& options,
                                                                   const Limits& limits, const Jobs& jobs)
{
    using Made = Result<std::shared_ptr<const Environment>>;
    return guarded(spec, [&]() -> Made {
        const Activity activity("environment " + spec);
        Result<Environment> environment = load_environment(spec, options, limits, jobs);
        BN_TRY(environment);
        return std::make_shared<const Environment>(std::move(*environment));
    });
}

std::string default_environment(const SceneData& scene)
{
    return scene.scene.image_light ? scene.name : "builtin:studio";
}

Result<std::shared_ptr<const DfgTable>> standard_dfg(const Jobs& jobs)
{
    using Made = Result<std::shared_ptr<const DfgTable>>;
    return guarded("", [&]() -> Made {
        const Activity activity("directional albedo");
        static const std::shared_ptr<const DfgTable> table = std::make_shared<const DfgTable>(bake_dfg(kDfgSize, kDfgSamples, jobs));
        return table;
    });
}

Result<Session> Session::make(SessionParts parts, const SessionOptions& options)
{
    return make_with(std::move(parts), options, nullptr);
}

// pyramids: of an earlier renderer of the scene, or null.
Result<Session> Session::make_with(SessionParts parts, SessionOptions options, std::shared_ptr<PyramidCache> pyramids)
{
    if (!parts.scene || !parts.environment)
        return Error{ExitCode::usage, "", "", parts.scene ? "a session needs an environment" : "a session needs a scene",
                     parts.scene ? "SessionParts::environment" : "SessionParts::scene"};
    if (parts.scene->scene.materials.empty())
        return Error{ExitCode::usage, parts.scene->name, "", "is empty: load_scene_data() and make_scene_data() make scenes",
                     "SessionParts::scene"};
    if (options.backend != Backend::reference && parts.environment->irradiance.texels.empty())
        return Error{ExitCode::usage, parts.environment->name, "", "is empty, or a picture only, by which the reference alone draws",
                     "SessionParts::environment"};
    return guarded(parts.scene->name, [&]() -> Result<Session> {
        const Activity activity("preparing the renderer");
        if (!parts.jobs)
            parts.jobs = std::make_shared<const Jobs>(0);
        if (!parts.dfg) {
            const Result<std::shared_ptr<const DfgTable>> table = standard_dfg(*parts.jobs);
            BN_TRY(table);
            parts.dfg = *table;
        }
        BN_TRY(check_parts(parts));
        parts.turned.reset();
        if (parts.environment->rotation_deg != 0.0f) {
            const glm::dmat4 motion(sky_from_world(parts.environment->rotation_deg));
            DrawTables turned = make_draw_tables(parts.scene->scene, &motion);
            darken_vertices(turned, parts.scene->visibility);
            parts.turned = std::make_shared<const DrawTables>(std::move(turned));
        }
        if (!pyramids)
            pyramids = std::make_shared<PyramidCache>();
        RenderInput input = parts.input();
        input.pyramids = pyramids.get();
        Result<std::unique_ptr<Renderer>> renderer = make_renderer(input, options);
        BN_TRY(renderer);
        return Session(std::move(parts), std::move(options), std::move(pyramids), std::move(*renderer));
    });
}

Result<Session> Session::open(const std::string& scene, const std::string& environment, const OpenOptions& open,
                              const SessionOptions& options)
{
    if (constexpr int kMostThreads = 1024; open.threads < 0 || open.threads > kMostThreads)
        return Error{ExitCode::usage, "", "", fmt::format("{} threads; 1 to {}, or 0 for all", open.threads, kMostThreads),
                     "OpenOptions::threads"};
    return guarded(scene, [&]() -> Result<Session> {
        SessionParts parts;
        parts.jobs = std::make_shared<const Jobs>(open.threads);
        const Result<std::shared_ptr<const SceneData>> data = load_scene_data(scene, open.limits, {}, {}, {}, {}, {}, parts.jobs.get());
        BN_TRY(data);
        const Result<std::shared_ptr<const Environment>> light = load_shared_environment(
            environment.empty() ? default_environment(**data) : environment, open.environment, open.limits, *parts.jobs);
        BN_TRY(light);
        parts.scene = *data;
        parts.environment = *light;
        return make(std::move(parts), options);
    });
}

FrameDesc Session::drawn(const FrameDesc& desc) const
{
    FrameDesc out = desc;
    if (parts_.turned) {
        const glm::dmat3 motion = sky_from_world(parts_.environment->rotation_deg);
        for (glm::vec3* v : {&out.view.eye, &out.view.right, &out.view.up, &out.view.forward})
            *v = glm::vec3(motion * glm::dvec3(*v));
    }
    return out;
}

Result<Frame> Session::render(const FrameDesc& desc, Frame recycled)
{
    if (!renderer_)
        return moved_away();
    return guarded(parts_.scene->name, [&]() {
        Result<Frame> frame = render_any(desc, std::move(recycled));
        if (const std::uint64_t bad = frame ? count_not_finite(frame->color) : 0)
            frame = Error{ExitCode::not_finite, parts_.scene->name, "",
                          fmt::format("{} of {} pixels are NaN or Inf", bad, std::int64_t{desc.width} * desc.height)};
        return frame;
    });
}

Result<Frame> Session::render_any(const FrameDesc& desc, Frame recycled)
{
    if (!renderer_)
        return moved_away();
    return guarded(parts_.scene->name, [&]() {
        const Activity activity(fmt::format("drawing {}x{}", desc.width, desc.height));
        Result<Frame> frame = renderer_->render(drawn(desc), std::move(recycled));
        if (frame && parts_.turned)
            turn_layers(glm::transpose(sky_from_world(parts_.environment->rotation_deg)), *frame);
        return frame;
    });
}

} // namespace burnish
