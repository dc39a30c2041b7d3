#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "core/scene/gltf/checks.h"
#include "core/scene/gltf/textures.h"

namespace burnish::gltf {

namespace {

// Arrays and objects that must not be empty (minItems, minProperties in the specification's schema).
constexpr const char* kNeverEmpty[] = {
    "extensionsUsed",
    "extensionsRequired",
    "accessors",
    "animations",
    "buffers",
    "bufferViews",
    "cameras",
    "images",
    "materials",
    "meshes",
    "nodes",
    "samplers",
    "scenes",
    "skins",
    "textures",
    "scenes/*/nodes",
    "nodes/*/children",
    "nodes/*/weights",
    "meshes/*/primitives",
    "meshes/*/weights",
    "meshes/*/primitives/*/attributes",
    "meshes/*/primitives/*/targets",
    "meshes/*/primitives/*/targets/*",
    "animations/*/channels",
    "animations/*/samplers",
    "skins/*/joints",
    "extensions/KHR_lights_punctual/lights",
};
// Arrays of indices and names without duplicates.
constexpr const char* kUnique[] = {"extensionsUsed", "extensionsRequired", "scenes/*/nodes", "nodes/*/children", "skins/*/joints"};

void check_empty_and_double(Document& doc)
{
    for (const char* path : kNeverEmpty)
        for_each(doc.json, path, "", [&](const Json& value, const std::string& place) {
            if (value.empty())
                doc.fault(place, "must not be empty");
        });
    for (const char* path : kUnique)
        for_each(doc.json, path, "", [&](const Json& value, const std::string& place) {
            std::set<Json> seen;
            for (std::size_t i = 0; i < value.size(); ++i)
                if (!seen.insert(value[i]).second)
                    doc.fault(fmt::format("{}/{}", place, i), "stands here twice");
        });
}

void check_asset(Document& doc)
{
    const std::string version = doc.json["asset"]["version"];
    const std::size_t dot = version.find('.');
    const auto number = [&](std::size_t from, std::size_t to) { return from < to && version.find_first_not_of("0123456789", from) >= to; };
    if (dot == std::string::npos || !number(0, dot) || !number(dot + 1, version.size()))
        doc.fault("/asset/version", "is not of the form 2.0");
}

double length_of(const Json& numbers)
{
    double sum = 0.0;
    for (const Json& n : numbers)
        sum += n.get<double>() * n.get<double>();
    return std::sqrt(sum);
}

// Returns true where the upper three columns are orthogonal, as in products of translation, rotation and scale.
bool is_decomposable(const Json& matrix)
{
    const auto at = [&](int column, int row) { return matrix[static_cast<std::size_t>(column * 4 + row)].get<double>(); };
    for (int a = 0; a < 3; ++a)
        if (at(a, 0) == 0.0 && at(a, 1) == 0.0 && at(a, 2) == 0.0)
            return false; // flattens every object
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < a; ++b) {
            double dot = 0.0, aa = 0.0, bb = 0.0;
            for (int r = 0; r < 3; ++r)
                dot += at(a, r) * at(b, r), aa += at(a, r) * at(a, r), bb += at(b, r) * at(b, r);
            if (std::abs(dot) > 1e-3 * std::sqrt(aa * bb))
                return false;
        }
    return true;
}

void check_nodes(Document& doc)
{
    constexpr double kUnit = 5e-4; // the validator's tolerance: exporters write rounded numbers
    std::vector<bool> is_child(table_size(doc.json, "nodes"), false);
    for (std::size_t i = 0; i < table_size(doc.json, "nodes"); ++i) {
        const Json& node = doc.json["nodes"][i];
        const std::string place = fmt::format("/nodes/{}", i);
        if (node.contains("rotation") && !(std::abs(length_of(node["rotation"]) - 1.0) <= kUnit))
            doc.fault(place + "/rotation", "is no unit quaternion; normalized");
        if (node.contains("matrix") && (node.contains("translation") || node.contains("rotation") || node.contains("scale")))
            doc.fault(place + "/matrix", "stands beside translation, rotation or scale; the matrix is used");
        if (node.contains("matrix") && !is_decomposable(node["matrix"]))
            doc.fault(place + "/matrix", "is no product of translation, rotation and scale; used as it is");
        for (const Json& child : node.value("children", Json::array()))
            is_child[child.get<std::size_t>()] = true;
    }
    for (std::size_t s = 0; s < table_size(doc.json, "scenes"); ++s) {
        const Json nodes = doc.json["scenes"][s].value("nodes", Json::array());
        for (std::size_t k = 0; k < nodes.size(); ++k)
            if (is_child[nodes[k].get<std::size_t>()])
                doc.fault(fmt::format("/scenes/{}/nodes/{}", s, k), "is no root node");
    }
}

// Checks that a skin's skeleton is an ancestor of all its joints. Joints need a common root and must be in the node's
// scene.
void check_skins(Document& doc)
{
    // Find every node's parent
    std::vector<int> parents(table_size(doc.json, "nodes"), -1);
    for (std::size_t i = 0; i < parents.size(); ++i)
        for (const Json& child : doc.json["nodes"][i].value("children", Json::array()))
            parents[child.get<std::size_t>()] = static_cast<int>(i);
    const auto line_of = [&](int node) { // the node and its ancestors; loops are refused later
        std::vector<int> line;
        for (; node >= 0 && line.size() <= parents.size(); node = parents[static_cast<std::size_t>(node)])
            line.push_back(node);
        return line;
    };
    const auto root_of = [&](int node) { return line_of(node).back(); };
    // Check that each skin's joints lie below its skeleton and one root
    for (std::size_t s = 0; s < table_size(doc.json, "skins"); ++s) {
        const Json& skin = doc.json["skins"][s];
        const int skeleton = get_index(skin, "skeleton");
        for (const Json& joint : skin["joints"]) {
            const std::vector<int> line = line_of(joint.get<int>());
            if (skeleton >= 0 && std::find(line.begin(), line.end(), skeleton) == line.end()) {
                doc.fault(fmt::format("/skins/{}/skeleton", s), "is not above all joints of the skin");
                break;
            }
            if (line.back() != root_of(skin["joints"][0].get<int>())) {
                doc.fault(fmt::format("/skins/{}/joints", s), "have no common root");
                break;
            }
        }
    }
    // Check that each skinned node's joints are in its scene
    for (std::size_t s = 0; s < table_size(doc.json, "scenes"); ++s) {
        std::set<int> roots;
        for (const Json& node : doc.json["scenes"][s].value("nodes", Json::array()))
            roots.insert(node.get<int>());
        for (std::size_t i = 0; i < parents.size(); ++i) {
            const int skin = get_index(doc.json["nodes"][i], "skin");
            if (skin < 0 || !roots.count(root_of(static_cast<int>(i))))
                continue;
            for (const Json& joint : doc.json["skins"][static_cast<std::size_t>(skin)]["joints"])
                if (!roots.count(root_of(joint.get<int>()))) {
                    doc.fault(fmt::format("/nodes/{}/skin", i), fmt::format("has joints that are not in scene {}", s));
                    break;
                }
        }
    }
}

void check_lights(Document& doc)
{
    for_each(doc.json, "extensions/KHR_lights_punctual/lights/*/color", "", [&](const Json& colour, const std::string& place) {
        for (std::size_t c = 0; c < colour.size(); ++c)
            if (colour[c].get<double>() > 1.0)
                doc.fault(fmt::format("{}/{}", place, c), "is above 1; used as it is");
    });
}

// Checks that textures have their coordinates. Sets named by KHR_texture_transform are checked where they are used.
void check_coordinates(Document& doc)
{
    for (std::size_t m = 0; m < table_size(doc.json, "meshes"); ++m) {
        const Json& primitives = doc.json["meshes"][m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const int material = get_index(primitives[p], "material");
            if (material < 0)
                continue;
            std::uint64_t most = 0;
            const Json& json = doc.json["materials"][static_cast<std::size_t>(material)];
            for (const MaterialTexture& read : kMaterialTextures)
                if (const Json::json_pointer at(read.path); json.contains(at)) {
                    const Json& texture = json[at];
                    most = std::max(most, get_uint(texture, "texCoord", 0));
                    if (const Json* transform = get_extension(texture, "KHR_texture_transform"); transform && transform->is_object())
                        most = std::max(most, get_uint(*transform, "texCoord", 0));
                }
            if (most > 0 && !primitives[p]["attributes"].contains(fmt::format("TEXCOORD_{}", most)))
                doc.fault(fmt::format("/meshes/{}/primitives/{}/material", m, p),
                          fmt::format("needs TEXCOORD_{}, which the primitive has not", most));
        }
    }
}

void check_cameras(Document& doc)
{
    for (std::size_t i = 0; i < table_size(doc.json, "cameras"); ++i) {
        const Json& camera = doc.json["cameras"][i];
        if (camera.contains("perspective") && camera.contains("orthographic"))
            doc.fault(fmt::format("/cameras/{}", i), "is perspective and orthographic; its type " + printable(camera["type"]) + " is used");
    }
}

std::string data_uri_type(const std::string& uri)
{
    return uri.compare(0, 5, "data:") == 0 ? uri.substr(5, std::min(uri.find(';'), uri.find(',')) - 5) : "";
}

void check_images(Document& doc)
{
    for (std::size_t i = 0; i < table_size(doc.json, "images"); ++i) {
        const Json& image = doc.json["images"][i];
        const std::string place = fmt::format("/images/{}", i);
        if (image.contains("uri") && image.contains("bufferView"))
            doc.fault(place, "has a uri beside its bufferView; the bufferView is used");
        if (image.contains("bufferView") && !image.contains("mimeType"))
            doc.fault(place + "/mimeType", "is missing beside a bufferView");
    }
}

bool is_bad_uri(const std::string& uri) // RFC 3986: these characters need %HH
{
    return uri.find_first_of(" \"<>\\^`{|}") != std::string::npos;
}

void check_buffers(Document& doc)
{
    for (std::size_t i = 0; i < table_size(doc.json, "buffers"); ++i) {
        const Json& buffer = doc.json["buffers"][i];
        const std::string place = fmt::format("/buffers/{}", i);
        const bool placeholder = get_extension(buffer, "EXT_meshopt_compression") != nullptr;
        if (!buffer.contains("uri") && doc.is_glb && i == 0 && !doc.has_bin && !placeholder)
            doc.fault(place, "has no uri, and the GLB no BIN chunk");
        if (!buffer.contains("uri") && doc.is_glb && i > 0 && !placeholder)
            doc.fault(place, "has no uri, and only the first buffer can be the BIN chunk");
        if (!buffer.contains("uri"))
            continue;
        const std::string uri = buffer["uri"], type = data_uri_type(uri);
        if (!type.empty() && type != "application/octet-stream" && type != "application/gltf-buffer")
            doc.fault(place + "/uri", "is a data URI of the type " + printable(type) + ", which is no buffer's");
    }
    for (const char* table : {"buffers", "images"})
        for (std::size_t i = 0; i < table_size(doc.json, table); ++i)
            if (const Json& object = doc.json[table][i]; object.contains("uri") && is_bad_uri(object["uri"]))
                doc.fault(fmt::format("/{}/{}/uri", table, i), "holds characters that a URI must write as %HH");
}

} // namespace

void check_structure(Document& doc)
{
    check_asset(doc);
    check_empty_and_double(doc);
    check_extensions(doc);
    check_nodes(doc);
    check_skins(doc);
    check_lights(doc);
    check_coordinates(doc);
    check_cameras(doc);
    check_images(doc);
    check_buffers(doc);
}

} // namespace burnish::gltf
