#include "core/scene/gltf/compress.h"

#include <cstring>
#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>
#include <string_view>

#include "core/scene/gltf/buffers.h"
#include "core/scene/gltf/filters.h"
#include "core/scene/gltf/views.h"

namespace burnish::gltf {

namespace {

// Largest expansion. The vertex codec stores at least two bits for 16 bytes, the index codecs at least a byte for a
// triangle or index. The reader refuses a larger count before it allocates memory.
constexpr std::uint64_t kVertexExpansion = 64;

// Draco can store a regular grid in almost no space. Beyond a million faces, faces must be in proportion to bytes.
constexpr std::uint64_t kDracoFreeFaces = 1 << 20, kDracoFacesPerByte = 1024;

class ByteReader {
  public:
    explicit ByteReader(Bytes bytes) : bytes_(bytes) {}
    std::uint32_t byte() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }
    std::uint64_t varint() // LEB128, 32 bits
    {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const std::uint32_t b = byte();
            value |= static_cast<std::uint64_t>(b & 0x7f) << shift;
            if (!(b & 0x80))
                break;
        }
        return value;
    }

  private:
    Bytes bytes_;
    std::size_t at_ = 0;
};

// Checks the sizes in a Draco header, because the decoder allocates memory for them before it reads further. Draco
// bitstream specification 2.2, sections 3 (header) and 4.1, 4.2 (connectivity).
void check_draco_header(Bytes bytes, const std::string& place)
{
    constexpr std::size_t kHeader = 11;
    if (bytes.size() < kHeader || std::string_view(reinterpret_cast<const char*>(bytes.data()), 5) != "DRACO")
        fail(place, "the buffer view holds no Draco data");
    if (bytes[5] != 2 || bytes[6] != 2)
        fail(place, fmt::format("Draco bitstream {}.{} is not supported, only 2.2", bytes[5], bytes[6]));
    if (bytes[7] != 1)
        fail(place, "the Draco data is not a triangle mesh");
    if (bytes[10] & 0x80)
        fail(place, "Draco metadata is not supported");
    ByteReader reader(bytes.subspan(kHeader));
    std::uint64_t faces, points;
    if (bytes[8] == 1) { // edgebreaker: traversal type, vertices, faces
        reader.byte();
        points = reader.varint();
        faces = reader.varint();
    } else { // sequential
        faces = reader.varint();
        points = reader.varint();
    }
    const std::uint64_t most = kDracoFreeFaces + kDracoFacesPerByte * bytes.size();
    if (faces > most || points > 3 * most)
        fail(place, fmt::format("{} bytes of Draco data claim {} faces and {} points", bytes.size(), faces, points));
}

template <class T> bool copy_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components, std::uint8_t* out)
{
    T value[16] = {};
    for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
        const draco::AttributeValueIndex index = attribute.mapped_index(p);
        if (index.value() >= attribute.size() || !attribute.ConvertValue<T>(index, static_cast<std::int8_t>(components), value))
            return false;
        const std::size_t bytes = sizeof(T) * static_cast<std::size_t>(components);
        std::memcpy(out + p.value() * bytes, value, bytes);
    }
    return true;
}

bool copy_attribute(ComponentType type, const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components, std::uint8_t* out)
{
    switch (type) {
    case ComponentType::i8:
        return copy_attribute<std::int8_t>(mesh, attribute, components, out);
    case ComponentType::u8:
        return copy_attribute<std::uint8_t>(mesh, attribute, components, out);
    case ComponentType::i16:
        return copy_attribute<std::int16_t>(mesh, attribute, components, out);
    case ComponentType::u16:
        return copy_attribute<std::uint16_t>(mesh, attribute, components, out);
    case ComponentType::u32:
        return copy_attribute<std::uint32_t>(mesh, attribute, components, out);
    case ComponentType::f32:
        return copy_attribute<float>(mesh, attribute, components, out);
    }
    return false;
}

} // namespace

void check_meshopt(const Document& doc, const Json& view, const Json& extension, const std::string& place)
{
    const std::string here = place + "/extensions/EXT_meshopt_compression";
    const std::uint64_t stride = get_uint(extension, "byteStride", 0), count = get_uint(extension, "count", 0);
    const std::uint64_t length = get_uint(extension, "byteLength", 0);
    const std::string mode = get_string(extension, "mode"), filter = get_string(extension, "filter");
    buffer_slice(doc, get_index(extension, "buffer"), get_uint(extension, "byteOffset", 0), length, here);
    // The product fits 64 bits, because the factors are at most 2^53 and 256.
    if (stride * count != get_uint(view, "byteLength", 0))
        fail(here, "byteStride times count is not the buffer view's byteLength");
    if (get_uint(view, "byteStride", stride) != stride)
        fail(here + "/byteStride", "is not the buffer view's byteStride");
    const bool attributes = mode == "ATTRIBUTES";
    if (attributes ? stride % 4 != 0 : stride != 2 && stride != 4)
        fail(here + "/byteStride", fmt::format("{} is not possible in mode {}", stride, mode));
    if (mode == "TRIANGLES" && count % 3 != 0)
        fail(here + "/count", "is not a multiple of 3 in mode TRIANGLES");
    const bool filtered = !filter.empty() && filter != "NONE";
    if (filtered && (!attributes || (filter == "OCTAHEDRAL" && stride != 4 && stride != 8) || (filter == "QUATERNION" && stride != 8)))
        fail(here + "/filter", fmt::format("{} is not possible in mode {} with stride {}", filter, mode, stride));
    const std::uint64_t most = attributes ? kVertexExpansion * length / stride : mode == "TRIANGLES" ? 3 * length : length;
    if (count > most)
        fail(here + "/count", fmt::format("{} elements cannot be stored in {} bytes", count, length));
}

std::vector<std::uint8_t> decode_meshopt(Document& doc, const Json& extension, const std::string& place)
{
    const std::string here = place + "/extensions/EXT_meshopt_compression";
    const std::uint64_t stride = get_uint(extension, "byteStride", 0), count = get_uint(extension, "count", 0);
    const std::string mode = get_string(extension, "mode"), filter = get_string(extension, "filter");
    const Bytes source =
        buffer_slice(doc, get_index(extension, "buffer"), get_uint(extension, "byteOffset", 0), get_uint(extension, "byteLength", 0), here);
    doc.charge(stride * count, here);
    std::vector<std::uint8_t> bytes(stride * count);
    const int status = mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, source.data(), source.size())
                       : mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, source.data(), source.size())
                                             : meshopt_decodeIndexSequence(bytes.data(), count, stride, source.data(), source.size());
    if (status != 0)
        fail(here, "the compressed data is damaged");
    if (filter == "OCTAHEDRAL")
        filter_octahedral(bytes.data(), count, stride);
    else if (filter == "QUATERNION")
        filter_quaternion(bytes.data(), count);
    else if (filter == "EXPONENTIAL")
        filter_exponential(bytes.data(), count * stride / 4);
    return bytes;
}

DracoPrimitive decode_draco(Document& doc, const Json& primitive, const Json& extension, const std::string& place)
{
    const std::string here = place + "/extensions/KHR_draco_mesh_compression";
    const Bytes source = view_bytes(doc, get_index(extension, "bufferView"));
    check_draco_header(source, here);
    // Decode the mesh
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(source.data()), source.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        fail(here, "the Draco data is damaged: " + printable(decoded.status().error_msg_string()));
    const draco::Mesh& mesh = *decoded.value();

    // Copy the indices
    DracoPrimitive result;
    result.vertex_count = mesh.num_points();
    doc.charge(mesh.num_faces() * 12ull, here);
    result.indices.reserve(mesh.num_faces() * 3ull);
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& p : mesh.face(f)) {
            if (p.value() >= mesh.num_points())
                fail(here, "the Draco data is damaged: a face names a point that is not there");
            result.indices.push_back(p.value());
        }
    // Copy each attribute in its accessor's type
    for (const auto& [name, id] : extension["attributes"].items()) {
        const auto accessor_index = primitive["attributes"].find(name);
        if (accessor_index == primitive["attributes"].end())
            fail(here + "/attributes/" + printable(name), "is not an attribute of the primitive");
        const Json& accessor = doc.json["accessors"][accessor_index->get<std::size_t>()];
        const ElementShape shape = element_shape(get_string(accessor, "type"));
        const auto type = static_cast<ComponentType>(get_index(accessor, "componentType"));
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id.get<std::uint32_t>());
        if (!attribute || shape.columns != 1 || attribute->num_components() != shape.rows)
            fail(here + "/attributes/" + printable(name), "the Draco data has no such attribute of the accessor's type");
        const std::uint64_t bytes = result.vertex_count * element_bytes(type, shape);
        doc.charge(bytes, here);
        std::vector<std::uint8_t>& out = result.attributes[name];
        out.resize(bytes);
        if (!copy_attribute(type, mesh, *attribute, shape.rows, out.data()))
            fail(here + "/attributes/" + printable(name), "the Draco attribute does not fit its accessor");
    }
    return result;
}

} // namespace burnish::gltf
