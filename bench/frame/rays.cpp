// Primary visibility by rays: one ray through each pixel's centre, with 1, 8 or 16 coherent rays at once. Embree's own
// tree and traversal run at default settings (no filter, no robust mode). A packet's rays lie in a block of pixels,
// which suits packets.
#include "bench/frame/subject.h"

#ifdef BN_BENCH_EMBREE
#include <embree3/rtcore.h>

#include <cstring>
#include <limits>

namespace burnish {
namespace {

struct BlockShape {
    int width, height;
};
constexpr BlockShape block_of(int packet)
{
    return packet == 16 ? BlockShape{4, 4} : packet == 8 ? BlockShape{4, 2} : BlockShape{1, 1};
}

// The three ray layouts differ only in length.
template <int N> struct alignas(64) Packet {
    float org_x[N], org_y[N], org_z[N], tnear[N], dir_x[N], dir_y[N], dir_z[N], time[N], tfar[N];
    unsigned mask[N], id[N], flags[N];
    float ng_x[N], ng_y[N], ng_z[N], u[N], v[N];
    unsigned primitive[N], geometry[N], instance[N];
};
static_assert(sizeof(Packet<16>) == sizeof(RTCRayHit16) && sizeof(Packet<8>) == sizeof(RTCRayHit8) &&
              sizeof(Packet<1>) >= sizeof(RTCRayHit));

class RaySubject final : public Subject {
  public:
    static Result<std::unique_ptr<Subject>> make(const Workload& w, const SubjectOptions& options)
    {
        std::unique_ptr<RaySubject> self(new RaySubject(w, options));
        if (rtcGetDeviceError(self->device_) != RTC_ERROR_NONE)
            return Error{ExitCode::internal, "", "", "Embree cannot build its tree over the scene"};
        return std::unique_ptr<Subject>(std::move(self));
    }
    ~RaySubject() override
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    void frame() override
    {
        if (packet_ == 16)
            trace_all<16>();
        else if (packet_ == 8)
            trace_all<8>();
        else
            trace_all<1>();
    }
    double units() const override { return static_cast<double>(width_) * height_; }
    const Column<std::uint32_t>& triangle_ids() override
    {
        frame();
        return ids_;
    }
    std::string what() const override
    {
        const auto part = [&](RTCDeviceProperty p) { return std::to_string(rtcGetDeviceProperty(device_, p)); };
        return "Embree " + part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
               part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
    }

  private:
    RaySubject(const Workload& w, const SubjectOptions& options)
        : jobs_(w.threads ? w.threads : options.threads), width_(w.width), height_(w.height), packet_(w.packet)
    {
        const DrawTables tables = make_draw_tables(make_bench_scene(w.scene, w.size, w.width, w.height));
        view_ = bench_view(w.scene, tables, w.width, w.height);
        ids_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        device_ = rtcNewDevice(nullptr);
        scene_ = rtcNewScene(device_);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* position = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), tables.px.size()));
        auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                          3 * sizeof(std::uint32_t), tables.triangle_count()));
        for (std::size_t i = 0; i < tables.px.size(); ++i)
            position[3 * i] = tables.px[i], position[3 * i + 1] = tables.py[i], position[3 * i + 2] = tables.pz[i];
        std::memcpy(index, tables.indices.data(), tables.indices.size() * sizeof(std::uint32_t));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }

    template <int N> void trace_all()
    {
        constexpr BlockShape shape = block_of(N);
        constexpr int kStrip = 16; // rows in a task
        jobs_.parallel_for(static_cast<std::size_t>((height_ + kStrip - 1) / kStrip), [&](std::size_t strip, int) {
            const int first = static_cast<int>(strip) * kStrip, last = first + kStrip < height_ ? first + kStrip : height_;
            for (int y = first; y < last; y += shape.height)
                for (int x = 0; x < width_; x += shape.width)
                    trace_block<N>(x, y);
        });
    }

    template <int N> void trace_block(int x0, int y0)
    {
        constexpr BlockShape shape = block_of(N);
        alignas(64) int valid[16];
        Packet<N> p;
        const float step_x = 2.0f / static_cast<float>(width_), step_y = 2.0f / static_cast<float>(height_);
        for (int i = 0; i < N; ++i) {
            const int px = x0 + i % shape.width, py = y0 + i / shape.width;
            const float x = ((static_cast<float>(px) + 0.5f) * step_x - 1.0f) * view_.tan_half_x;
            const float y = (1.0f - (static_cast<float>(py) + 0.5f) * step_y) * view_.tan_half_y;
            valid[i] = px < width_ && py < height_ ? -1 : 0;
            p.org_x[i] = view_.eye.x, p.org_y[i] = view_.eye.y, p.org_z[i] = view_.eye.z, p.tnear[i] = 0.0f;
            p.dir_x[i] = view_.forward.x + view_.right.x * x + view_.up.x * y;
            p.dir_y[i] = view_.forward.y + view_.right.y * x + view_.up.y * y;
            p.dir_z[i] = view_.forward.z + view_.right.z * x + view_.up.z * y;
            p.time[i] = 0.0f, p.tfar[i] = std::numeric_limits<float>::infinity();
            p.mask[i] = 0xffffffffu, p.id[i] = 0, p.flags[i] = 0;
            p.geometry[i] = p.instance[i] = RTC_INVALID_GEOMETRY_ID;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        if constexpr (N == 16)
            rtcIntersect16(valid, scene_, &context, reinterpret_cast<RTCRayHit16*>(&p));
        else if constexpr (N == 8)
            rtcIntersect8(valid, scene_, &context, reinterpret_cast<RTCRayHit8*>(&p));
        else
            rtcIntersect1(scene_, &context, reinterpret_cast<RTCRayHit*>(&p));
        for (int i = 0; i < N; ++i)
            if (valid[i])
                ids_[static_cast<std::size_t>(y0 + i / shape.width) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x0 + i % shape.width)] =
                    p.geometry[i] == RTC_INVALID_GEOMETRY_ID ? 0xffffffffu : p.primitive[i];
    }

    Jobs jobs_;
    int width_, height_, packet_;
    View view_;
    Column<std::uint32_t> ids_;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

} // namespace

Result<std::unique_ptr<Subject>> make_ray_subject(const Workload& workload, const SubjectOptions& options)
{
    return RaySubject::make(workload, options);
}

} // namespace burnish
#else

namespace burnish {

Result<std::unique_ptr<Subject>> make_ray_subject(const Workload&, const SubjectOptions&)
{
    return Error{ExitCode::unavailable, "", "", "this build has no Embree"};
}

} // namespace burnish
#endif
