#include "core/scene/gltf/graph.h"

#include <cmath>
#include <fmt/format.h>

namespace burnish::gltf {

namespace {

std::string place_of(std::size_t node)
{
    return fmt::format("/nodes/{}", node);
}

std::size_t index_of(int i)
{
    return static_cast<std::size_t>(i);
}

std::vector<int> find_parents(const Document& doc)
{
    const auto& nodes = doc.model.nodes;
    std::vector<int> parent(nodes.size(), kNone);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t k = 0; k < nodes[i].children.size(); ++k) {
            int& slot = parent[index_of(nodes[i].children[k])];
            if (slot != kNone)
                fail(fmt::format("/nodes/{}/children/{}", i, k),
                     fmt::format("node {} has two parents, {} and {}", nodes[i].children[k], slot, i));
            slot = static_cast<int>(i);
        }
    return parent;
}

// With one parent each, a node is below a root or below a cycle: walking up either ends or does not.
void check_forest(const Document& doc, const std::vector<int>& parent)
{
    std::vector<int> depth(parent.size(), 0); // 0: not known yet
    std::vector<std::size_t> path;
    for (std::size_t i = 0; i < parent.size(); ++i) {
        path.clear();
        std::size_t at = i;
        while (depth[at] == 0 && parent[at] != kNone && path.size() <= parent.size()) {
            path.push_back(at);
            at = index_of(parent[at]);
        }
        if (path.size() > parent.size())
            fail(place_of(at), "the node is its own ancestor (a cycle)");
        int below = depth[at] = depth[at] == 0 ? 1 : depth[at];
        for (auto it = path.rbegin(); it != path.rend(); ++it) {
            depth[*it] = ++below;
            if (below > doc.limits.node_depth)
                fail(place_of(*it), fmt::format("nodes are nested deeper than {} (--limit-node-depth)", doc.limits.node_depth));
        }
    }
}

glm::mat4 trs_matrix(const tinygltf::Node& node, const std::string& place)
{
    double q[4] = {0.0, 0.0, 0.0, 1.0}, s[3] = {1.0, 1.0, 1.0}, t[3] = {0.0, 0.0, 0.0};
    std::copy(node.rotation.begin(), node.rotation.end(), q);
    std::copy(node.scale.begin(), node.scale.end(), s);
    std::copy(node.translation.begin(), node.translation.end(), t);
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 1e-12 && length < 1e12))
        fail(place + "/rotation", "is not a unit quaternion");
    for (double& part : q)
        part /= length;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double columns[3][3] = {{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)},
                                  {2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)},
                                  {2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)}};
    glm::mat4 matrix(1.0f);
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            matrix[c][r] = static_cast<float>(columns[c][r] * s[c]);
    for (int r = 0; r < 3; ++r)
        matrix[3][r] = static_cast<float>(t[r]);
    return matrix;
}

glm::mat4 local_matrix(Document& doc, std::size_t index)
{
    const tinygltf::Node& node = doc.model.nodes[index];
    if (node.matrix.empty())
        return trs_matrix(node, place_of(index));
    glm::mat4 matrix;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            matrix[c][r] = static_cast<float>(node.matrix[index_of(c * 4 + r)]);
    constexpr float kTolerance = 1e-5f; // exporters write rounded numbers
    for (int c = 0; c < 4; ++c) {
        const float affine = c == 3 ? 1.0f : 0.0f;
        if (!(std::fabs(matrix[c][3] - affine) <= kTolerance))
            fail(place_of(index) + "/matrix", "the bottom row is not 0 0 0 1");
        matrix[c][3] = affine;
    }
    return matrix;
}

Node load_node(Document& doc, std::size_t index, int parent)
{
    const tinygltf::Node& source = doc.model.nodes[index];
    Node node;
    node.name = source.name;
    node.parent = parent;
    node.mesh = source.mesh;
    node.camera = source.camera;
    const auto light = source.extensions.find("KHR_lights_punctual");
    if (light != source.extensions.end())
        node.light = light->second.Get("light").GetNumberAsInt();
    node.local = local_matrix(doc, index);
    if (source.skin >= 0)
        doc.warn("skins are not supported; skinned meshes are drawn in their bind pose");
    return node;
}

struct Root {
    int node;
    std::string place; // where the file names it
};

std::vector<Root> find_roots(const Document& doc, const std::vector<int>& parent)
{
    std::vector<Root> roots;
    const tinygltf::Model& model = doc.model;
    if (model.scenes.empty()) {
        for (std::size_t i = 0; i < parent.size(); ++i)
            if (parent[i] == kNone)
                roots.push_back({static_cast<int>(i), place_of(i)});
        return roots;
    }
    const int scene = std::max(model.defaultScene, 0);
    const std::vector<int>& nodes = model.scenes[index_of(scene)].nodes;
    for (std::size_t k = 0; k < nodes.size(); ++k)
        roots.push_back({nodes[k], fmt::format("/scenes/{}/nodes/{}", scene, k)});
    return roots;
}

void check_worlds(const Document& doc, const std::vector<std::size_t>& sources)
{
    for (std::size_t i = 0; i < doc.scene.nodes.size(); ++i)
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                if (!std::isfinite(doc.scene.nodes[i].world[c][r]))
                    fail(place_of(sources[i]), "the transform to world space overflows");
}

} // namespace

void load_cameras_and_lights(Document& doc)
{
    for (const tinygltf::Camera& source : doc.model.cameras) {
        Camera camera;
        camera.name = source.name;
        camera.orthographic = source.type == "orthographic";
        if (camera.orthographic) {
            camera.xmag = static_cast<float>(source.orthographic.xmag);
            camera.ymag = static_cast<float>(source.orthographic.ymag);
            camera.znear = static_cast<float>(source.orthographic.znear);
            camera.zfar = static_cast<float>(source.orthographic.zfar);
        } else {
            camera.yfov = static_cast<float>(source.perspective.yfov);
            camera.znear = static_cast<float>(source.perspective.znear);
            camera.zfar = static_cast<float>(source.perspective.zfar); // 0 where the file has none
        }
        doc.scene.cameras.push_back(std::move(camera));
    }
    for (const tinygltf::Light& source : doc.model.lights) {
        Light light;
        light.name = source.name;
        light.type = source.type == "directional" ? LightType::directional : source.type == "spot" ? LightType::spot : LightType::point;
        for (int i = 0; i < 3 && source.color.size() == 3; ++i)
            light.color[i] = static_cast<float>(source.color[index_of(i)]);
        light.intensity = static_cast<float>(source.intensity);
        light.range = static_cast<float>(source.range);
        light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
        light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
        doc.scene.lights.push_back(std::move(light));
    }
}

void load_nodes(Document& doc)
{
    const std::vector<int> parent = find_parents(doc);
    check_forest(doc, parent);
    const std::vector<Root> roots = find_roots(doc, parent);
    std::vector<bool> visited(parent.size(), false);
    std::vector<std::size_t> sources; // by scene node, its glTF node
    struct Pending {
        int node, parent; // glTF, scene
    };
    std::vector<Pending> stack;
    for (const Root& root : roots) {
        stack.push_back({root.node, kNone});
        while (!stack.empty()) {
            const Pending next = stack.back();
            stack.pop_back();
            const std::size_t index = index_of(next.node);
            if (visited[index])
                fail(root.place, fmt::format("node {} is in the scene twice", next.node));
            visited[index] = true;
            const int id = static_cast<int>(doc.scene.nodes.size());
            doc.scene.nodes.push_back(load_node(doc, index, next.parent));
            sources.push_back(index);
            const std::vector<int>& children = doc.model.nodes[index].children;
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                stack.push_back({*child, id});
        }
    }
    if (!doc.model.scenes.empty())
        doc.scene.name = doc.model.scenes[index_of(std::max(doc.model.defaultScene, 0))].name;
    update_world(doc.scene);
    check_worlds(doc, sources);
}

} // namespace burnish::gltf
