#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <vector>

#include "core/scene/check_columns.h"
#include "core/scene/check_scene.h"

namespace burnish {
namespace {

// Bound on coordinates in metres. Doubles clip triangles right up to here, with near planes from 1e-6 m on.
constexpr float kFarthest = 1e12f;
constexpr float kSmallest = 1e-15f; // metres across: squares of shorter lengths leave the range of floats

bool within(const glm::vec3& v, float most)
{
    return std::fabs(v.x) <= most && std::fabs(v.y) <= most && std::fabs(v.z) <= most; // false for NaN
}
bool finite(const glm::vec3& v)
{
    return within(v, std::numeric_limits<float>::max());
}
bool is_range(std::uint64_t first, std::uint64_t count, std::uint64_t size)
{
    return first + count <= size;
}

Status check_sizes(const DrawTables& t)
{
    for (const auto& [size, name] : {std::pair(t.py.size(), "py"), std::pair(t.pz.size(), "pz"), std::pair(t.shading.size(), "shading")})
        if (size != t.px.size())
            return scene_fault(fmt::format("/tables/{}", name), fmt::format("holds {} entries for {} vertices", size, t.px.size()));
    if (t.indices.size() % 3 != 0)
        return scene_fault("/tables/indices", fmt::format("{} is no multiple of 3", t.indices.size()));
    if (t.triangle_material.size() != t.triangle_count())
        return scene_fault("/tables/triangle_material",
                           fmt::format("holds {} entries for {} triangles", t.triangle_material.size(), t.triangle_count()));
    return {};
}

// Checks that ids are below `entries`. `what` names an entry.
Status check_ids(const Column<std::uint32_t>& ids, std::size_t entries, const char* column, const char* what)
{
    std::uint32_t most = 0;
    for (const std::uint32_t id : ids)
        most = std::max(most, id);
    if (ids.empty() || most < entries)
        return {};
    std::size_t i = 0;
    while (ids[i] < entries)
        ++i;
    return scene_fault(fmt::format("/tables/{}/{}", column, i), fmt::format("{} {} does not exist, there are {}", what, ids[i], entries));
}

Status check_numbers(const DrawTables& t)
{
    for (const auto& [column, name] : {std::pair(&t.px, "px"), std::pair(&t.py, "py"), std::pair(&t.pz, "pz")})
        if (const std::size_t i = first_not_finite(column->data(), column->size()); i < column->size())
            return scene_fault(fmt::format("/tables/{}/{}", name, i), "is NaN or infinite");
    constexpr std::size_t kFloats = sizeof(ShadingVertex) / sizeof(float);
    const float* const shading = reinterpret_cast<const float*>(t.shading.data());
    if (const std::size_t i = first_not_finite(shading, t.shading.size() * kFloats); i < t.shading.size() * kFloats)
        return scene_fault(fmt::format("/tables/shading/{}", i / kFloats), "is NaN or infinite");
    return {};
}

Status check_draws(const DrawTables& t, const Scene& scene)
{
    for (std::size_t i = 0; i < t.draws.size(); ++i) {
        const Draw& d = t.draws[i];
        const char* const wrong = !is_range(d.first_triangle, d.triangle_count, t.triangle_count())                  ? "triangle_count"
                                  : !is_range(d.first_vertex, d.vertex_count, t.px.size())                           ? "vertex_count"
                                  : d.material < 0 || static_cast<std::size_t>(d.material) >= scene.materials.size() ? "material"
                                  : d.node < kNone || (d.node >= 0 && static_cast<std::size_t>(d.node) >= scene.nodes.size()) ? "node"
                                  : !finite(d.bounds_min) || !finite(d.bounds_max)                                            ? "bounds_min"
                                                                                                                              : nullptr;
        if (wrong)
            return scene_fault(fmt::format("/tables/draws/{}/{}", i, wrong), "does not fit the tables");
    }
    for (std::size_t i = 0; i < t.clusters.size(); ++i) {
        const Cluster& c = t.clusters[i];
        const char* const wrong = !is_range(c.first_triangle, c.triangle_count, t.triangle_count()) ? "triangle_count"
                                  : c.triangle_count > kClusterTriangles                            ? "triangle_count"
                                  : c.draw >= t.draws.size()                                        ? "draw"
                                                                                                    : nullptr;
        if (wrong)
            return scene_fault(fmt::format("/tables/clusters/{}/{}", i, wrong), "does not fit the tables");
    }
    return {};
}

Status check_lights(const DrawTables& t, const Scene& scene)
{
    for (std::size_t i = 0; i < t.lights.size(); ++i)
        if (const PunctualLight& l = t.lights[i]; !finite(l.position) || !finite(l.direction) || !finite(l.radiant))
            return scene_fault(fmt::format("/tables/lights/{}", i), "holds a number that is not finite");
    for (std::size_t i = 0; i < t.area_lights.size(); ++i) {
        const PlacedAreaLight& l = t.area_lights[i];
        if (l.point_count < 1 || l.point_count > kMostAreaPoints)
            return scene_fault(fmt::format("/tables/area_lights/{}/point_count", i), fmt::format("{} points", l.point_count));
        if (l.texture < kNone || (l.texture >= 0 && static_cast<std::size_t>(l.texture) >= scene.textures.size()))
            return scene_fault(fmt::format("/tables/area_lights/{}/texture", i), fmt::format("texture {} does not exist", l.texture));
    }
    return {};
}

// Returns true where positions beyond the range of floats leave out a node's mesh. False where the mesh has no
// triangles or is flat.
bool leaves_floats(const Scene& scene, const Node& node, std::uint32_t drawn)
{
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    std::uint32_t wanted = 0;
    for (std::uint32_t k = 0; k < mesh.primitive_count; ++k)
        wanted += scene.primitives[mesh.first_primitive + k].index_count > 0;
    if (drawn >= wanted)
        return false;
    const glm::dmat4 world(node.world);
    const VertexTable& v = scene.vertices;
    for (std::uint32_t k = 0; k < mesh.primitive_count; ++k) {
        const Primitive& p = scene.primitives[mesh.first_primitive + k];
        for (std::size_t i = p.first_vertex; i < std::size_t{p.first_vertex} + p.vertex_count; ++i)
            if (!finite(glm::vec3(world * glm::dvec4(v.px[i], v.py[i], v.pz[i], 1.0))))
                return true;
    }
    return false;
}

} // namespace

Status check_draw_range(const Scene& scene, const DrawTables& tables, const std::string& file)
{
    std::vector<std::uint32_t> drawn(scene.nodes.size(), 0); // drawn primitives of each node
    for (const Draw& draw : tables.draws) {
        if (!within(draw.bounds_min, kFarthest) || !within(draw.bounds_max, kFarthest))
            return Error{ExitCode::bad_input, file, fmt::format("/nodes/{}", draw.node),
                         fmt::format("its mesh lies farther than {:g} m from the origin; scale the scene down", kFarthest)};
        if (draw.node >= 0)
            ++drawn[static_cast<std::size_t>(draw.node)];
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].mesh != kNone && leaves_floats(scene, scene.nodes[i], drawn[i]))
            return Error{ExitCode::bad_input, file, fmt::format("/nodes/{}", i), "its mesh leaves the range of floats"};
    if (const float side = tables.longest_side(); side > 0.0f && side < kSmallest)
        return Error{ExitCode::bad_input, file, "/nodes",
                     fmt::format("the scene is {:g} m across, less than {:g} m; scale the scene up", side, kSmallest)};
    return {};
}

Status check_draw_tables(const DrawTables& tables, const Scene& scene, const std::string& file)
{
    for (const Status& ok : {check_sizes(tables), check_ids(tables.indices, tables.px.size(), "indices", "vertex"),
                             check_ids(tables.triangle_material, scene.materials.size(), "triangle_material", "material"),
                             check_numbers(tables), check_draws(tables, scene), check_lights(tables, scene)})
        if (!ok)
            return fault_of_file(ok, file);
    return check_draw_range(scene, tables, file);
}

} // namespace burnish
