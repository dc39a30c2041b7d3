#include <fmt/format.h>

#include "core/scene/gltf/checks.h"

namespace burnish::gltf {

namespace {

const Json& accessor_of(const Document& doc, const Json& object, const char* key)
{
    return doc.json["accessors"][object[key].get<std::size_t>()];
}

void check_animation(Document& doc, const Json& animation, const std::string& place)
{
    const Json &samplers = animation["samplers"], &channels = animation["channels"];
    // Check samplers: key times, and one output for each key
    for (std::size_t i = 0; i < samplers.size(); ++i) {
        const std::string here = fmt::format("{}/samplers/{}", place, i);
        const Json &input = accessor_of(doc, samplers[i], "input"), &output = accessor_of(doc, samplers[i], "output");
        if (get_string(input, "type") != "SCALAR" || get_index(input, "componentType") != 5126)
            doc.fault(here + "/input", "is not of float scalars");
        if (!input.contains("min") || !input.contains("max"))
            doc.fault(here + "/input", "has no min and max");
        const bool cubic = samplers[i].value("interpolation", "LINEAR") == "CUBICSPLINE";
        if (cubic && get_uint(input, "count", 0) < 2)
            doc.fault(here + "/input", "has fewer than the two keys of a cubic spline");
        if (get_uint(output, "count", 0) % (get_uint(input, "count", 1) * (cubic ? 3 : 1)) != 0)
            doc.fault(here + "/output", "has a count that does not fit the input's");
    }
    // Check channels: each target has one channel and can move
    std::set<std::pair<int, std::string>> targets;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const Json& target = channels[i]["target"];
        const std::string here = fmt::format("{}/channels/{}", place, i), path = get_string(target, "path");
        const int node = get_index(target, "node");
        const std::uint64_t sampler = get_uint(channels[i], "sampler", 0);
        if (sampler >= samplers.size())
            doc.fault(here + "/sampler", "is no sampler of this animation");
        if (node < 0)
            continue;
        if (!targets.insert({node, path}).second)
            doc.fault(here + "/target", "is the target of another channel too");
        const Json& json = doc.json["nodes"][static_cast<std::size_t>(node)];
        if (path != "weights" && json.contains("matrix"))
            doc.fault(here + "/target/path", "cannot move a node that has a matrix");
        if (path == "weights" && !json.contains("mesh"))
            doc.fault(here + "/target/path", "needs a node with a mesh of morph targets");
        if (sampler >= samplers.size())
            continue;
        // Check that the output's type fits the target
        const Json& output = accessor_of(doc, samplers[sampler], "output");
        const std::string type = get_string(output, "type");
        const char* wanted = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
        if (type != wanted)
            doc.fault(here + "/sampler", fmt::format("gives {} where {} needs {}", type, printable(path), wanted));
        const int component = get_index(output, "componentType");
        const bool integers = wanted[0] != 'V' || wanted[3] == '4'; // rotations and weights may be normalized integers
        if (component != 5126 && !(integers && component != 5125 && output.value("normalized", false)))
            doc.fault(here + "/sampler", fmt::format("gives components of the type {}, which {} cannot have", component, printable(path)));
    }
}

void check_skin(Document& doc, const Json& skin, const std::string& place)
{
    if (!skin.contains("inverseBindMatrices"))
        return;
    const Json& matrices = accessor_of(doc, skin, "inverseBindMatrices");
    if (get_string(matrices, "type") != "MAT4" || get_index(matrices, "componentType") != 5126)
        doc.fault(place + "/inverseBindMatrices", "is not of float MAT4");
    if (get_uint(matrices, "count", 0) < skin["joints"].size())
        doc.fault(place + "/inverseBindMatrices", "has fewer matrices than the skin has joints");
}

std::size_t targets_of(const Json& primitive)
{
    return primitive.contains("targets") ? primitive["targets"].size() : 0;
}

void check_morphs(Document& doc, const Json& mesh, const std::string& place)
{
    const Json& primitives = mesh["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        const std::string here = fmt::format("{}/primitives/{}/targets", place, p);
        if (targets_of(primitives[p]) != targets_of(primitives[0]))
            doc.fault(here, "are not as many as the first primitive's");
        for (std::size_t t = 0; t < targets_of(primitives[p]); ++t)
            for (const auto& [name, index] : primitives[p]["targets"][t].items()) {
                const int base = get_index(primitives[p]["attributes"], name.c_str());
                if (base < 0)
                    doc.fault(fmt::format("{}/{}/{}", here, t, printable(name)), "is no attribute of the primitive");
                else if (doc.json["accessors"][index.get<std::size_t>()]["count"] !=
                         doc.json["accessors"][static_cast<std::size_t>(base)]["count"])
                    doc.fault(fmt::format("{}/{}/{}", here, t, printable(name)), "has another count than the attribute");
            }
    }
    if (mesh.contains("weights") && !primitives.empty() && mesh["weights"].size() != targets_of(primitives[0]))
        doc.fault(place + "/weights", "are not as many as the morph targets");
}

} // namespace

void check_moving(Document& doc)
{
    for (std::size_t i = 0; i < table_size(doc.json, "animations"); ++i)
        check_animation(doc, doc.json["animations"][i], fmt::format("/animations/{}", i));
    for (std::size_t i = 0; i < table_size(doc.json, "skins"); ++i)
        check_skin(doc, doc.json["skins"][i], fmt::format("/skins/{}", i));
    for (std::size_t i = 0; i < table_size(doc.json, "meshes"); ++i)
        check_morphs(doc, doc.json["meshes"][i], fmt::format("/meshes/{}", i));
    for (std::size_t i = 0; i < table_size(doc.json, "nodes"); ++i) {
        const Json& node = doc.json["nodes"][i];
        const Json* mesh = node.contains("mesh") ? &doc.json["meshes"][node["mesh"].get<std::size_t>()] : nullptr;
        const Json* primitive = mesh && !(*mesh)["primitives"].empty() ? &(*mesh)["primitives"][0] : nullptr;
        if (node.contains("skin") && !(primitive && (*primitive)["attributes"].contains("JOINTS_0")))
            doc.fault(fmt::format("/nodes/{}/skin", i), "needs a mesh with joints");
        if (node.contains("weights") && node["weights"].size() != (primitive ? targets_of(*primitive) : 0))
            doc.fault(fmt::format("/nodes/{}/weights", i), "are not as many as the mesh's morph targets");
    }
}

} // namespace burnish::gltf
