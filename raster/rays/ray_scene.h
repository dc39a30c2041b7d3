// The scene for rays: triangles of the draw tables under their global ids. Implementations: ray_tree.h, and Embree for references.
#pragma once
#include <cstdint>
#include <string>

namespace burnish {

inline constexpr int kRays = 16; // per packet
inline constexpr std::uint32_t kNoHit = 0xffffffffu;

// Sixteen rays with their hits, a field per row. Embree's layout for packets of sixteen, so that its library reads it too.
struct alignas(64) RayPacket {
    float org_x[kRays], org_y[kRays], org_z[kRays], tnear[kRays];
    float dir_x[kRays], dir_y[kRays], dir_z[kRays], time[kRays];
    float tfar[kRays]; // replaced by the hit's distance, in lengths of dir; -inf where an occlusion query found a hit
    std::uint32_t mask[kRays], id[kRays], flags[kRays];
    float ng_x[kRays], ng_y[kRays], ng_z[kRays], u[kRays], v[kRays]; // u, v: weights of the second and third vertex
    std::uint32_t triangle[kRays];                                   // global id, undefined if `geometry` is kNoHit
    std::uint32_t geometry[kRays], instance[kRays];
    // Not in Embree's layout:
    std::int32_t valid[kRays]; // -1 trace, 0 skip
};

// Light rays pass through surfaces that show an area light, unless the light is solid.
enum class RayKind : std::int32_t {
    camera,   // meets all area lights; passes the backs of single-sided materials, which the rasterizer culls
    bounce,   // meets every surface
    occlusion // meets every surface; tells only that there is a hit
};

class RayScene {
  public:
    virtual ~RayScene() = default;
    virtual void trace(RayPacket& rays, RayKind kind) const = 0;
    virtual std::string description() const = 0; // the library and its version
};

} // namespace burnish
