#include "core/scene/gltf/mesh.h"

#include <fmt/format.h>

#include "core/jobs/control.h"
#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/compress.h"
#include "core/scene/gltf/pose.h"
#include "core/scene/gltf/textures.h"
#include "core/scene/gltf/vertices.h"

namespace burnish::gltf {

namespace {

constexpr int kTriangles = 4, kTriangleStrip = 5; // primitive modes (glTF 2.0, 3.7.2.1)

// Bound on corners for a small file: a corner takes some 150 bytes while a primitive is built.
constexpr std::uint64_t kFreeCorners = 1 << 20, kCornersPerByte = 16;
constexpr std::uint64_t kCornerCharge = 32; // bytes: a lasting index, and a share of the temporary arrays

struct Source { // for one primitive
    Document& doc;
    const Json& json;
    std::string place;
    DracoPrimitive draco;
    bool is_draco = false;
};

// `attributes` belongs to the primitive or to one of its morph targets, which Draco does not hold.
AccessorView attribute_view(Source& source, const Json& attributes, const std::string& name, int fewest, int most)
{
    const auto it = attributes.find(name);
    if (it == attributes.end())
        return {};
    const int accessor = it->get<int>();
    const bool target = &attributes != &source.json["attributes"];
    const std::string place = fmt::format("{}/{}/{}", source.place, target ? "targets" : "attributes", name);
    AccessorView view;
    if (const auto decoded = source.draco.attributes.find(name); !target && decoded != source.draco.attributes.end()) {
        const Json& json = source.doc.json["accessors"][static_cast<std::size_t>(accessor)];
        view = AccessorView::make(decoded->second, 0, 0, source.draco.vertex_count,
                                  static_cast<ComponentType>(get_index(json, "componentType")), element_shape(get_string(json, "type")),
                                  json.value("normalized", false))
                   .value_or(AccessorView());
        check_finite(view, place);
    } else {
        view = accessor_view(source.doc, accessor);
        check_finite(source.doc, accessor, view);
    }
    if (view.components() < fewest || view.components() > most)
        fail(place, fmt::format("accessor {} has {} components, {} are needed", accessor, view.components(), fewest));
    return view;
}

Attributes read_attributes(Source& source)
{
    Attributes a;
    a.position = attribute_view(source, source.json["attributes"], "POSITION", 3, 3);
    a.normal = attribute_view(source, source.json["attributes"], "NORMAL", 3, 3);
    a.tangent = attribute_view(source, source.json["attributes"], "TANGENT", 4, 4);
    a.uv[0] = attribute_view(source, source.json["attributes"], "TEXCOORD_0", 2, 2);
    a.uv[1] = attribute_view(source, source.json["attributes"], "TEXCOORD_1", 2, 2);
    a.color = attribute_view(source, source.json["attributes"], "COLOR_0", 3, 4);
    for (const AccessorView* view : {&a.normal, &a.tangent, &a.uv[0], &a.uv[1], &a.color})
        if (*view && view->count() != a.position.count())
            fail(source.place + "/attributes", fmt::format("attributes differ in count, {} and {}", a.position.count(), view->count()));
    if (a.position.count() > UINT32_MAX)
        fail(source.place + "/attributes/POSITION", "has more than 2^32 vertices");
    return a;
}

std::vector<std::uint32_t> read_indices(Source& source, std::uint64_t vertex_count)
{
    const std::string place = source.place + "/indices";
    std::vector<std::uint32_t> indices;
    // Read indices from Draco data or an accessor, or count up without either
    if (source.is_draco) {
        indices = std::move(source.draco.indices);
    } else if (const int accessor = get_index(source.json, "indices"); accessor >= 0) {
        const AccessorView view = accessor_view(source.doc, accessor);
        const ComponentType type = view.type();
        if (view.components() != 1 || (type != ComponentType::u8 && type != ComponentType::u16 && type != ComponentType::u32))
            fail(place, fmt::format("accessor {} is not of unsigned integer scalars", accessor));
        const std::uint64_t most = kFreeCorners + kCornersPerByte * source.doc.input_bytes;
        if (view.count() > most)
            fail(place, fmt::format("{} indices are out of proportion to the file's size", view.count()));
        indices.resize(view.count());
        for (std::uint64_t i = 0; i < view.count(); ++i)
            indices[i] = view.integer(i);
    } else {
        if (vertex_count > kFreeCorners + kCornersPerByte * source.doc.input_bytes)
            fail(source.place, fmt::format("{} vertices are out of proportion to the file's size", vertex_count));
        indices.resize(vertex_count);
        for (std::uint64_t i = 0; i < vertex_count; ++i)
            indices[i] = static_cast<std::uint32_t>(i);
    }
    // Check that every index names a vertex
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= vertex_count)
            fail(place, fmt::format("index {} at {} is not below the vertex count {}", indices[i], i, vertex_count));
    return indices;
}

// Converts strips and fans by glTF 2.0, 3.7.2.1, so that every triangle keeps its winding.
std::vector<std::uint32_t> to_triangles(std::vector<std::uint32_t> v, int mode)
{
    if (mode == kTriangles) {
        v.resize(v.size() / 3 * 3);
        return v;
    }
    std::vector<std::uint32_t> corners;
    corners.reserve(v.size() < 3 ? 0 : (v.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
        if (mode == kTriangleStrip)
            corners.insert(corners.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
        else
            corners.insert(corners.end(), {v[i + 1], v[i + 2], v[0]});
    }
    return corners;
}

int material_of(Document& doc, const Json& json)
{
    if (const int material = get_index(json, "material"); material >= 0)
        return material;
    if (doc.default_material == kNone) {
        doc.default_material = static_cast<int>(doc.scene.materials.size());
        doc.scene.materials.emplace_back();
    }
    return doc.default_material;
}

void finish_corners(Document& doc, Corners& corners, const Material& material, Primitive& primitive, const std::string& mesh)
{
    if (!corners.attributes.normal)
        corners.attributes.tangent = {}; // normals and tangents belong together
    if (make_normals(corners))
        doc.warn(mesh + ": normals without length are replaced by the triangle's");
    const int uv_set = material.normal_tex.used()       ? material.normal_tex.uv_set
                       : material.anisotropy_tex.used() ? material.anisotropy_tex.uv_set
                       : material.tilt_tex.used()       ? material.tilt_tex.uv_set
                                                        : 0;
    const TangentSource tangents = make_tangents(corners, uv_set);
    primitive.has_file_tangents = tangents == TangentSource::file;
    const bool directed =
        material.anisotropy_strength > 0.0f || material.normal_tex.used() || material.tilt != glm::vec2(0.0f) || material.tilt_tex.used();
    if (directed && tangents == TangentSource::texture_coordinates)
        doc.warn(mesh + ": no TANGENT for its normal map, anisotropy or tilt; made from texture coordinates (MikkTSpace)");
    if (directed && tangents == TangentSource::none)
        doc.warn(mesh + ": neither TANGENT nor texture coordinates for its normal map, anisotropy or tilt; the "
                        "direction is arbitrary");
}

void warn_missing_coordinates(Document& doc, const Material& m, const Primitive& primitive, const std::string& mesh)
{
    const bool present[2] = {primitive.has_uv0, primitive.has_uv1};
    for (const MaterialTexture& texture : kMaterialTextures)
        if (const TextureRef& ref = m.*texture.to; ref.used() && !present[ref.uv_set])
            doc.fault(mesh, fmt::format("no TEXCOORD_{} for a texture of its material", ref.uv_set));
}

// Loads a primitive. An empty `by` leaves the mesh as the file has it.
void load_primitive(Document& doc, const Json& json, const SkinMorph& by, const std::string& place, const std::string& mesh)
{
    // Skip points and lines
    const int mode = static_cast<int>(get_uint(json, "mode", kTriangles));
    if (mode < kTriangles) {
        doc.warn(mesh + ": points and lines are not supported and left out");
        return;
    }
    // Decode Draco data, and view the attributes
    Source source{doc, json, place, {}, false};
    if (const Json* draco = get_extension(json, "KHR_draco_mesh_compression")) {
        source.draco = decode_draco(doc, json, *draco, place);
        source.is_draco = true;
    }
    Corners corners;
    corners.attributes = read_attributes(source);
    if (!corners.attributes.position) {
        doc.warn(mesh + ": a primitive without POSITION is left out");
        return;
    }
    // Deform the vertices by joints and morph targets
    std::vector<std::uint32_t> indices = read_indices(source, corners.attributes.position.count());
    DeformedVertices deformed; // storage for the attributes
    if (by.any()) {
        if (corners.attributes.position.all_zero())
            fail(place + "/attributes/POSITION", "has no buffer view, and is bent by joints or morph targets");
        const AttributeOf attribute = [&](const Json& attributes, const std::string& name, int components) {
            return attribute_view(source, attributes, name, components, components);
        };
        deformed = deform(doc, json, by, corners.attributes, attribute, place);
    }
    // Convert strips and fans to triangles
    if (mode == kTriangles && indices.size() % 3 != 0)
        doc.warn(mesh + ": the number of indices is not a multiple of 3; the last are left out");
    // Draco stores triangles whatever the mode is.
    corners.vertices = to_triangles(std::move(indices), source.is_draco ? kTriangles : mode);
    if (corners.vertices.empty())
        return;
    doc.charge(corners.vertices.size() * kCornerCharge, place);

    // Append the primitive with merged vertices
    Primitive primitive;
    primitive.material = material_of(doc, json);
    primitive.has_uv0 = static_cast<bool>(corners.attributes.uv[0]);
    primitive.has_uv1 = static_cast<bool>(corners.attributes.uv[1]);
    primitive.has_color = static_cast<bool>(corners.attributes.color);
    const Material& material = doc.scene.materials[static_cast<std::size_t>(primitive.material)];
    warn_missing_coordinates(doc, material, primitive, mesh);
    finish_corners(doc, corners, material, primitive, mesh);
    append_welded(doc, corners, primitive, place);
    doc.scene.primitives.push_back(primitive);
}

Mesh load_mesh(Document& doc, std::size_t m, const SkinMorph& by)
{
    const Json& json = doc.json["meshes"][m];
    Mesh mesh;
    mesh.name = get_string(json, "name");
    mesh.first_primitive = static_cast<std::uint32_t>(doc.scene.primitives.size());
    const Json& primitives = json["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p)
        load_primitive(doc, primitives[p], by, fmt::format("/meshes/{}/primitives/{}", m, p), quoted(mesh.name, "mesh", m));
    mesh.primitive_count = static_cast<std::uint32_t>(doc.scene.primitives.size()) - mesh.first_primitive;
    return mesh;
}

// Makes a separate mesh for each node that skins or morphs one. A skinned mesh lies in world space, whatever its node.
void load_deformed_meshes(Document& doc, const std::vector<SkinMorph>& skin_morphs)
{
    for (std::size_t i = 0; i < skin_morphs.size(); ++i) {
        if (!skin_morphs[i].any())
            continue;
        const int mesh = static_cast<int>(doc.scene.meshes.size());
        doc.scene.meshes.push_back(load_mesh(doc, static_cast<std::size_t>(doc.scene.nodes[i].mesh), skin_morphs[i]));
        doc.scene.nodes[i].mesh = skin_morphs[i].joints.empty() ? mesh : kNone;
        if (skin_morphs[i].joints.empty())
            continue;
        Node node;
        node.name = doc.scene.nodes[i].name, node.mesh = mesh;
        node.local[3] = glm::vec4(glm::vec3(skin_morphs[i].away), 1.0f);
        doc.scene.nodes.push_back(std::move(node));
    }
}

} // namespace

void load_meshes(Document& doc)
{
    std::vector<SkinMorph> skin_morphs(doc.scene.nodes.size());
    std::vector<bool> plain(table_size(doc.json, "meshes"), true); // drawn as in the file, or not at all
    for (std::size_t i = 0; i < skin_morphs.size(); ++i)
        if (doc.scene.nodes[i].mesh != kNone) {
            skin_morphs[i] = skin_morph_of(doc, i);
            if (skin_morphs[i].any())
                plain[static_cast<std::size_t>(doc.scene.nodes[i].mesh)] = false;
        }
    for (std::size_t i = 0; i < skin_morphs.size(); ++i)
        if (doc.scene.nodes[i].mesh != kNone && !skin_morphs[i].any())
            plain[static_cast<std::size_t>(doc.scene.nodes[i].mesh)] = true;
    for (std::size_t m = 0; m < plain.size(); ++m) {
        check_stop();
        doc.scene.meshes.push_back(plain[m] ? load_mesh(doc, m, {}) : Mesh{});
    }
    load_deformed_meshes(doc, skin_morphs);
    update_world(doc.scene);
    if (doc.scene.materials.empty())
        doc.scene.materials.emplace_back();
}

} // namespace burnish::gltf
