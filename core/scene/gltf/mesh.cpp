#include "core/scene/gltf/mesh.h"

#include <fmt/format.h>

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/compress.h"
#include "core/scene/gltf/textures.h"
#include "core/scene/gltf/vertices.h"

namespace burnish::gltf {

namespace {

constexpr int kTriangles = 4, kTriangleStrip = 5; // of primitive modes (glTF 2.0, 3.7.2.1)

// Corner arrays take some 150 bytes a corner while a primitive is built: a small file must not ask for too
// many.
constexpr std::uint64_t kFreeCorners = 1 << 20, kCornersPerByte = 16;
constexpr std::uint64_t kCornerCharge = 32; // bytes: an index that stays, and a share of what does not

struct Source { // of one primitive
    Document& doc;
    const Json& json;
    std::string place;
    DracoPrimitive draco;
    bool is_draco = false;
};

AccessorView attribute_view(Source& source, const char* name, int fewest, int most)
{
    const Json& attributes = source.json["attributes"];
    const auto it = attributes.find(name);
    if (it == attributes.end())
        return {};
    const int accessor = it->get<int>();
    const std::string place = source.place + "/attributes/" + name;
    AccessorView view;
    if (const auto decoded = source.draco.attributes.find(name); decoded != source.draco.attributes.end()) {
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
    a.position = attribute_view(source, "POSITION", 3, 3);
    a.normal = attribute_view(source, "NORMAL", 3, 3);
    a.tangent = attribute_view(source, "TANGENT", 4, 4);
    a.uv[0] = attribute_view(source, "TEXCOORD_0", 2, 2);
    a.uv[1] = attribute_view(source, "TEXCOORD_1", 2, 2);
    a.color = attribute_view(source, "COLOR_0", 3, 4);
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
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= vertex_count)
            fail(place, fmt::format("index {} at {} is not below the vertex count {}", indices[i], i, vertex_count));
    return indices;
}

// Strips and fans as in glTF 2.0, 3.7.2.1, so that every triangle keeps its winding.
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
        corners.attributes.tangent = {}; // they belong together
    if (make_normals(corners))
        doc.warn(mesh + ": normals without length are replaced by the triangle's");
    const int uv_set = material.normal_tex.used()       ? material.normal_tex.uv_set
                       : material.anisotropy_tex.used() ? material.anisotropy_tex.uv_set
                                                        : 0;
    const TangentSource tangents = make_tangents(corners, uv_set);
    primitive.has_file_tangents = tangents == TangentSource::file;
    const bool directed = material.anisotropy_strength > 0.0f || material.normal_tex.used();
    if (directed && tangents == TangentSource::texture_coordinates)
        doc.warn(mesh + ": no TANGENT for its normal map or anisotropy; made from texture coordinates (MikkTSpace)");
    if (directed && tangents == TangentSource::none)
        doc.warn(mesh + ": neither TANGENT nor texture coordinates for its normal map or anisotropy; the "
                        "direction is arbitrary");
}

void warn_missing_coordinates(Document& doc, const Material& m, const Primitive& primitive, const std::string& mesh)
{
    const bool present[2] = {primitive.has_uv0, primitive.has_uv1};
    for (const MaterialTexture& texture : kMaterialTextures)
        if (const TextureRef& ref = m.*texture.to; ref.used() && !present[ref.uv_set])
            doc.fault(mesh, fmt::format("no TEXCOORD_{} for a texture of its material", ref.uv_set));
}

void load_primitive(Document& doc, const Json& json, const std::string& place, const std::string& mesh)
{
    const int mode = static_cast<int>(get_uint(json, "mode", kTriangles));
    if (mode < kTriangles) {
        doc.warn(mesh + ": points and lines are not supported and left out");
        return;
    }
    if (json.contains("targets") && !json["targets"].empty())
        doc.warn("morph targets are not supported; meshes are drawn without them");
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
    std::vector<std::uint32_t> indices = read_indices(source, corners.attributes.position.count());
    if (mode == kTriangles && indices.size() % 3 != 0)
        doc.warn(mesh + ": the number of indices is not a multiple of 3; the last are left out");
    // Draco stores triangles whatever the mode says.
    corners.vertices = to_triangles(std::move(indices), source.is_draco ? kTriangles : mode);
    if (corners.vertices.empty())
        return;
    doc.charge(corners.vertices.size() * kCornerCharge, place);

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

} // namespace

void load_meshes(Document& doc)
{
    for (std::size_t m = 0; m < table_size(doc.json, "meshes"); ++m) {
        const Json& json = doc.json["meshes"][m];
        Mesh mesh;
        mesh.name = get_string(json, "name");
        mesh.first_primitive = static_cast<std::uint32_t>(doc.scene.primitives.size());
        const Json& primitives = json["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p)
            load_primitive(doc, primitives[p], fmt::format("/meshes/{}/primitives/{}", m, p), quoted(mesh.name, "mesh", m));
        mesh.primitive_count = static_cast<std::uint32_t>(doc.scene.primitives.size()) - mesh.first_primitive;
        doc.scene.meshes.push_back(std::move(mesh));
    }
    if (doc.scene.materials.empty())
        doc.scene.materials.emplace_back();
}

} // namespace burnish::gltf
