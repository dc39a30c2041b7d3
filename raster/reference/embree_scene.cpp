#include "raster/reference/embree_scene.h"

#include <embree3/rtcore.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <vector>

#include "core/base/check.h"
#include "core/jobs/control.h"
#include "core/jobs/cores.h"
#include "core/jobs/threads.h"

namespace burnish {
namespace {

static_assert(offsetof(RayPacket, org_x) == offsetof(RTCRayHit16, ray.org_x));
static_assert(offsetof(RayPacket, tfar) == offsetof(RTCRayHit16, ray.tfar));
static_assert(offsetof(RayPacket, flags) == offsetof(RTCRayHit16, ray.flags));
static_assert(offsetof(RayPacket, ng_x) == offsetof(RTCRayHit16, hit.Ng_x));
static_assert(offsetof(RayPacket, triangle) == offsetof(RTCRayHit16, hit.primID));
static_assert(offsetof(RayPacket, geometry) == offsetof(RTCRayHit16, hit.geomID));
static_assert(offsetof(RayPacket, valid) == sizeof(RTCRayHit16), "instancing of one level");
static_assert(kNoHit == RTC_INVALID_GEOMETRY_ID);

class EmbreeScene final : public RayScene {
  public:
    static Result<std::unique_ptr<RayScene>> make(const Scene& scene, const DrawTables& tables, const Jobs& jobs);
    ~EmbreeScene() override
    {
        rtcReleaseScene(seen_);
        rtcReleaseScene(in_the_way_);
        rtcReleaseDevice(device_);
    }
    void trace(RayPacket& rays, RayKind kind) const override;
    std::string description() const override;

  private:
    struct Part {                                   // some of the scene's triangles
        std::vector<std::uint32_t> ids;             // global ids, by Embree's primitive
        const std::uint8_t* single_sided = nullptr; // by global id
    };

    EmbreeScene() = default;
    Status add_part(const DrawTables& tables, unsigned part);
    static void cull(const RTCFilterFunctionNArguments* args);

    RTCDevice device_ = nullptr;
    RTCScene seen_ = nullptr;                // for cameras: both parts
    RTCScene in_the_way_ = nullptr;          // for light: surfaces; equals seen_ if no light is open
    Part parts_[2];                          // kSurfaces, kOpenLights
    std::vector<std::uint8_t> single_sided_; // by triangle
    bool any_single_sided_ = false;
};

constexpr unsigned kSurfaces = 0, kOpenLights = 1; // Embree's geometry ids of the parts

// Keeps oneTBB, which Embree uses to build trees, from starting threads while `meanwhile` lives. A thread that the system refuses ends the
// process, also when the limit goes; so it stays for the whole process where the system refuses threads.
void keep_tbb_idle(std::optional<tbb::global_control>& meanwhile)
{
    static const bool refused = given_threads(usable_cores()).count < usable_cores();
    meanwhile.emplace(tbb::global_control::max_allowed_parallelism, 1);
    if (refused) {
        static const tbb::global_control* const for_ever = new tbb::global_control(tbb::global_control::max_allowed_parallelism, 1);
        static_cast<void>(for_ever);
    }
}

// Converts Embree's error. what: as in "Embree cannot ...".
Error error_of(RTCError code, const std::string& what)
{
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        return {ExitCode::bad_input, "", "", "out of memory: Embree cannot " + what};
    if (code == RTC_ERROR_UNSUPPORTED_CPU)
        return {ExitCode::unavailable, "", "", "Embree cannot " + what + " on this processor"};
    return {ExitCode::internal, "", "", "Embree cannot " + what};
}

// Copies a part's triangles into a geometry, and attaches it to the scenes that contain the part.
Status EmbreeScene::add_part(const DrawTables& tables, unsigned part)
{
    const std::vector<std::uint32_t>& ids = parts_[part].ids;
    if (ids.empty())
        return {};
    const std::size_t vertices = tables.px.size();
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* position =
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices));
    auto* index = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), ids.size()));
    if (!position || !index) {
        rtcReleaseGeometry(geometry);
        return Error{ExitCode::bad_input, "", "", "out of memory for the rays' copy of the scene"};
    }
    for (std::size_t i = 0; i < vertices; ++i) {
        position[3 * i] = tables.px[i];
        position[3 * i + 1] = tables.py[i];
        position[3 * i + 2] = tables.pz[i];
    }
    for (std::size_t i = 0; i < ids.size(); ++i)
        std::memcpy(index + 3 * i, tables.indices.data() + std::size_t{3} * ids[i], 3 * sizeof(std::uint32_t));
    parts_[part].single_sided = single_sided_.data();
    rtcSetGeometryUserData(geometry, &parts_[part]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(seen_, geometry, part);
    if (part == kSurfaces && in_the_way_ != seen_)
        rtcAttachGeometryByID(in_the_way_, geometry, part);
    rtcReleaseGeometry(geometry);
    return {};
}

Result<std::unique_ptr<RayScene>> EmbreeScene::make(const Scene& scene, const DrawTables& tables, const Jobs& jobs)
{
    std::unique_ptr<EmbreeScene> self(new EmbreeScene);
    std::optional<tbb::global_control> only_callers;
    if (!jobs.by_onetbb())
        keep_tbb_idle(only_callers);
    self->device_ = rtcNewDevice(nullptr);
    if (!self->device_)
        return error_of(rtcGetDeviceError(nullptr), "be started");
    // Divide the triangles into surfaces and open lights
    const std::size_t triangles = tables.triangle_count();
    self->single_sided_.resize(triangles);
    for (std::size_t i = 0; i < triangles; ++i) {
        const Material& material = scene.materials[tables.triangle_material[i]];
        self->single_sided_[i] = !material.double_sided;
        self->any_single_sided_ = self->any_single_sided_ || self->single_sided_[i];
        self->parts_[material.emitter == kOpenEmitter ? kOpenLights : kSurfaces].ids.push_back(static_cast<std::uint32_t>(i));
    }
    // Make one scene, or two if there are open lights
    const auto new_scene = [&] {
        RTCScene made = rtcNewScene(self->device_);
        rtcSetSceneFlags(made, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
        return made;
    };
    self->seen_ = self->in_the_way_ = new_scene();
    if (self->parts_[kOpenLights].ids.empty())
        rtcRetainScene(self->seen_);
    else
        self->in_the_way_ = new_scene();
    for (const unsigned part : {kSurfaces, kOpenLights})
        BN_TRY(self->add_part(tables, part));
    std::stop_token stop = stop_here();
    for (const RTCScene built : {self->seen_, self->in_the_way_}) {
        rtcSetSceneProgressMonitorFunction(
            built, [](void* token, double) { return !static_cast<std::stop_token*>(token)->stop_requested(); }, &stop);
        rtcCommitScene(built);
        rtcSetSceneProgressMonitorFunction(built, nullptr, nullptr);
        check_stop();
    }
    if (const RTCError code = rtcGetDeviceError(self->device_); code != RTC_ERROR_NONE)
        return error_of(code, "build its tree over the scene");
    return std::unique_ptr<RayScene>(std::move(self));
}

// Filters out backs of single-sided triangles for camera rays. Fronts are counter-clockwise, so their normal faces the ray.
void EmbreeScene::cull(const RTCFilterFunctionNArguments* args)
{
    const auto* part = static_cast<const Part*>(args->geometryUserPtr);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] != -1 || !part->single_sided[part->ids[RTCHitN_primID(args->hit, n, i)]])
            continue;
        const float facing = RTCHitN_Ng_x(args->hit, n, i) * RTCRayN_dir_x(args->ray, n, i) +
                             RTCHitN_Ng_y(args->hit, n, i) * RTCRayN_dir_y(args->ray, n, i) +
                             RTCHitN_Ng_z(args->hit, n, i) * RTCRayN_dir_z(args->ray, n, i);
        if (facing >= 0.0f)
            args->valid[i] = 0;
    }
}

// Disables rays outside Embree's range, for instance with a NaN direction from a triangle without area. Embree would end the program.
void leave_out_far_rays(RayPacket& rays)
{
    constexpr float kLarge = 1.8e18f;
    for (int i = 0; i < kRays; ++i) {
        int sound = rays.tnear[i] <= rays.tfar[i]; // every comparison is false for a NaN
        for (const float coordinate : {rays.org_x[i], rays.org_y[i], rays.org_z[i], rays.dir_x[i], rays.dir_y[i], rays.dir_z[i]})
            sound &= std::abs(coordinate) < kLarge;
        rays.valid[i] &= -sound;
    }
}

void EmbreeScene::trace(RayPacket& rays, RayKind kind) const
{
    leave_out_far_rays(rays);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (kind == RayKind::camera) {
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        if (any_single_sided_)
            context.filter = cull;
    }
    for (int i = 0; i < kRays; ++i) {
        rays.time[i] = 0.0f;
        rays.mask[i] = 0xffffffffu, rays.flags[i] = 0, rays.id[i] = 0;
        rays.geometry[i] = rays.instance[i] = kNoHit;
    }
    const RTCScene met = kind == RayKind::camera ? seen_ : in_the_way_;
    if (kind == RayKind::occlusion) {
        rtcOccluded16(rays.valid, met, &context, reinterpret_cast<RTCRay16*>(&rays));
        return;
    }
    rtcIntersect16(rays.valid, met, &context, reinterpret_cast<RTCRayHit16*>(&rays));
    if (in_the_way_ == seen_)
        return; // one part, which has Embree's ids
    for (int i = 0; i < kRays; ++i)
        if (rays.valid[i] && rays.geometry[i] != kNoHit)
            rays.triangle[i] = parts_[rays.geometry[i]].ids[rays.triangle[i]];
}

std::string EmbreeScene::description() const
{
    const auto part = [&](RTCDeviceProperty p) { return std::to_string(rtcGetDeviceProperty(device_, p)); };
    return "Embree " + part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
           part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

} // namespace

bool embree_available()
{
    return true;
}

Result<std::unique_ptr<RayScene>> make_embree_scene(const Scene& scene, const DrawTables& tables, const Jobs& jobs)
{
    return EmbreeScene::make(scene, tables, jobs);
}

} // namespace burnish
