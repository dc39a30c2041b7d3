// Small scenes built from bare triangles, and the tile renderer around them.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "raster/frame/frame.h"
#include "raster/session/session.h"

namespace burnish::test {

std::vector<Isa> available_isas(); // those that the tile renderer has here

// Numbers from a seed, the same on every machine (SplitMix64).
struct Random {
    std::uint64_t state;
    std::uint64_t next();
    int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
    float unit() { return static_cast<float>(next() >> 40) * 0x1p-24f; }
};

using Triangle = std::array<glm::vec3, 3>;

// One mesh with one material; normals are the triangles' own.
Scene scene_of(const std::vector<Triangle>& triangles, bool double_sided);
// The walls of a cube about the origin, cells x cells squares each, seen from within and without.
std::vector<Triangle> tessellated_box(float half, int cells);
Scene plate(float metallic); // coloured, of x and y in [-1, 1] at z = 0, seen from above
// A point light; intensity in candela, range in metres, 0 is unlimited.
void add_lamp(Scene& to, const glm::vec3& at, float intensity, float range = 0.0f);

// A scene with everything a renderer needs, under an environment of one constant radiance. Sessions that draw it share its parts, which
// tests may change between them.
class Stage {
    struct Parts;
    explicit Stage(const std::shared_ptr<Parts>& parts);
    std::shared_ptr<Parts> parts_;

  public:
    explicit Stage(Scene s, float radiance = 1.0f, int threads = 1);
    Scene& scene;
    DrawTables& tables;
    SceneMips& mips;
    Environment& environment;
    DfgTable& dfg;
    const Jobs& jobs;
    SessionParts parts() const;
    RenderInput input() const { return {scene, tables, environment, dfg, jobs, nullptr, nullptr, mips}; }
    Frame render(const FrameDesc& desc, Isa isa) const;
};

// An orthographic view of width x height pixels in which x and y are pixels from the image's top left corner, y up is negative:
// the world position (x, -y, 0) lands on pixel position (x, y).
View pixel_view(int width, int height);

} // namespace burnish::test
