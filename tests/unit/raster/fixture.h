// Small scenes built from bare triangles, and a tile renderer for them.
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

std::vector<Isa> available_isas(); // that the tile renderer supports on this machine

// Seeded random numbers, equal on every machine (SplitMix64).
struct Random {
    std::uint64_t state;
    std::uint64_t next();
    int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
    float unit() { return static_cast<float>(next() >> 40) * 0x1p-24f; }
};

using Triangle = std::array<glm::vec3, 3>;

// Returns one mesh with one material and face normals.
Scene scene_of(const std::vector<Triangle>& triangles, bool double_sided);
// Returns the walls of a cube around the origin, cells x cells squares each, visible from inside and outside.
std::vector<Triangle> tessellated_box(float half, int cells);
Scene plate(float metallic); // coloured, x and y in [-1, 1] at z = 0, seen from above
// Adds a point light. Intensity in candela, range in metres (0: unlimited).
void add_lamp(Scene& to, const glm::vec3& at, float intensity, float range = 0.0f);

// A scene with everything that a renderer needs, under an environment of constant radiance. Sessions that draw it share its parts, and
// tests may change the parts between them.
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

// Returns an orthographic view with width x height pixels, measured from the top left corner. The world position (x, -y, 0) lands on pixel
// position (x, y).
View pixel_view(int width, int height);

} // namespace burnish::test
