#include <cstdio>
#include <string>
#include <vector>

#include "tests/unit/worlds/world.h"

namespace burnish::test {
namespace {

constexpr int kFloat = 5126, kShort = 5123, kInt = 5125; // component types

std::string base64(const std::vector<std::uint8_t>& bytes)
{
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) { return k < bytes.size() ? std::uint32_t{bytes[k]} : 0u; };
        const std::uint32_t three = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

std::string number(float v)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(v));
    return text;
}

std::string list(const float* values, int count)
{
    std::string out = "[";
    for (int k = 0; k < count; ++k)
        out += (k ? "," : "") + number(values[k]);
    return out + "]";
}

void append(std::string& to, const std::string& item)
{
    to += (to.empty() ? "" : ",") + item;
}

// The arrays of a file.
struct File {
    std::vector<std::uint8_t> bytes;
    std::string views, accessors, meshes, nodes, materials, roots;
    int accessor_count = 0;

    int accessor(const void* data, std::size_t size, std::size_t count, int component, const std::string& type,
                 const std::string& more = "")
    {
        append(views, "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes.size()) + ",\"byteLength\":" + std::to_string(size) + "}");
        append(accessors, "{\"bufferView\":" + std::to_string(accessor_count) + ",\"componentType\":" + std::to_string(component) +
                              ",\"count\":" + std::to_string(count) + ",\"type\":\"" + type + "\"" + more + "}");
        const auto* first = static_cast<const std::uint8_t*>(data);
        bytes.insert(bytes.end(), first, first + size);
        bytes.resize((bytes.size() + 3) / 4 * 4);
        return accessor_count++;
    }
};

std::string material_text(const Material& m)
{
    constexpr const char* kModes[] = {"OPAQUE", "MASK", "BLEND"};
    std::string extensions;
    if (m.unlit)
        append(extensions, "\"KHR_materials_unlit\":{}");
    if (m.anisotropy_strength > 0.0f)
        append(extensions, "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":" + number(m.anisotropy_strength) +
                               ",\"anisotropyRotation\":" + number(m.anisotropy_rotation) + "}");
    return "{\"pbrMetallicRoughness\":{\"baseColorFactor\":" + list(&m.base_color[0], 4) + ",\"metallicFactor\":" + number(m.metallic) +
           ",\"roughnessFactor\":" + number(m.roughness) + "},\"alphaMode\":\"" + kModes[static_cast<int>(m.alpha_mode)] +
           "\",\"doubleSided\":" + (m.double_sided ? "true" : "false") + ",\"extensions\":{" + extensions + "}}";
}

// Adds a column's triples, for the primitive's vertices.
int triples(File& file, const Primitive& p, const Column<float>& x, const Column<float>& y, const Column<float>& z, bool bounded)
{
    std::vector<float> values;
    glm::vec3 low(1e30f), high(-1e30f);
    for (std::size_t i = p.first_vertex; i < std::size_t{p.first_vertex} + p.vertex_count; ++i) {
        const glm::vec3 v(x[i], y[i], z[i]);
        values.insert(values.end(), {v.x, v.y, v.z});
        low = glm::min(low, v), high = glm::max(high, v);
    }
    return file.accessor(values.data(), 4 * values.size(), p.vertex_count, kFloat, "VEC3",
                         bounded ? ",\"min\":" + list(&low[0], 3) + ",\"max\":" + list(&high[0], 3) : "");
}

int tangents(File& file, const Primitive& p, const VertexTable& v)
{
    std::vector<float> values;
    for (std::size_t i = p.first_vertex; i < std::size_t{p.first_vertex} + p.vertex_count; ++i)
        values.insert(values.end(), {v.tx[i], v.ty[i], v.tz[i], v.tw[i]});
    return file.accessor(values.data(), 4 * values.size(), p.vertex_count, kFloat, "VEC4");
}

// Adds indices of one of two types, or none: triangles lie in order.
std::string indices(File& file, const Primitive& p, int choice)
{
    if (choice == 0)
        return "";
    std::vector<std::uint16_t> shorts(p.index_count);
    std::vector<std::uint32_t> ints(p.index_count);
    for (std::uint32_t i = 0; i < p.index_count; ++i)
        shorts[i] = static_cast<std::uint16_t>(i), ints[i] = i;
    const int at = choice == 1 && p.index_count < 65535 ? file.accessor(shorts.data(), 2 * shorts.size(), shorts.size(), kShort, "SCALAR")
                                                        : file.accessor(ints.data(), 4 * ints.size(), ints.size(), kInt, "SCALAR");
    return ",\"indices\":" + std::to_string(at);
}

} // namespace

std::string gltf_of(const World& world, Dice& dice)
{
    const Scene& scene = world.scene;
    File file;
    for (const Primitive& p : scene.primitives) {
        const VertexTable& v = scene.vertices;
        std::string attributes = "\"POSITION\":" + std::to_string(triples(file, p, v.px, v.py, v.pz, true));
        if (dice.below(2)) { // without normals a mesh is flat, as all meshes here are
            attributes += ",\"NORMAL\":" + std::to_string(triples(file, p, v.nx, v.ny, v.nz, false));
            if (dice.below(2))
                attributes += ",\"TANGENT\":" + std::to_string(tangents(file, p, v));
        }
        append(file.meshes, "{\"primitives\":[{\"attributes\":{" + attributes + "}" + indices(file, p, dice.below(3)) +
                                ",\"material\":" + std::to_string(p.material) + "}]}");
    }
    for (const Material& m : scene.materials)
        append(file.materials, material_text(m));
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        std::string children;
        for (std::size_t k = 0; k < scene.nodes.size(); ++k)
            if (scene.nodes[k].parent == static_cast<int>(i))
                append(children, std::to_string(k));
        const Node& n = scene.nodes[i];
        append(file.nodes, "{\"mesh\":" + std::to_string(n.mesh) + ",\"matrix\":" + list(&n.local[0][0], 16) +
                               (children.empty() ? "" : ",\"children\":[" + children + "]") + "}");
        if (n.parent == kNone)
            append(file.roots, std::to_string(i));
    }
    return "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_unlit\",\"KHR_materials_anisotropy\"],\"scene\":0,"
           "\"scenes\":[{\"nodes\":[" +
           file.roots + "]}],\"nodes\":[" + file.nodes + "],\"meshes\":[" + file.meshes + "],\"materials\":[" + file.materials +
           "],\"accessors\":[" + file.accessors + "],\"bufferViews\":[" + file.views +
           "],\"buffers\":[{\"byteLength\":" + std::to_string(file.bytes.size()) + ",\"uri\":\"data:application/octet-stream;base64," +
           base64(file.bytes) + "\"}]}";
}

} // namespace burnish::test
