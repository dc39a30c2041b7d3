#include "core/scene/origin.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace burnish {
namespace {

constexpr double kFar = 32.0;         // in radii: floats then still resolve 2^-19 of the distance
constexpr double kCoarse = 8192.0;    // steps across an object: fewer are visible
constexpr double kVisibleStep = 0.01; // metres: visible to a near viewer, in any distant object

struct Box {
    glm::dvec3 least{std::numeric_limits<double>::infinity()}, most{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& p) { least = glm::min(least, p), most = glm::max(most, p); }
    bool empty() const { return !(least.x <= most.x); }
    double extent() const { return std::max({most.x - least.x, most.y - least.y, most.z - least.z}); }
    double farthest() const // from 0, along an axis
    {
        const glm::dvec3 far = glm::max(glm::abs(least), glm::abs(most));
        return std::max({far.x, far.y, far.z});
    }
};

Box box_of(const VertexTable& v, const Primitive& primitive)
{
    Box box;
    for (std::size_t i = primitive.first_vertex; i < std::size_t{primitive.first_vertex} + primitive.vertex_count; ++i)
        box.add({v.px[i], v.py[i], v.pz[i]});
    return box;
}

Box moved(const Box& box, const glm::dmat4& to)
{
    Box out;
    for (int k = 0; k < 8 && !box.empty(); ++k)
        out.add(to * glm::dvec4(k & 1 ? box.most.x : box.least.x, k & 2 ? box.most.y : box.least.y, k & 4 ? box.most.z : box.least.z, 1.0));
    return out;
}

// Calls visit(node, the primitive's box in local space) for all primitives of all nodes.
template <class Visit> void each_box(const Scene& scene, const Visit& visit)
{
    std::vector<Box> boxes;
    boxes.reserve(scene.primitives.size());
    for (const Primitive& primitive : scene.primitives)
        boxes.push_back(box_of(scene.vertices, primitive));
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.mesh == kNone)
            continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        for (std::uint32_t k = 0; k < mesh.primitive_count; ++k)
            visit(i, boxes[mesh.first_primitive + k]);
    }
}

// Returns the distance between neighbouring floats at `place`.
double step_at(double place)
{
    return place > 0.0 && std::isfinite(place) ? std::ldexp(1.0, std::max(std::ilogb(place), -126) - 23) : 0.0;
}

// Returns the least power of two that is not below x.
double power_of_two(double x)
{
    return std::ldexp(1.0, static_cast<int>(std::ceil(std::log2(x))));
}

struct CoarsePlace {
    double step = 0.0, away = 0.0; // metres
    std::size_t node = 0;
    void worst(std::size_t of_node, double far, double extent, double metres)
    {
        const double found = step_at(far) * metres;
        const bool seen = extent > 0.0 && far > kFar * extent && (step_at(far) * kCoarse > extent || found >= kVisibleStep);
        if (seen && found > step)
            step = found, away = far * metres, node = of_node;
    }
};

} // namespace

void settle_origin(Scene& scene)
{
    scene.origin = glm::dvec3(0.0);
    const std::vector<glm::dmat4> world = exact_world(scene);
    Box all;
    each_box(scene, [&](std::size_t node, const Box& box) {
        const Box placed = moved(box, world[node]);
        if (!placed.empty())
            all.add(placed.least), all.add(placed.most);
    });
    const glm::dvec3 centre = 0.5 * (all.least + all.most);
    const double radius = 0.5 * glm::length(all.most - all.least);
    const double away = std::max({std::fabs(centre.x), std::fabs(centre.y), std::fabs(centre.z)});
    if (!all.empty() && radius > 0.0 && away > kFar * radius && away < 1e30) {
        // Round to a grid that is coarse beside the scene: translation by whole grid steps keeps the bits, and floats
        // hold the grid's points.
        const double grid = std::max(power_of_two(4.0 * radius), 2.0 * step_at(away));
        scene.origin = glm::round(centre / grid) * grid;
    }
    update_world(scene);
}

void warn_of_steps(Scene& scene)
{
    CoarsePlace vertices, nodes, lights;
    each_box(scene, [&](std::size_t i, const Box& box) {
        if (box.empty())
            return;
        const glm::dmat4 world(scene.nodes[i].world);
        const double scale = std::max({glm::length(world[0]), glm::length(world[1]), glm::length(world[2])});
        vertices.worst(i, box.farthest(), box.extent(), scale);
        const Box placed = moved(box, world);
        nodes.worst(i, placed.farthest(), placed.extent(), 1.0);
    });
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].area_light == kNone)
            continue;
        // Give a sphere or a line its radius
        const AreaLight& light = scene.area_lights[static_cast<std::size_t>(scene.nodes[i].area_light)];
        Box box;
        for (const glm::vec3& p : light.points)
            box.add(glm::dvec3(p) - static_cast<double>(light.radius)), box.add(glm::dvec3(p) + static_cast<double>(light.radius));
        if (!box.empty())
            lights.worst(i, box.farthest(), box.extent(), 1.0);
    }
    if (lights.step > 0.0)
        scene.warnings.push_back(fmt::format("points of area light '{}' are floats {:.6g} m from its node: they lie on steps of {:.3g} m",
                                             scene.nodes[lights.node].name, lights.away, lights.step));
    if (vertices.step > 0.0)
        scene.warnings.push_back(fmt::format("vertices of node '{}' are floats {:.6g} m from the node: they lie on steps of {:.3g} m",
                                             scene.nodes[vertices.node].name, vertices.away, vertices.step));
    else if (nodes.step > 0.0)
        scene.warnings.push_back(fmt::format("node '{}' lies {:.6g} m from the origin that the scene is drawn around, where floats hold "
                                             "places in steps of {:.3g} m",
                                             scene.nodes[nodes.node].name, nodes.away, nodes.step));
}

} // namespace burnish
