// Moving parts: animations at a moment, meshes deformed by joints and morph targets, instances.
#pragma once
#include <functional>
#include <glm/glm.hpp>

#include "core/scene/gltf/document.h"
#include "core/scene/gltf/gltf.h"
#include "core/scene/gltf/vertices.h"

namespace burnish::gltf {

// Writes an animation's values at `moment` into the JSON of its nodes (glTF 2.0, 3.11). Expects loaded buffers. A
// moment after the end becomes the end, with a warning.
void set_moment(Document& doc, const Moment& moment);

// Deformation of a mesh at a node.
struct SkinMorph {
    std::vector<double> weights;    // morph target weights
    std::vector<glm::dmat4> joints; // from the mesh's space to world space, relative to `away`; empty: no skin
    glm::dvec3 away{0.0};           // for a skin far from the origin; floats hold it exactly
    bool any() const { return !weights.empty() || !joints.empty(); }
};
// Returns the deformation at a scene node. Expects the joints' world transforms. Empty where all weights are 0 and there is no
// skin.
SkinMorph skin_morph_of(Document& doc, std::size_t scene_node);

// Deformed positions, normals and tangents. Owns the data that the attributes then view.
struct DeformedVertices {
    std::vector<float> position, normal, tangent;
};
using AttributeOf = std::function<AccessorView(const Json& attributes, const std::string& name, int components)>;
// Deforms a primitive. `primitive` is its JSON; `attribute` reads an attribute of an object in it.
DeformedVertices deform(Document& doc, const Json& primitive, const SkinMorph& by, Attributes& attributes, const AttributeOf& attribute,
                        const std::string& place);

// Returns the local matrices of EXT_mesh_gpu_instancing; empty where the node has none.
std::vector<glm::mat4> instances_of(Document& doc, const Json& node, const std::string& place);

} // namespace burnish::gltf
