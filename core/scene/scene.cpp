#include "core/scene/scene.h"

namespace burnish {

namespace {

// Composes world matrices in double, so that long chains lose no digits. Ignores a parent that does not precede its
// child: check_scene() refuses such scenes. `exact`: includes the parts of translations beyond float precision.
std::vector<glm::dmat4> compose(const Scene& scene, bool exact, const glm::dvec3& origin)
{
    std::vector<glm::dmat4> world(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        world[i] = glm::dmat4(node.local);
        if (exact)
            world[i][3] += glm::dvec4(node.local_beyond, 0.0);
        if (node.parent >= 0 && static_cast<std::size_t>(node.parent) < i)
            world[i] = world[static_cast<std::size_t>(node.parent)] * world[i];
        else if (exact)
            world[i][3] -= glm::dvec4(origin, 0.0);
    }
    return world;
}

} // namespace

std::vector<glm::dmat4> exact_world(const Scene& scene)
{
    return compose(scene, true, glm::dvec3(0.0));
}

std::string material_text(const Scene& scene, const Material& of)
{
    return "material " + (of.name.empty() ? std::to_string(&of - scene.materials.data()) : "'" + of.name + "'");
}

void update_world(Scene& scene)
{
    // Scenes around 0 use the float values unchanged.
    const std::vector<glm::dmat4> world = compose(scene, scene.origin != glm::dvec3(0.0), scene.origin);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
        scene.nodes[i].world = glm::mat4(world[i]);
}

} // namespace burnish
