#include "apps/lab/conform/scene_file.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "apps/report/html.h"
#include "core/base/text.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

constexpr int kFloats = 5126, kIndices = 5125; // component types of glTF
constexpr glm::vec3 kLampFrom{0.55f, 0.65f, 0.75f};
constexpr float kLampLux = 6.0f;

Json numbers(const float* values, int count)
{
    Json out = Json::array();
    for (int i = 0; i < count; ++i)
        out.push_back(shortest_decimal(values[i]));
    return out;
}

// Collects accessors, each with a view of the one buffer.
struct Buffer {
    std::string bytes;
    Json views = Json::array(), accessors = Json::array();

    int add(const void* data, std::size_t size, int component, const char* type, std::size_t count)
    {
        views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
        bytes.append(static_cast<const char*>(data), size);
        accessors.push_back({{"bufferView", views.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
        return static_cast<int>(accessors.size()) - 1;
    }
    template <class T, class Take> int column(const std::vector<FileVertex>& vertices, const char* type, const Take& take)
    {
        std::vector<T> values;
        values.reserve(vertices.size());
        for (const FileVertex& v : vertices)
            values.push_back(take(v));
        return add(values.data(), values.size() * sizeof(T), kFloats, type, values.size());
    }
};

Json node_of(const glm::mat4& matrix)
{
    Json node = Json::object();
    if (matrix != glm::mat4(1.0f))
        node["matrix"] = numbers(&matrix[0][0], 16);
    return node;
}

// Returns a node's matrix that looks along -Z from `eye` to `target`.
glm::mat4 looking(const glm::vec3& eye, const glm::vec3& target)
{
    const glm::vec3 forward = glm::normalize(target - eye);
    const glm::vec3 up = std::abs(forward.y) > 0.99f ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    return glm::inverse(glm::lookAt(eye, target, up));
}

std::string data_of(const char* type, const std::string& bytes)
{
    return std::string("data:") + type + ";base64," + base64(bytes);
}

// Adds the mesh's columns. Returns the primitive that refers to them.
Json add_primitive(const SceneFile& scene, Buffer& buffer)
{
    Json attributes = Json::object();
    attributes["POSITION"] = buffer.column<glm::vec3>(scene.vertices, "VEC3", [](const FileVertex& v) { return v.position; });
    glm::vec3 least = scene.vertices.front().position, most = least;
    for (const FileVertex& v : scene.vertices)
        least = glm::min(least, v.position), most = glm::max(most, v.position);
    buffer.accessors.back()["min"] = numbers(&least[0], 3);
    buffer.accessors.back()["max"] = numbers(&most[0], 3);
    attributes["NORMAL"] = buffer.column<glm::vec3>(scene.vertices, "VEC3", [](const FileVertex& v) { return v.normal; });
    if (scene.tangents)
        attributes["TANGENT"] = buffer.column<glm::vec4>(scene.vertices, "VEC4", [](const FileVertex& v) { return v.tangent; });
    attributes["TEXCOORD_0"] = buffer.column<glm::vec2>(scene.vertices, "VEC2", [](const FileVertex& v) { return v.uv0; });
    attributes["TEXCOORD_1"] = buffer.column<glm::vec2>(scene.vertices, "VEC2", [](const FileVertex& v) { return v.uv1; });
    const int indices = buffer.add(scene.triangles.data(), scene.triangles.size() * 4, kIndices, "SCALAR", scene.triangles.size());
    Json primitive = Json::object();
    primitive["attributes"] = std::move(attributes), primitive["indices"] = indices, primitive["material"] = 0;
    return primitive;
}

// Adds the scene and its nodes: the mesh's chain, the camera, the lamp.
void add_scene(const std::string& name, const SceneFile& scene, std::vector<std::string>& extensions, Json& file)
{
    Json nodes = Json::array(), roots = Json::array();
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        nodes.push_back(node_of(scene.nodes[i]));
        if (i == 0)
            nodes.back()["mesh"] = 0;
        else
            nodes.back()["children"] = Json::array({i - 1});
    }
    roots.push_back(nodes.size() - 1);
    nodes.push_back(node_of(looking(scene.eye, scene.target)));
    nodes.back()["camera"] = 0;
    roots.push_back(nodes.size() - 1);
    if (scene.lamp) {
        nodes.push_back(node_of(looking(kLampFrom, glm::vec3(0.0f))));
        nodes.back()["extensions"]["KHR_lights_punctual"]["light"] = 0;
        roots.push_back(nodes.size() - 1);
        extensions.push_back("KHR_lights_punctual");
        file["extensions"]["KHR_lights_punctual"]["lights"] =
            Json::array({{{"type", "directional"}, {"color", {1.0, 0.9, 0.8}}, {"intensity", shortest_decimal(kLampLux)}}});
    }
    file["scenes"] = Json::array({{{"name", name}, {"nodes", roots}}});
    file["nodes"] = std::move(nodes);
}

// Adds the material and its textures.
Status add_textured_material(const SceneFile& scene, std::vector<std::string>& extensions, Json& file)
{
    file["materials"] = Json::array({scene.material});
    if (scene.material.contains("extensions"))
        for (const auto& [extension, unused] : scene.material["extensions"].items())
            extensions.push_back(extension);
    if (scene.material.dump().find("KHR_texture_transform") != std::string::npos)
        extensions.push_back("KHR_texture_transform");
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const Result<std::string> png = encode_png(scene.textures[i]);
        BN_TRY(png);
        file["textures"].push_back({{"source", i}, {"sampler", 0}});
        file["images"].push_back({{"uri", data_of("image/png", *png)}});
    }
    if (!scene.textures.empty())
        file["samplers"] = Json::array({{{"magFilter", 9729}, {"minFilter", 9987}}}); // linear, and between mip levels
    return {};
}

} // namespace

Result<std::string> scene_file_text(const std::string& name, const SceneFile& scene)
{
    Buffer buffer;
    const Json primitive = add_primitive(scene, buffer);
    std::vector<std::string> extensions;
    Json file = {{"asset", {{"version", "2.0"}, {"generator", "burnish"}}}, {"scene", 0}};
    add_scene(name, scene, extensions, file);
    file["cameras"] = Json::array({{{"type", "perspective"},
                                    {"perspective",
                                     {{"yfov", shortest_decimal(scene.fov_y_rad)},
                                      {"aspectRatio", shortest_decimal(scene.aspect)},
                                      {"znear", 0.1},
                                      {"zfar", 100.0}}}}});
    file["meshes"] = Json::array({{{"primitives", Json::array({primitive})}}});
    BN_TRY(add_textured_material(scene, extensions, file));
    if (!extensions.empty())
        file["extensionsUsed"] = extensions;
    file["accessors"] = std::move(buffer.accessors);
    file["bufferViews"] = std::move(buffer.views);
    file["buffers"] = Json::array({{{"byteLength", buffer.bytes.size()}, {"uri", data_of("application/octet-stream", buffer.bytes)}}});
    return json_text(file, -1) + "\n";
}

} // namespace burnish
