#include "core/scene/gltf/graph.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "core/scene/area_light.h"
#include "core/scene/gltf/factors.h"
#include "core/scene/gltf/material.h"
#include "core/scene/gltf/pose.h"

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

const Json& node_json(const Document& doc, std::size_t node)
{
    return doc.json["nodes"][node];
}

std::vector<int> indices_of(const Json& object, const char* key)
{
    const Json* indices = get_member(object, key);
    return indices ? indices->get<std::vector<int>>() : std::vector<int>();
}

// Reads a number array where the object has one; else leaves `to` unchanged.
template <std::size_t N> void read_numbers(const Json& object, const char* key, double (&to)[N])
{
    if (const Json* numbers = get_member(object, key))
        for (std::size_t i = 0; i < N; ++i)
            to[i] = (*numbers)[i].get<double>();
}

std::vector<int> find_parents(const Document& doc)
{
    std::vector<int> parent(table_size(doc.json, "nodes"), kNone);
    for (std::size_t i = 0; i < parent.size(); ++i) {
        const std::vector<int> children = indices_of(node_json(doc, i), "children");
        for (std::size_t k = 0; k < children.size(); ++k) {
            int& slot = parent[index_of(children[k])];
            if (slot != kNone)
                fail(fmt::format("/nodes/{}/children/{}", i, k), fmt::format("node {} has two parents, {} and {}", children[k], slot, i));
            slot = static_cast<int>(i);
        }
    }
    return parent;
}

// Checks for cycles. Each node has one parent, so it is below a root or a cycle: a walk up from it ends, or does not.
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
                fail(place_of(*it), fmt::format("nodes are nested deeper than {} (Limits::node_depth)", doc.limits.node_depth));
        }
    }
}

} // namespace

bool is_rotation(const double* q)
{
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return length > 1e-12 && length < 1e12;
}

glm::mat4 trs_matrix(const Json& node, const std::string& place)
{
    double q[4] = {0.0, 0.0, 0.0, 1.0}, s[3] = {1.0, 1.0, 1.0}, t[3] = {0.0, 0.0, 0.0};
    read_numbers(node, "rotation", q);
    read_numbers(node, "scale", s);
    read_numbers(node, "translation", t);
    if (!is_rotation(q))
        fail(place + "/rotation", "is not a unit quaternion");
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
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

namespace {

glm::mat4 local_matrix(Document& doc, std::size_t index)
{
    const Json& node = node_json(doc, index);
    if (!node.contains("matrix"))
        return trs_matrix(node, place_of(index));
    double numbers[16];
    read_numbers(node, "matrix", numbers);
    glm::mat4 matrix;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            matrix[c][r] = static_cast<float>(numbers[c * 4 + r]);
    constexpr float kTolerance = 1e-5f; // exporters write rounded numbers
    for (int c = 0; c < 4; ++c) {
        const float affine = c == 3 ? 1.0f : 0.0f;
        if (!(std::fabs(matrix[c][3] - affine) <= kTolerance))
            fail(place_of(index) + "/matrix", "the bottom row is not 0 0 0 1");
        matrix[c][3] = affine;
    }
    return matrix;
}

// Reads the area light in a node's extras.burnish.areaLight (see extras.md).
int load_area_light(Document& doc, const Json& node, const std::string& node_place)
{
    const Json::json_pointer at("/extras/burnish/areaLight");
    if (!node.contains(at))
        return kNone;
    const Json& source = node[at];
    const std::string place = node_place + at.to_string();
    // Read the factors and the points
    AreaLight light;
    read_choice(source, "/shape", "quad polygon disk sphere line", light.shape);
    read_flag(source, "/twoSided", light.two_sided);
    read_flag(source, "/solid", light.solid);
#define BN_AREA_FACTOR(kind, name, path, least, most) read_factor(source, path, light.name);
#include "core/scene/area_light.def"
    const std::vector<double> numbers = source["points"].get<std::vector<double>>();
    if (numbers.size() % 3 != 0)
        fail(place + "/points", fmt::format("must be three numbers a point, are {}", numbers.size()));
    for (std::size_t k = 0; k < numbers.size(); k += 3)
        light.points.emplace_back(static_cast<float>(numbers[k]), static_cast<float>(numbers[k + 1]), static_cast<float>(numbers[k + 2]));
    // Read the texture, and check the light
    if (source.contains("texture"))
        light.texture = clamped_texture(doc, get_index(source["texture"], "index"));
    if (const std::string fault = area_light_fault(light); !fault.empty())
        fail(place, fault);
    doc.scene.area_lights.push_back(std::move(light));
    if (doc.scene.area_lights.size() > static_cast<std::size_t>(doc.limits.area_lights))
        fail(place, fmt::format("the scene has more than {} area lights (Limits::area_lights)", doc.limits.area_lights));
    return static_cast<int>(doc.scene.area_lights.size()) - 1;
}

// Returns the part of a node's translation beyond float precision.
glm::dvec3 translation_beyond(const Json& source)
{
    double t[3] = {0.0, 0.0, 0.0}, m[16] = {};
    read_numbers(source, "translation", t);
    if (source.contains("matrix")) {
        read_numbers(source, "matrix", m);
        std::copy(m + 12, m + 15, t);
    }
    glm::dvec3 beyond;
    for (int k = 0; k < 3; ++k)
        beyond[k] = std::isfinite(static_cast<float>(t[k])) ? t[k] - static_cast<double>(static_cast<float>(t[k])) : 0.0;
    return beyond;
}

Node load_node(Document& doc, std::size_t index, int parent)
{
    const Json& source = node_json(doc, index);
    Node node;
    node.name = get_string(source, "name");
    node.parent = parent;
    node.mesh = get_index(source, "mesh");
    node.camera = get_index(source, "camera");
    if (const Json* light = get_extension(source, "KHR_lights_punctual"))
        node.light = get_index(*light, "light");
    node.area_light = load_area_light(doc, source, place_of(index));
    node.local = local_matrix(doc, index);
    node.local_beyond = translation_beyond(source);
    return node;
}

struct Root {
    int node;
    std::string place; // where the file names the node
};

std::vector<Root> find_roots(const Document& doc, const std::vector<int>& parent)
{
    std::vector<Root> roots;
    if (table_size(doc.json, "scenes") == 0) {
        for (std::size_t i = 0; i < parent.size(); ++i)
            if (parent[i] == kNone)
                roots.push_back({static_cast<int>(i), place_of(i)});
        return roots;
    }
    const int scene = std::max(get_index(doc.json, "scene"), 0);
    const std::vector<int> nodes = indices_of(doc.json["scenes"][index_of(scene)], "nodes");
    for (std::size_t k = 0; k < nodes.size(); ++k)
        roots.push_back({nodes[k], fmt::format("/scenes/{}/nodes/{}", scene, k)});
    return roots;
}

// Adds a child node with the mesh for each instance. A skinned mesh has one instance only, because its joints place it.
void add_instances(Document& doc, std::size_t index, int id)
{
    const Json& source = node_json(doc, index);
    const int mesh = get_index(source, "mesh");
    if (mesh == kNone || source.contains("skin"))
        return;
    const std::vector<glm::mat4> instances = instances_of(doc, source, place_of(index));
    if (instances.empty())
        return;
    doc.scene.nodes[index_of(id)].mesh = kNone;
    for (const glm::mat4& matrix : instances) {
        Node node;
        node.parent = id, node.mesh = mesh, node.local = matrix;
        doc.scene.nodes.push_back(std::move(node));
        doc.node_sources.push_back(index);
    }
}

void check_worlds(const Document& doc)
{
    for (std::size_t i = 0; i < doc.scene.nodes.size(); ++i)
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                if (!std::isfinite(doc.scene.nodes[i].world[c][r]))
                    fail(place_of(doc.node_sources[i]), "the transform to world space overflows");
}

} // namespace

void load_cameras_and_lights(Document& doc)
{
    const auto number = [](const Json& object, const char* key, float fallback) {
        return static_cast<float>(get_number(object, key, static_cast<double>(fallback)));
    };
    for (std::size_t i = 0; i < table_size(doc.json, "cameras"); ++i) {
        const Json& source = doc.json["cameras"][i];
        const std::string type = get_string(source, "type");
        const Json& lens = source[type];
        Camera camera;
        camera.name = get_string(source, "name");
        camera.orthographic = type == "orthographic";
        camera.xmag = number(lens, "xmag", camera.xmag), camera.ymag = number(lens, "ymag", camera.ymag);
        camera.yfov = number(lens, "yfov", camera.yfov);
        camera.znear = number(lens, "znear", 0.0f);
        camera.zfar = number(lens, "zfar", 0.0f); // 0 where the file gives none
        doc.scene.cameras.push_back(std::move(camera));
    }
    const Json* lights = get_extension(doc.json, "KHR_lights_punctual");
    for (std::size_t i = 0; lights && i < table_size(*lights, "lights"); ++i) {
        const Json& source = (*lights)["lights"][i];
        const std::string type = get_string(source, "type");
        Light light;
        light.name = get_string(source, "name");
        light.type = type == "directional" ? LightType::directional : type == "spot" ? LightType::spot : LightType::point;
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most) read_factor(source, path, light.name);
#include "core/scene/light.def"
        doc.scene.lights.push_back(std::move(light));
    }
}

void load_nodes(Document& doc)
{
    // Check that the nodes form a forest
    const std::vector<int> parent = find_parents(doc);
    check_forest(doc, parent);
    const std::vector<Root> roots = find_roots(doc, parent);
    std::vector<bool> visited(parent.size(), false);
    struct Pending {
        int node, parent; // glTF node, scene node
    };
    // Walk the default scene's nodes in depth-first order
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
            doc.node_sources.push_back(index);
            add_instances(doc, index, id);
            const std::vector<int> children = indices_of(node_json(doc, index), "children");
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                stack.push_back({*child, id});
        }
    }
    // Name the scene, and compute world matrices
    if (table_size(doc.json, "scenes") > 0)
        doc.scene.name = get_string(doc.json["scenes"][index_of(std::max(get_index(doc.json, "scene"), 0))], "name");
    update_world(doc.scene);
    check_worlds(doc);
}

} // namespace burnish::gltf
