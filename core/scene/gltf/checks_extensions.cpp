// Checks extensions: declarations, allowed places, and contents of ignored ones.
#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "core/scene/gltf/checks.h"
#include "core/scene/gltf/extensions.h"

namespace burnish::gltf {

namespace {

// Collects the names of all extension objects in the file.
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

// Allowed places of an extension's objects, as paths with * for variable parts. A texture extension may stand wherever
// a texture reference does.
struct Home {
    std::string_view extension; // name or prefix
    const char* parents;        // separated by blanks; "/" is the file itself
};
constexpr Home kHomes[] = {
    {"KHR_lights_punctual", "/ /nodes/*"},
    {"KHR_texture_transform", "TEXTURE"},
    {"KHR_draco_mesh_compression", "/meshes/*/primitives/*"},
    {"KHR_mesh_quantization", ""},
    {"KHR_materials_variants", "/ /meshes/*/primitives/*"},
    {"KHR_materials_", "/materials/*"},
    {"KHR_texture_basisu", "/textures/*"},
    {"EXT_texture_webp", "/textures/*"},
    {"EXT_meshopt_compression", "/bufferViews/* /buffers/*"},
    {"EXT_lights_image_based", "/ /scenes/*"},
    {"EXT_mesh_gpu_instancing", "/nodes/*"},
};

bool is_home(const char* parents, const std::string& parent)
{
    const std::string list = fmt::format(" {} ", parents);
    return list.find(" " + (parent.empty() ? "/" : parent) + " ") != std::string::npos ||
           (list == " TEXTURE " && parent.ends_with("Texture"));
}

// `pattern` is the place with * for its numbers.
void check_homes(Document& doc, const Json& node, const std::string& place, const std::string& pattern)
{
    if (node.is_array())
        for (std::size_t i = 0; i < node.size(); ++i)
            check_homes(doc, node[i], place + "/" + std::to_string(i), pattern + "/*");
    if (!node.is_object())
        return;
    for (const auto& [key, value] : node.items()) {
        if (key == "extensions" && !value.is_object())
            doc.fault(place + "/extensions", "is no object; ignored");
        else if (key == "extensions")
            for (const auto& [name, object] : value.items()) {
                const std::string here = place + "/extensions/" + printable(name);
                for (const Home& home : kHomes)
                    if (name.starts_with(home.extension)) {
                        if (!is_home(home.parents, pattern))
                            doc.fault(here, "does not belong here; ignored");
                        break;
                    }
                if (!object.is_object())
                    doc.fault(here, "is no object; ignored");
            }
        if (key != "extras" && value.is_structured())
            check_homes(doc, value, place + "/" + printable(key), pattern + "/" + key);
    }
}

// Ranges of numbers in extensions that may be ignored. Lines of those that are read do nothing: schema.cpp has their rules.
struct Ignored {
    const char* path; // below materials/*/extensions
    double low, high;
};
constexpr Ignored kIgnored[] = {
    {"KHR_materials_diffuse_transmission/diffuseTransmissionFactor", 0.0, 1.0},
};

void check_ignored(Document& doc)
{
    for (const Ignored& field : kIgnored) {
        const std::string path = field.path;
        if (is_read(path.substr(0, path.find('/'))))
            continue;
        for_each(doc.json, fmt::format("materials/*/extensions/{}", field.path), "", [&](const Json& value, const std::string& place) {
            if (!value.is_number() || value.get<double>() < field.low || value.get<double>() > field.high)
                doc.fault(place, fmt::format("is no number from {:g} to {:g}; ignored", field.low, field.high));
        });
    }
}

} // namespace

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
    check_homes(doc, doc.json, "", "");
    check_ignored(doc);
}

} // namespace burnish::gltf
