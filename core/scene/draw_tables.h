// DrawTables: a Scene with its node graph resolved to world space, the input of every renderer. Instances are expanded:
// each triangle has one global id, each vertex one place, and renderers never see a node.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/area_light.h"
#include "core/scene/scene.h"

namespace burnish {

// Vertex data for shading, one 64-byte cache line. Array of structs, because shading reads single vertices.
struct alignas(64) ShadingVertex {
    float normal[3];  // world space, unit
    float tangent[4]; // world space, unit; [3] = +1 or -1
    float pad;
    float uv0[2], uv1[2];
    float color[4]; // linear
};
static_assert(sizeof(ShadingVertex) == 64);

struct Draw { // one primitive of one node
    std::uint32_t first_triangle = 0, triangle_count = 0;
    std::uint32_t first_vertex = 0, vertex_count = 0;
    std::int32_t material = 0, node = kNone;
    std::uint32_t primitive = 0;
    bool stage = false;                           // a floor or backdrop, outside of the tables' bounds
    glm::vec3 bounds_min{0.0f}, bounds_max{0.0f}; // world space
};

inline constexpr std::uint32_t kClusterTriangles = 128;

// Consecutive triangles of one draw, culled together.
struct Cluster {
    std::uint32_t first_triangle = 0, triangle_count = 0;
    std::uint32_t draw = 0;
    glm::vec3 center{0.0f}; // bounding sphere, world space
    float radius = 0.0f;
    glm::vec3 cone_axis{0.0f}; // mean normal
    float cone_cutoff = 1.0f;  // back-facing where dot(center - eye, axis) >= cutoff * |center - eye| + radius; 1: never
};

struct PunctualLight { // light.def
#define BN_LIGHT_FIELD(kind, name, initial) FieldKinds::kind name = FieldKinds::kind(initial);
#include "core/scene/light.def"
};

struct DrawTables {
    Column<float> px, py, pz;      // positions, world space
    Column<ShadingVertex> shading; // same index as the positions
    Column<std::uint32_t> indices; // three for each triangle, absolute; counter-clockwise in world space (mirrored instances are flipped)
    Column<std::uint32_t> triangle_material; // for each triangle
    std::vector<Draw> draws;                 // in node order, then primitive order
    std::vector<Cluster> clusters;           // in triangle order
    std::vector<PunctualLight> lights;
    std::vector<PlacedAreaLight> area_lights;
    glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};
    std::size_t triangle_count() const { return indices.size() / 3; }
    float longest_side() const // of the bounds
    {
        const glm::vec3 sides = bounds_max - bounds_min;
        return std::max(sides.x, std::max(sides.y, sides.z));
    }
};

// Returns an Error where a scene's tables exceed the limits: a small file can ask for any number of instances. `file`
// names the scene.
Status check_draw_size(const Scene& scene, const Limits& limits, const std::string& file);

// Makes the tables. `motion` is an optional rigid transform of the whole world.
DrawTables make_draw_tables(const Scene& scene, const glm::dmat4* motion = nullptr);

} // namespace burnish
