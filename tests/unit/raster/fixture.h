// Small scenes built from bare triangles, and the tile renderer around them.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "raster/frame/frame.h"
#include "raster/tile/tile_renderer.h"

namespace burnish::test {

std::vector<Isa> available_isas();

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

// A scene with everything a renderer needs, under an environment of one constant radiance.
struct Stage {
    explicit Stage(Scene s, float radiance = 1.0f, int threads = 1);
    Scene scene;
    DrawTables tables;
    Jobs jobs;
    Environment environment;
    DfgTable dfg;
    Frame render(const FrameDesc& desc, Isa isa) const;
};

// An orthographic view of width x height pixels in which x and y are pixels from the image's top left corner, y up is negative:
// the world position (x, -y, 0) lands on pixel position (x, y).
View pixel_view(int width, int height);

} // namespace burnish::test
