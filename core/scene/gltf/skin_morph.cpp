// Morph targets and skins (glTF 2.0, 3.7.2.2 and 3.7.3).
#include <cmath>
#include <fmt/format.h>

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/pose.h"

namespace burnish::gltf {

namespace {

// Returns the scene node made from a glTF node; kNone for a node outside the scene.
int scene_node_of(const Document& doc, int node)
{
    for (std::size_t i = 0; i < doc.node_sources.size(); ++i)
        if (doc.node_sources[i] == static_cast<std::size_t>(node))
            return static_cast<int>(i);
    return kNone;
}

// Returns the skin's joint matrices. world_of(node) returns a node's transform to world space.
template <class WorldOf> std::vector<glm::dmat4> joints_of(Document& doc, const Json& skin, const WorldOf& world_of)
{
    AccessorView inverse;
    if (const int accessor = get_index(skin, "inverseBindMatrices"); accessor >= 0) {
        inverse = accessor_view(doc, accessor);
        check_finite(doc, accessor, inverse);
    }
    std::vector<glm::dmat4> joints;
    for (std::size_t j = 0; j < skin["joints"].size(); ++j) {
        const int node = scene_node_of(doc, skin["joints"][j].get<int>());
        glm::dmat4 bind(1.0);
        if (inverse.components() == 16 && j < inverse.count())
            for (int c = 0; c < 4; ++c)
                for (int r = 0; r < 3; ++r) // the last row is 0 0 0 1
                    bind[c][r] = static_cast<double>(inverse.number(j, 4 * c + r));
        joints.push_back(node == kNone ? bind : world_of(static_cast<std::size_t>(node)) * bind);
    }
    return joints;
}

// Sets a skin's joints. Vertices 32 km away would lie on steps of 4 mm. Beyond, the skin is relative to a place near
// the first joint, which keeps all digits.
void settle_joints(Document& doc, const Json& skin, SkinMorph& skin_morph)
{
    constexpr double kFar = 32768.0; // metres
    skin_morph.joints = joints_of(doc, skin, [&](std::size_t node) { return glm::dmat4(doc.scene.nodes[node].world); });
    if (skin_morph.joints.empty())
        return;
    const glm::dvec3 first(skin_morph.joints[0][3]);
    if (!(std::fmax(std::fabs(first.x), std::fmax(std::fabs(first.y), std::fabs(first.z))) > kFar))
        return;
    const std::vector<glm::dmat4> world = exact_world(doc.scene);
    skin_morph.joints = joints_of(doc, skin, [&](std::size_t node) { return world[node]; });
    skin_morph.away = glm::dvec3(glm::vec3(glm::round(first)));
    for (glm::dmat4& joint : skin_morph.joints)
        joint[3] -= glm::dvec4(skin_morph.away, 0.0);
}

std::vector<float> floats_of(const AccessorView& view)
{
    std::vector<float> floats;
    floats.reserve(static_cast<std::size_t>(view.count()) * static_cast<std::size_t>(view.components()));
    for (std::uint64_t i = 0; i < view.count(); ++i)
        for (int c = 0; c < view.components(); ++c)
            floats.push_back(view.number(i, c));
    return floats;
}

AccessorView view_of(const std::vector<float>& floats, int components)
{
    if (floats.empty())
        return {};
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(floats.data()), floats.size() * sizeof(float));
    return *AccessorView::make(bytes, 0, 0, floats.size() / static_cast<std::size_t>(components), ComponentType::f32, {components, 1},
                               false);
}

// Adds a weighted morph target. `components` is the attribute's component count; the first three move.
void add_target(std::vector<float>& to, int components, const AccessorView& offsets, double weight)
{
    if (to.empty() || offsets.count() * static_cast<std::uint64_t>(components) != to.size())
        return; // check_moving() has reported it
    for (std::uint64_t i = 0; i < offsets.count(); ++i)
        for (int c = 0; c < 3; ++c) {
            float& number = to[static_cast<std::size_t>(i) * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)];
            number = static_cast<float>(static_cast<double>(number) + weight * static_cast<double>(offsets.number(i, c)));
        }
}

struct Influences {
    std::vector<AccessorView> joints, weights;
};

// Returns a vertex's joint matrices summed by normalized weights. Returns the identity for a vertex without weights.
glm::dmat4 matrix_of(const Influences& of, std::uint64_t vertex, const std::vector<glm::dmat4>& joints)
{
    glm::dmat4 sum(0.0);
    double weights = 0.0;
    for (std::size_t set = 0; set < of.joints.size(); ++set)
        for (int c = 0; c < 4; ++c) {
            const double weight = static_cast<double>(of.weights[set].number(vertex, c));
            const double joint = static_cast<double>(of.joints[set].number(vertex, c));
            if (weight <= 0.0 || !(joint < static_cast<double>(joints.size())))
                continue;
            sum += weight * joints[static_cast<std::size_t>(joint)];
            weights += weight;
        }
    return weights > 0.0 ? sum / weights : glm::dmat4(1.0);
}

void put(std::vector<float>& to, std::size_t at, const glm::dvec3& v)
{
    for (int c = 0; c < 3; ++c)
        to[at + static_cast<std::size_t>(c)] = static_cast<float>(v[c]);
}

glm::dvec3 vector_at(const std::vector<float>& from, std::size_t at)
{
    return {from[at], from[at + 1], from[at + 2]};
}

glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

void skin_by_joints(DeformedVertices& deformed, const Influences& influences, const std::vector<glm::dmat4>& joints,
                    const std::string& place)
{
    for (std::size_t v = 0; 3 * v < deformed.position.size(); ++v) {
        const glm::dmat4 m = matrix_of(influences, v, joints);
        const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
        const glm::dvec3 p = vector_at(deformed.position, 3 * v), moved = x * p.x + y * p.y + z * p.z + glm::dvec3(m[3]);
        if (!(std::fabs(moved.x) <= 1e30 && std::fabs(moved.y) <= 1e30 && std::fabs(moved.z) <= 1e30))
            fail(place, fmt::format("vertex {} is moved out of bounds by its joints", v));
        put(deformed.position, 3 * v, moved);
        // Transform normals by cofactors, which need no inverse. A mirroring matrix flips them.
        const glm::dvec3 cx = cross(y, z), cy = cross(z, x), cz = cross(x, y);
        const double side = x.x * cx.x + x.y * cx.y + x.z * cx.z < 0.0 ? -1.0 : 1.0;
        if (!deformed.normal.empty()) {
            const glm::dvec3 n = vector_at(deformed.normal, 3 * v);
            put(deformed.normal, 3 * v, side * (cx * n.x + cy * n.y + cz * n.z));
        }
        if (!deformed.tangent.empty()) {
            const glm::dvec3 t = vector_at(deformed.tangent, 4 * v);
            put(deformed.tangent, 4 * v, x * t.x + y * t.y + z * t.z);
            deformed.tangent[4 * v + 3] *= static_cast<float>(side);
        }
    }
}

} // namespace

SkinMorph skin_morph_of(Document& doc, std::size_t scene_node)
{
    const Json& node = doc.json["nodes"][doc.node_sources[scene_node]];
    SkinMorph skin_morph;
    const int mesh = get_index(node, "mesh");
    if (mesh < 0)
        return skin_morph;
    const Json* weights = get_member(node, "weights");
    if (!weights)
        weights = get_member(doc.json["meshes"][static_cast<std::size_t>(mesh)], "weights");
    if (weights)
        skin_morph.weights = weights->get<std::vector<double>>();
    if (std::all_of(skin_morph.weights.begin(), skin_morph.weights.end(), [](double w) { return w == 0.0; }))
        skin_morph.weights.clear();
    if (const int skin = get_index(node, "skin"); skin >= 0)
        settle_joints(doc, doc.json["skins"][static_cast<std::size_t>(skin)], skin_morph);
    return skin_morph;
}

DeformedVertices deform(Document& doc, const Json& primitive, const SkinMorph& by, Attributes& attributes, const AttributeOf& attribute,
                        const std::string& place)
{
    // Copy the attributes as floats
    doc.charge(attributes.position.count() * 10 * sizeof(float), place);
    DeformedVertices deformed{floats_of(attributes.position), floats_of(attributes.normal), floats_of(attributes.tangent)};
    // Add the weighted morph targets
    const Json* targets = get_member(primitive, "targets");
    for (std::size_t t = 0; targets && t < std::min(targets->size(), by.weights.size()); ++t) {
        const Json& target = (*targets)[t];
        add_target(deformed.position, 3, attribute(target, "POSITION", 3), by.weights[t]);
        add_target(deformed.normal, 3, attribute(target, "NORMAL", 3), by.weights[t]);
        add_target(deformed.tangent, 4, attribute(target, "TANGENT", 3), by.weights[t]);
    }
    // Deform by all sets of joints and weights
    if (!by.joints.empty()) {
        Influences influences;
        for (int set = 0;; ++set) {
            const AccessorView joints = attribute(primitive["attributes"], fmt::format("JOINTS_{}", set), 4),
                               weights = attribute(primitive["attributes"], fmt::format("WEIGHTS_{}", set), 4);
            if (joints.count() != attributes.position.count() || weights.count() != joints.count())
                break;
            influences.joints.push_back(joints), influences.weights.push_back(weights);
        }
        if (!influences.joints.empty())
            skin_by_joints(deformed, influences, by.joints, place);
    }
    // View the deformed attributes
    attributes.position = view_of(deformed.position, 3);
    attributes.normal = view_of(deformed.normal, 3);
    attributes.tangent = view_of(deformed.tangent, 4);
    return deformed;
}

} // namespace burnish::gltf
