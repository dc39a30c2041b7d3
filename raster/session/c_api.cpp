// The C interface: scenes, pictures, comparisons.
#include <cstring>
#include <functional>

#include "core/image/io/image_io.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/jobs/activity.h"
#include "core/scene/add_mesh.h"
#include "core/scene/area_light.h"
#include "raster/frame/layers.h"
#include "raster/session/c_calls.h"
#include "raster/session/mirror.h"
#include "raster/session/told.h"

namespace burnish {
namespace {

// Appends a mesh; `place` is its own.
Status add_mesh(const burnish_mesh& mesh, const std::string& place, Scene& scene)
{
    if (mesh.size < sizeof(burnish_mesh))
        return usage(place + "/size", "is smaller than burnish_mesh");
    if (mesh.triangles && mesh.triangle_count == 0)
        return usage(place + "/triangles", "are missing");
    if (mesh.triangle_count > 0x7fffffffu / 3 || mesh.vertex_count > 0x7fffffffu)
        return usage(place + "/triangle_count", "is too large");
    const std::size_t vertices = mesh.positions ? mesh.vertex_count : 0;
    MeshInput input;
    input.positions = {reinterpret_cast<const glm::vec3*>(mesh.positions), vertices};
    if (mesh.normals)
        input.normals = {reinterpret_cast<const glm::vec3*>(mesh.normals), vertices};
    if (mesh.coordinates)
        input.coordinates = {reinterpret_cast<const glm::vec2*>(mesh.coordinates), vertices};
    if (mesh.triangles)
        input.triangles = {mesh.triangles, 3 * mesh.triangle_count};
    for (int i = 0; mesh.transform && i < 16; ++i)
        input.transform[i / 4][i % 4] = mesh.transform[i];
    input.material.metallic = 0.0f;
    if (const Status set = set_material(input.material, mesh.material); !set)
        return Error{set.error().code, "", place + "/material/" + set.error().place, set.error().reason};
    const Result<std::int32_t> added = add_mesh(scene, input);
    return added ? Status() : Status(added.error());
}

// Loads the environment that is named, else the environment of the options' picture, else the scene's default one.
Result<std::shared_ptr<const Environment>> environment_of(const burnish_options* options, const CSettings& settings,
                                                          const char* environment, const SceneData& scene, const Jobs& jobs)
{
    if (environment || !options || options->environment.empty())
        return load_shared_environment(environment ? environment : default_environment(scene), settings.open.environment,
                                       settings.open.limits, jobs);
    Result<Environment> baked = bake_environment(options->environment, "environment", settings.open.environment, jobs);
    BN_TRY(baked);
    return std::make_shared<const Environment>(std::move(*baked));
}

// Makes the session of a loaded scene.
Status finish_open(const burnish_options* options, const CSettings& settings, std::shared_ptr<const Jobs> jobs,
                   std::shared_ptr<const SceneData> scene, const char* environment, burnish_session** out)
{
    SessionParts parts;
    parts.jobs = std::move(jobs);
    parts.scene = std::move(scene);
    const auto loaded = environment_of(options, settings, environment, *parts.scene, *parts.jobs);
    BN_TRY(loaded);
    parts.environment = *loaded;
    Result<Session> session = Session::make(std::move(parts));
    BN_TRY(session);
    *out = new burnish_session{std::move(*session), settings.floor.kind == FloorKind::mirror};
    return {};
}

// Makes a frame with its layers split off.
Status make_frame(Frame frame, const CSettings& settings, const Session& session, burnish_frame** to)
{
    const std::vector<std::string>& layers = settings.layers;
    auto out = std::make_unique<burnish_frame>();
    if (!layers.empty()) {
        Result<NamedChannels> layered = with_layers(frame.color, frame, session.tables(), layers);
        BN_TRY(layered);
        out->layered = std::move(*layered);
    }
    std::size_t first = static_cast<std::size_t>(frame.color.channels);
    const std::size_t channels = static_cast<std::size_t>(out->layered.image.channels);
    for (const std::string& name : layers)
        for (const LayerInfo& layer : burnish::layers())
            if (layer.name == name) {
                std::vector<float> values;
                const std::size_t pixels = static_cast<std::size_t>(frame.color.width) * static_cast<std::size_t>(frame.color.height);
                for (std::size_t p = 0; p < pixels; ++p)
                    for (std::size_t c = 0; c < layer.channels.size(); ++c)
                        values.push_back(out->layered.image.f32()[p * channels + first + c]);
                first += layer.channels.size();
                out->names.emplace_back(name, static_cast<int>(layer.channels.size()));
                out->taken.push_back(std::move(values));
            }
    out->frame = std::move(frame);
    out->resolve = settings.resolve;
    *to = out.release();
    return {};
}

Result<FrameDesc> desc_of(const CSettings& settings, const Session& session)
{
    const MipSettings& mips = session.parts().scene->asked;
    if ((takes_net(mips.filter) || mips.gains) && settings.desc.brdf != mips.brdf)
        return usage("brdf", "the scene's mip levels are for the lobes of ggx: load it without a net and mip_gain");
    FrameDesc desc = settings.desc;
    const Result<View> view = view_of(settings, session);
    BN_TRY(view);
    desc.view = *view;
    BN_TRY(ask_for_layers(settings.layers, desc));
    return desc;
}

// Draws a frame with the shadows and the reflection that were asked for.
Result<Frame> draw(const ShadowSettings& shadows, FrameDesc desc, burnish_session& of)
{
    const bool shaded = casts_shadows(shadows, desc, of.session);
    desc.layers = desc.layers || shaded, desc.triangle_ids = desc.triangle_ids || of.mirrors;
    Result<Frame> frame = of.session.render(desc);
    if (frame && shaded)
        BN_TRY(add_shadows(shadows, desc, of.session, *frame));
    if (frame && of.mirrors)
        BN_TRY(add_reflection(shadows, desc, of.session, *frame));
    return frame;
}

std::function<int(const char*, double)> teller(const burnish_options* options)
{
    if (!options || !options->progress)
        return nullptr;
    return [options](const char* work, double done) { return options->progress(options->user, work, done); };
}

// Returns the frame as 8-bit sRGB.
Image shown(const burnish_frame& frame, float exposure_ev)
{
    return tonemap_to_srgb8(frame.frame.color, frame.tonemap, exposure_ev, frame.frame.parts, frame.resolve);
}

Status check_exposure(float exposure_ev)
{
    constexpr float kMostExposure = 64.0f; // stops in both directions
    return std::fabs(exposure_ev) <= kMostExposure ? Status() : Status(usage("exposure", "must lie in -64..64"));
}

} // namespace
} // namespace burnish

using namespace burnish;

int burnish_open(const char* scene, const char* environment, const burnish_options* options, burnish_session** out)
{
    return guarded_call([&]() -> Status {
        if (!scene || !out)
            return usage(scene ? "out" : "scene", "is NULL");
        const Result<CSettings> settings = settings_of(options, BURNISH_OPEN);
        BN_TRY(settings);
        return run_told(teller(options), [&]() -> Status {
            const auto jobs = std::make_shared<const Jobs>(settings->open.threads);
            const auto loaded = load_scene_data(scene, settings->open.limits, settings->overrides, settings->mips, settings->moment,
                                                settings->lights, settings->floor, jobs.get());
            BN_TRY(loaded);
            return finish_open(options, *settings, jobs, *loaded, environment, out);
        });
    });
}

int burnish_open_meshes(const burnish_mesh* meshes, size_t count, const char* environment, const burnish_options* options,
                        burnish_session** out)
{
    return guarded_call([&]() -> Status {
        if (!out)
            return usage("out", "is NULL");
        if (count == 0)
            return usage("meshes", "at least one is needed");
        if (!meshes)
            return usage("meshes", "is NULL");
        if (meshes->size < sizeof(burnish_mesh) || meshes->size % alignof(burnish_mesh) != 0)
            return usage("/meshes/0/size", "is not the size of burnish_mesh");
        const Result<CSettings> settings = settings_of(options, BURNISH_OPEN_MESHES);
        BN_TRY(settings);
        return run_told(teller(options), [&]() -> Status {
            const Activity activity("reading meshes");
            Scene scene;
            for (size_t i = 0; i < count; ++i) {
                check_stop();
                const auto* const mesh =
                    reinterpret_cast<const char*>(meshes) + i * meshes->size; // callers of a later version have larger ones
                BN_TRY(add_mesh(*reinterpret_cast<const burnish_mesh*>(mesh), "/meshes/" + std::to_string(i), scene));
            }
            for (AreaLight light : settings->lights) {
                BN_TRY(read_area_texture(scene, light, settings->open.limits));
                add_area_light(scene, light);
            }
            const auto made = make_scene_data("meshes", std::move(scene), settings->open.limits);
            BN_TRY(made);
            return finish_open(options, *settings, std::make_shared<const Jobs>(settings->open.threads), *made, environment, out);
        });
    });
}

void burnish_close(burnish_session* session)
{
    delete session;
}

namespace {

// Returns the index of the first named object with the name, or -1.
template <class T> int find_named(const std::vector<T>& list, const char* name)
{
    const auto at = std::find_if(list.begin(), list.end(), [&](const T& object) { return name && object.name == name; });
    return at == list.end() ? -1 : static_cast<int>(at - list.begin());
}

// Returns the name at an index, or null.
template <class T> const char* name_at(const std::vector<T>& list, int index)
{
    return index >= 0 && static_cast<std::size_t>(index) < list.size() ? list[static_cast<std::size_t>(index)].name.c_str() : nullptr;
}

// Returns an error unless the index lies in a list.
Status check_index(const char* what, int index, std::size_t size)
{
    return index >= 0 && static_cast<std::size_t>(index) < size
               ? Status()
               : Status(usage(what, std::to_string(index) + ": the scene has " + std::to_string(size)));
}

} // namespace

int burnish_find_node(const burnish_session* session, const char* name)
{
    return session ? find_named(session->session.scene().nodes, name) : -1;
}

int burnish_find_material(const burnish_session* session, const char* name)
{
    return session ? find_named(session->session.scene().materials, name) : -1;
}

int burnish_find_light(const burnish_session* session, const char* name)
{
    return session ? find_named(session->session.scene().lights, name) : -1;
}

const char* burnish_scene_node(const burnish_session* session, int index)
{
    return session ? name_at(session->session.scene().nodes, index) : nullptr;
}

const char* burnish_scene_material(const burnish_session* session, int index)
{
    return session ? name_at(session->session.scene().materials, index) : nullptr;
}

const char* burnish_scene_light(const burnish_session* session, int index)
{
    return session ? name_at(session->session.scene().lights, index) : nullptr;
}

const char* burnish_scene_variant(const burnish_session* session, int index)
{
    if (!session || index < 0)
        return nullptr;
    const std::vector<std::string>& variants = session->session.scene().variants;
    return static_cast<std::size_t>(index) < variants.size() ? variants[static_cast<std::size_t>(index)].c_str() : nullptr;
}

const char* burnish_warning(const burnish_session* session, int index)
{
    if (!session || index < 0)
        return nullptr;
    const std::vector<std::string>& of_scene = session->session.scene().warnings;
    const std::vector<std::string>& of_light = session->session.parts().environment->warnings;
    const auto at = static_cast<std::size_t>(index);
    if (at < of_scene.size())
        return of_scene[at].c_str();
    return at - of_scene.size() < of_light.size() ? of_light[at - of_scene.size()].c_str() : nullptr;
}

int burnish_set_node(burnish_session* session, int node, const float* matrix)
{
    return guarded_call([&]() -> Status {
        if (!session || !matrix)
            return usage(session ? "matrix" : "session", "is NULL");
        BN_TRY(check_index("node", node, session->session.scene().nodes.size()));
        SceneChanges changes;
        changes.nodes.emplace_back(node, glm::mat4(1.0f));
        for (int i = 0; i < 16; ++i)
            changes.nodes[0].second[i / 4][i % 4] = matrix[i];
        return session->session.change(std::move(changes));
    });
}

int burnish_set_material(burnish_session* session, int material, const burnish_options* factors)
{
    return guarded_call([&]() -> Status {
        if (!session)
            return usage("session", "is NULL");
        const std::vector<Material>& materials = session->session.scene().materials;
        BN_TRY(check_index("material", material, materials.size()));
        SceneChanges changes;
        changes.materials.emplace_back(material, materials[static_cast<std::size_t>(material)]);
        BN_TRY(set_material(changes.materials[0].second, factors));
        return run_told(teller(factors), [&] { return session->session.change(std::move(changes)); });
    });
}

int burnish_set_primitive_material(burnish_session* session, int primitive, int material)
{
    return guarded_call([&]() -> Status {
        if (!session)
            return usage("session", "is NULL");
        const Scene& scene = session->session.scene();
        BN_TRY(check_index("primitive", primitive, scene.primitives.size()));
        BN_TRY(check_index("material", material, scene.materials.size()));
        SceneChanges changes;
        changes.primitives.emplace_back(primitive, material);
        return session->session.change(std::move(changes));
    });
}

int burnish_set_light(burnish_session* session, int light, const burnish_options* factors)
{
    return guarded_call([&]() -> Status {
        if (!session)
            return usage("session", "is NULL");
        const std::vector<Light>& lights = session->session.scene().lights;
        BN_TRY(check_index("light", light, lights.size()));
        SceneChanges changes;
        changes.lights.emplace_back(light, lights[static_cast<std::size_t>(light)]);
        BN_TRY(set_light(changes.lights[0].second, factors));
        return session->session.change(std::move(changes));
    });
}

int burnish_set_environment(burnish_session* session, const char* environment, const burnish_options* options)
{
    return guarded_call([&]() -> Status {
        if (!session)
            return usage("session", "is NULL");
        const Result<CSettings> settings = settings_of(options, BURNISH_SET_ENVIRONMENT);
        BN_TRY(settings);
        return run_told(teller(options), [&]() -> Status {
            const SessionParts& parts = session->session.parts();
            const auto loaded = environment_of(options, *settings, environment, *parts.scene, *parts.jobs);
            BN_TRY(loaded);
            SceneChanges changes;
            changes.environment = *loaded;
            return session->session.change(std::move(changes));
        });
    });
}

int burnish_render(burnish_session* session, const burnish_options* options, burnish_frame** out)
{
    return guarded_call([&]() -> Status {
        if (!session || !out)
            return usage(session ? "out" : "session", "is NULL");
        const Result<CSettings> settings = settings_of(options, BURNISH_RENDER);
        BN_TRY(settings);
        Result<FrameDesc> desc = desc_of(*settings, session->session);
        BN_TRY(desc);
        desc->parts = settings->resolve != Resolve::linear;
        Result<Frame> frame = run_told(teller(options), [&] { return draw(settings->shadows, *desc, *session); });
        BN_TRY(frame);
        return make_frame(std::move(*frame), *settings, session->session, out);
    });
}

int burnish_reference(burnish_session* session, const burnish_options* options, burnish_poll poll, void* user, burnish_frame** out)
{
    return guarded_call([&]() -> Status {
        if (!session || !out)
            return usage(session ? "out" : "session", "is NULL");
        Result<CSettings> settings = settings_of(options, BURNISH_REFERENCE);
        BN_TRY(settings);
        if (session->mirrors && settings->reference.mode != ReferenceMode::path)
            return usage("reference_mode", "the reference reflects on a mirror floor in mode path alone");
        if (settings->samples)
            settings->reference.samples = static_cast<std::uint64_t>(*settings->samples);
        settings->desc.technique = "mc", settings->desc.samples = 1;
        const Result<FrameDesc> desc = desc_of(*settings, session->session);
        BN_TRY(desc);
        SessionOptions as;
        as.backend = Backend::reference, as.reference = settings->reference;
        std::function<int(const char*, double)> tell = teller(options);
        if (poll)
            tell = [poll, user, also = tell](const char* work, double done) { return poll(user) != 0 || (also && also(work, done) != 0); };
        Result<Frame> frame = run_told(tell, [&]() -> Result<Frame> {
            Result<Session> reference = Session::make(session->session.parts(), as);
            BN_TRY(reference);
            return reference->render(*desc);
        });
        BN_TRY(frame);
        settings->layers.clear();
        return make_frame(std::move(*frame), *settings, session->session, out);
    });
}

int burnish_frame_width(const burnish_frame* frame)
{
    return frame ? frame->frame.color.width : 0;
}

int burnish_frame_height(const burnish_frame* frame)
{
    return frame ? frame->frame.color.height : 0;
}

const float* burnish_frame_pixels(const burnish_frame* frame)
{
    return frame ? frame->frame.color.f32() : nullptr;
}

const float* burnish_frame_variance(const burnish_frame* frame)
{
    return frame && !frame->frame.variance.empty() ? frame->frame.variance.f32() : nullptr;
}

const float* burnish_frame_layer(const burnish_frame* frame, const char* name, int* channels)
{
    for (std::size_t i = 0; frame && name && i < frame->names.size(); ++i)
        if (frame->names[i].first == name) {
            if (channels)
                *channels = frame->names[i].second;
            return frame->taken[i].data();
        }
    return nullptr;
}

uint64_t burnish_frame_hash(const burnish_frame* frame)
{
    return frame ? pixel_hash(frame->frame.color) : 0;
}

int burnish_frame_tonemap(burnish_frame* frame, const char* name)
{
    return guarded_call([&]() -> Status {
        if (!frame || !name)
            return usage(frame ? "name" : "frame", "is NULL");
        const Result<Tonemap> tonemap = parse_tonemap(name);
        if (!tonemap)
            return usage("tonemap", tonemap.error().reason);
        frame->tonemap = *tonemap;
        return {};
    });
}

int burnish_frame_rgba8(burnish_frame* frame, float exposure_ev, const unsigned char** pixels)
{
    return guarded_call([&]() -> Status {
        if (!frame || !pixels)
            return usage(frame ? "pixels" : "frame", "is NULL");
        BN_TRY(check_exposure(exposure_ev));
        const Image picture = shown(*frame, exposure_ev);
        const std::size_t count = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
        frame->rgba8.resize(4 * count);
        for (std::size_t p = 0; p < count; ++p) {
            std::memcpy(&frame->rgba8[4 * p],
                        reinterpret_cast<const unsigned char*>(picture.bytes.data()) + p * static_cast<std::size_t>(picture.channels), 3);
            frame->rgba8[4 * p + 3] = 255;
        }
        *pixels = frame->rgba8.data();
        return {};
    });
}

int burnish_frame_png(burnish_frame* frame, float exposure_ev, const unsigned char** bytes, size_t* size)
{
    return burnish_frame_png_told(frame, exposure_ev, nullptr, bytes, size);
}

int burnish_frame_png_told(burnish_frame* frame, float exposure_ev, const burnish_options* options, const unsigned char** bytes,
                           size_t* size)
{
    return guarded_call([&]() -> Status {
        if (!frame || !bytes || !size)
            return usage(!frame ? "frame" : !bytes ? "bytes" : "size", "is NULL");
        BN_TRY(check_exposure(exposure_ev));
        Result<std::string> png = run_told(teller(options), [&] {
            const Activity activity("encoding a picture");
            return encode_png(shown(*frame, exposure_ev));
        });
        BN_TRY(png);
        frame->png = std::move(*png);
        *bytes = reinterpret_cast<const unsigned char*>(frame->png.data()), *size = frame->png.size();
        return {};
    });
}

int burnish_write(const burnish_frame* frame, const char* path, float exposure_ev)
{
    return burnish_write_told(frame, path, exposure_ev, nullptr);
}

int burnish_write_told(const burnish_frame* frame, const char* path, float exposure_ev, const burnish_options* options)
{
    return guarded_call([&]() -> Status {
        if (!frame || !path)
            return usage(frame ? "path" : "frame", "is NULL");
        BN_TRY(check_exposure(exposure_ev));
        return run_told(teller(options), [&]() -> Status {
            const Activity activity(std::string("writing ") + path);
            if (!frame->names.empty() && stores_channels(path))
                return write_channels(path, frame->layered.image, frame->layered.names);
            if (stores_floats(path))
                return write_image(path, frame->frame.color);
            return write_image(path, shown(*frame, exposure_ev));
        });
    });
}

void burnish_frame_free(burnish_frame* frame)
{
    delete frame;
}

int burnish_compare(const float* reference, const float* test, int width, int height, burnish_comparison* out)
{
    return burnish_compare_told(reference, test, width, height, nullptr, out);
}

int burnish_compare_told(const float* reference, const float* test, int width, int height, const burnish_options* options,
                         burnish_comparison* out)
{
    return guarded_call([&]() -> Status {
        if (!reference || !test || !out)
            return usage(!reference ? "reference" : !test ? "test" : "out", "is NULL");
        if (out->size < sizeof(burnish_comparison))
            return usage("out", "its size is smaller than burnish_comparison");
        if (width < 1 || height < 1 || width > kMaxPictureSide || height > kMaxPictureSide)
            return usage(width < 1 || width > kMaxPictureSide ? "width" : "height", "must lie in 1..16384");
        Image a = make_image(width, height, 3, PixelType::f32), b = a;
        std::memcpy(a.bytes.data(), reference, a.bytes.size());
        std::memcpy(b.bytes.data(), test, b.bytes.size());
        if (not_finite_pixels(a, b))
            return Error{ExitCode::not_finite, "", "", "a pixel is NaN or Inf"};
        return run_told(teller(options), [&]() -> Status {
            const Activity activity("comparing");
            const Jobs jobs;
            const ErrorSummary flip = summarise_errors(flip_hdr(a, b, {}, jobs).error);
            const PixelFigures pixels = pixel_figures(a, b, jobs);
            *out = {out->size, flip.mean, flip.p99, flip.max, pixels.mse, pixels.rel_mse, pixels.max_abs, pixels.differing_fraction};
            return {};
        });
    });
}
