#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <regex>
#include <string_view>

#include "core/scene/gltf/checks.h"

namespace burnish::gltf {

namespace {

// Arrays and objects that must hold something where they are there (minItems, minProperties of the specification's schema).
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
// Arrays of indices and names where nothing may stand twice.
constexpr const char* kUnique[] = {"extensionsUsed", "extensionsRequired", "scenes/*/nodes", "nodes/*/children", "skins/*/joints"};

// Calls visit(value, place) for every value that a path matches; '*' is any element.
template <class F> void for_each(const Json& node, std::string_view path, const std::string& place, const F& visit)
{
    if (path.empty())
        return visit(node, place);
    const std::size_t slash = std::min(path.find('/'), path.size());
    const std::string step(path.substr(0, slash));
    const std::string_view rest = path.substr(std::min(slash + 1, path.size()));
    if (step == "*" && node.is_array())
        for (std::size_t i = 0; i < node.size(); ++i)
            for_each(node[i], rest, place + "/" + std::to_string(i), visit);
    else if (const auto it = node.is_object() ? node.find(step) : node.end(); it != node.end())
        for_each(*it, rest, place + "/" + step, visit);
}

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
    static const std::regex pattern("^[0-9]+\\.[0-9]+$");
    if (!std::regex_match(version, pattern))
        doc.fault("/asset/version", "is not of the form 2.0");
}

// Names of extension objects anywhere in the file.
void collect_extensions(const Json& node, const std::string& place, std::map<std::string, std::string>& found)
{
    if (node.is_array()) {
        for (std::size_t i = 0; i < node.size(); ++i)
            if (node[i].is_structured())
                collect_extensions(node[i], place + "/" + std::to_string(i), found);
        return;
    }
    for (const auto& [key, value] : node.items()) {
        if (key == "extras" || !value.is_structured())
            continue;
        if (key == "extensions" && value.is_object())
            for (const auto& [name, object] : value.items())
                found.try_emplace(name, place + "/extensions/" + name);
        collect_extensions(value, place + "/" + key, found);
    }
}

void check_extensions(Document& doc)
{
    const Json none = Json::array();
    const Json& used = doc.json.contains("extensionsUsed") ? doc.json["extensionsUsed"] : none;
    const Json& required = doc.json.contains("extensionsRequired") ? doc.json["extensionsRequired"] : none;
    const auto is_used = [&](const std::string& name) { return std::find(used.begin(), used.end(), name) != used.end(); };
    for (std::size_t i = 0; i < required.size(); ++i)
        if (!is_used(required[i]))
            doc.fault(fmt::format("/extensionsRequired/{}", i), printable(required[i]) + " is not in extensionsUsed");
    std::map<std::string, std::string> found;
    collect_extensions(doc.json, "", found);
    for (const auto& [name, place] : found)
        if (!is_used(name))
            doc.fault(place, "is not declared in extensionsUsed");
}

double length_of(const Json& numbers)
{
    double sum = 0.0;
    for (const Json& n : numbers)
        sum += n.get<double>() * n.get<double>();
    return std::sqrt(sum);
}

// Whether the upper three columns are at right angles, as products of translation, rotation and scale are.
bool is_decomposable(const Json& matrix)
{
    const auto at = [&](int column, int row) { return matrix[static_cast<std::size_t>(column * 4 + row)].get<double>(); };
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
    constexpr double kUnit = 5e-4; // of the validator too: exporters write rounded numbers
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

bool is_bad_uri(const std::string& uri) // RFC 3986: what must be written as %HH
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
    check_cameras(doc);
    check_images(doc);
    check_buffers(doc);
}

} // namespace burnish::gltf
