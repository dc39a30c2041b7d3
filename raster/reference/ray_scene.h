// The scene as rays meet it: triangles of the draw tables under their global ids. The only door to Embree.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"

namespace burnish {

inline constexpr int kRays = 16; // of a packet
inline constexpr std::uint32_t kNoHit = 0xffffffffu;

// Sixteen rays with their hits, a field a row: Embree's own layout for packets of sixteen.
struct alignas(64) RayPacket {
    float org_x[kRays], org_y[kRays], org_z[kRays], tnear[kRays];
    float dir_x[kRays], dir_y[kRays], dir_z[kRays], time[kRays];
    float tfar[kRays]; // becomes the distance of the hit, in lengths of dir; -inf where occluded() found something
    std::uint32_t mask[kRays], id[kRays], flags[kRays];
    float ng_x[kRays], ng_y[kRays], ng_z[kRays], u[kRays], v[kRays]; // u, v: weights of the second and the third vertex
    std::uint32_t triangle[kRays];                                   // global id, undefined where `geometry` is kNoHit
    std::uint32_t geometry[kRays], instance[kRays];
    // not Embree's:
    std::int32_t valid[kRays]; // -1 trace, 0 leave alone
};

// Rays of light pass through what shows an area light, unless that is solid.
enum class RayKind : std::int32_t {
    camera,   // meets all area lights; passes through the backs of single-sided materials, as the rasterizer culls them
    bounce,   // meets every surface
    occlusion // meets every surface; only whether there is one
};

class RayScene {
  public:
    virtual ~RayScene() = default;
    virtual void trace(RayPacket& rays, RayKind kind) const = 0;
    virtual std::string description() const = 0; // the library and its version
};

bool ray_scene_available();
// An Error with ExitCode::unavailable where Embree was not there when the program was built.
// Builds its tree on the threads of oneTBB, where `jobs` has them, else on the calling one.
Result<std::unique_ptr<RayScene>> make_ray_scene(const Scene& scene, const DrawTables& tables, const Jobs& jobs);

} // namespace burnish
