// What moves: animations at a moment, meshes that joints and morph targets bend, instances.
#pragma once
#include <functional>
#include <glm/glm.hpp>

#include "core/scene/gltf/document.h"
#include "core/scene/gltf/gltf.h"
#include "core/scene/gltf/vertices.h"

namespace burnish::gltf {

// Puts what an animation says at that moment into the JSON of its nodes (glTF 2.0, 3.11), once buffers are loaded. A moment after its end
// is its end, with a warning.
void set_moment(Document& doc, const Moment& moment);

// How a mesh is bent where a node places it.
struct Bend {
    std::vector<double> weights;    // of morph targets
    std::vector<glm::dmat4> joints; // from the mesh's space to world space, from `away` on; empty: no skin
    glm::dvec3 away{0.0};           // of a skin far from the origin; floats hold it
    bool any() const { return !weights.empty() || !joints.empty(); }
};
// Of the scene's node; its joints' places in world space are known. Nothing where all weights are 0 and there is no skin.
Bend bend_of(Document& doc, std::size_t scene_node);

// Positions, normals and tangents as they are once bent. It keeps what the attributes then refer to.
struct Bent {
    std::vector<float> position, normal, tangent;
};
using AttributeOf = std::function<AccessorView(const Json& attributes, const std::string& name, int components)>;
// primitive: its JSON; attribute: reads one of the attributes of an object in it.
Bent bend(Document& doc, const Json& primitive, const Bend& by, Attributes& attributes, const AttributeOf& attribute,
          const std::string& place);

// Local matrices of EXT_mesh_gpu_instancing; empty where the node has none.
std::vector<glm::mat4> instances_of(Document& doc, const Json& node, const std::string& place);

} // namespace burnish::gltf
