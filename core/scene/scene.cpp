#include "core/scene/scene.h"

namespace burnish {

// A parent that does not come before its child counts as none: check_scene() refuses it.
void update_world(Scene& scene)
{
    // Products are formed in double and rounded once a node, so that long chains lose no digits.
    std::vector<glm::dmat4> world(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        world[i] = glm::dmat4(node.local);
        if (node.parent >= 0 && static_cast<std::size_t>(node.parent) < i)
            world[i] = world[static_cast<std::size_t>(node.parent)] * world[i];
        node.world = glm::mat4(world[i]);
    }
}

} // namespace burnish
