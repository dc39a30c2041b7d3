#include "core/scene/gltf/vertices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/scene/tangents.h"

namespace burnish::gltf {

namespace {

glm::vec3 read_vec3(const AccessorView& view, std::uint32_t i)
{
    return {view.number(i, 0), view.number(i, 1), view.number(i, 2)};
}

// Normalizes in double, where the squares of all floats fit. Returns false for a vector without direction.
bool normalize(const glm::dvec3& v, glm::vec3& unit)
{
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    if (!(length > 1e-30))
        return false;
    unit = {static_cast<float>(v.x / length), static_cast<float>(v.y / length), static_cast<float>(v.z / length)};
    return true;
}

glm::vec3 flat_normal(const Corners& corners, std::size_t first_corner)
{
    glm::dvec3 p[3];
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = glm::dvec3(read_vec3(corners.attributes.position, corners.vertices[first_corner + k]));
    const glm::dvec3 a = p[1] - p[0], b = p[2] - p[0];
    const glm::dvec3 cross(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    glm::vec3 unit(0.0f, 0.0f, 1.0f); // a triangle without area is never visible
    normalize(cross, unit);
    return unit;
}

// Orthogonalizes a tangent against the normal (Gram-Schmidt). Replaces an unusable tangent by an arbitrary one.
glm::vec4 clean_tangent(const AccessorView& view, std::uint32_t vertex, const glm::vec3& normal)
{
    const glm::dvec3 t(read_vec3(view, vertex)), n(normal);
    const double along = t.x * n.x + t.y * n.y + t.z * n.z;
    const double length2 = t.x * t.x + t.y * t.y + t.z * t.z;
    const glm::dvec3 flat = t - along * n;
    const double flat2 = flat.x * flat.x + flat.y * flat.y + flat.z * flat.z;
    glm::vec3 unit;
    // Within a thousandth radian of the normal, the direction is rounding error.
    if (!(flat2 > 1e-6 * length2) || !normalize(flat, unit))
        unit = any_tangent(normal);
    return {unit, view.number(vertex, 3) < 0.0f ? -1.0f : 1.0f};
}

void make_mikk_tangents(Corners& corners, const AccessorView& uv)
{
    std::vector<glm::vec3> positions(corners.vertices.size());
    std::vector<glm::vec2> uvs(corners.vertices.size());
    for (std::size_t i = 0; i < corners.vertices.size(); ++i) {
        const std::uint32_t vertex = corners.vertices[i];
        positions[i] = read_vec3(corners.attributes.position, vertex);
        // MikkTSpace expects v upwards. A glTF normal map's green also points up, against the texture's v axis.
        uvs[i] = {uv.number(vertex, 0), 1.0f - uv.number(vertex, 1)};
    }
    corners.tangents = mikk_tangents(positions, corners.normals, uvs);
}

constexpr std::size_t kVertexFloats = 18;
using VertexBits = std::array<std::uint32_t, kVertexFloats>; // all attributes, compared by their bits

VertexBits vertex_at(const Corners& corners, std::size_t corner)
{
    const Attributes& a = corners.attributes;
    const std::uint32_t i = corners.vertices[corner];
    const glm::vec3 p = read_vec3(a.position, i), &n = corners.normals[corner];
    const glm::vec4& t = corners.tangents[corner];
    float values[kVertexFloats] = {p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y, t.z, t.w, 0, 0, 0, 0, 1, 1, 1, 1};
    for (int set = 0; set < 2; ++set)
        for (int c = 0; c < 2 && a.uv[set]; ++c)
            values[10 + set * 2 + c] = a.uv[set].number(i, c);
    for (int c = 0; a.color && c < a.color.components(); ++c)
        values[14 + c] = a.color.number(i, c);
    return std::bit_cast<VertexBits>(values);
}

std::array<Column<float>*, kVertexFloats> columns_of(VertexTable& t)
{
    return {&t.px, &t.py, &t.pz, &t.nx, &t.ny, &t.nz, &t.tx, &t.ty, &t.tz, &t.tw, &t.u0, &t.v0, &t.u1, &t.v1, &t.cr, &t.cg, &t.cb, &t.ca};
}

std::uint32_t hash_of(const VertexBits& bits)
{
    std::uint32_t hash = 2166136261u; // Fowler-Noll-Vo, a word at a time, with a final mix
    for (const std::uint32_t word : bits)
        hash = (hash ^ word) * 16777619u;
    hash ^= hash >> 15;
    hash *= 0x85ebca6bu;
    return hash ^ hash >> 13;
}

// Hash table with open addressing over the appended vertices. Insertion decides the order, never the hash.
class Welder {
  public:
    explicit Welder(VertexTable& table) : columns_(columns_of(table)), first_(table.size()), slots_(1024, kFree) {}

    // Returns the vertex's scene index; sets `added` for a new vertex.
    std::size_t find_or_add(const VertexBits& bits, bool& added)
    {
        const std::uint32_t hash = hash_of(bits);
        std::size_t slot = hash & (slots_.size() - 1);
        while (slots_[slot] != kFree && !equal(slots_[slot], bits))
            slot = (slot + 1) & (slots_.size() - 1);
        added = slots_[slot] == kFree;
        if (!added)
            return first_ + slots_[slot];
        const std::size_t vertex = hashes_.size();
        slots_[slot] = static_cast<std::uint32_t>(vertex);
        hashes_.push_back(hash);
        for (std::size_t c = 0; c < kVertexFloats; ++c)
            columns_[c]->push_back(std::bit_cast<float>(bits[c]));
        if (hashes_.size() * 2 > slots_.size())
            grow();
        return first_ + vertex;
    }

  private:
    static constexpr std::uint32_t kFree = 0xffffffffu;

    bool equal(std::uint32_t vertex, const VertexBits& bits) const
    {
        for (std::size_t c = 0; c < kVertexFloats; ++c)
            if (std::bit_cast<std::uint32_t>((*columns_[c])[first_ + vertex]) != bits[c])
                return false;
        return true;
    }

    void grow()
    {
        slots_.assign(slots_.size() * 2, kFree);
        for (std::size_t v = 0; v < hashes_.size(); ++v) {
            std::size_t slot = hashes_[v] & (slots_.size() - 1);
            while (slots_[slot] != kFree)
                slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = static_cast<std::uint32_t>(v);
        }
    }

    std::array<Column<float>*, kVertexFloats> columns_;
    std::size_t first_;
    std::vector<std::uint32_t> slots_;  // vertex, counted from first_
    std::vector<std::uint32_t> hashes_; // for each vertex
};

} // namespace

namespace {

// For each of the file's vertices, a corner that has it and is finished. Remembers none where the file has far more vertices than corners:
// an accessor of zeros needs no memory, whatever its count.
class FirstCorners {
  public:
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

    explicit FirstCorners(const Corners& corners)
    {
        const auto last = std::max_element(corners.vertices.begin(), corners.vertices.end());
        if (last != corners.vertices.end() && *last < 4 * corners.vertices.size())
            first_.assign(*last + std::size_t{1}, kNone);
    }
    std::size_t& of(std::uint32_t vertex)
    {
        none_ = kNone;
        return first_.empty() ? none_ : first_[vertex];
    }

  private:
    std::vector<std::size_t> first_;
    std::size_t none_ = kNone;
};

template <class Vector> bool same_bits(const Vector& a, const Vector& b)
{
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

} // namespace

bool make_normals(Corners& corners)
{
    bool replaced = false;
    const AccessorView& normal = corners.attributes.normal;
    corners.normals.resize(corners.vertices.size());
    FirstCorners first(corners);
    for (std::size_t i = 0; i < corners.vertices.size(); i += 3) {
        glm::vec3 flat(0.0f);
        for (std::size_t k = i; k < i + 3; ++k) {
            std::size_t& own = first.of(corners.vertices[k]);
            if (own != FirstCorners::kNone) {
                corners.normals[k] = corners.normals[own];
                continue;
            }
            if (normal && normalize(glm::dvec3(read_vec3(normal, corners.vertices[k])), corners.normals[k])) {
                own = k;
                continue;
            }
            replaced = replaced || normal;
            if (flat == glm::vec3(0.0f))
                flat = flat_normal(corners, i);
            corners.normals[k] = flat;
        }
    }
    return replaced;
}

TangentSource make_tangents(Corners& corners, int uv_set)
{
    const Attributes& a = corners.attributes;
    if (!a.tangent && a.uv[uv_set]) {
        make_mikk_tangents(corners, a.uv[uv_set]);
        return TangentSource::texture_coordinates;
    }
    corners.tangents.resize(corners.vertices.size());
    FirstCorners first(corners);
    for (std::size_t i = 0; i < corners.vertices.size(); ++i) {
        std::size_t& own = first.of(corners.vertices[i]);
        if (own != FirstCorners::kNone && same_bits(corners.normals[own], corners.normals[i])) {
            corners.tangents[i] = corners.tangents[own];
            continue;
        }
        own = i;
        corners.tangents[i] = a.tangent ? clean_tangent(a.tangent, corners.vertices[i], corners.normals[i])
                                        : glm::vec4(any_tangent(corners.normals[i]), 1.0f);
    }
    return a.tangent ? TangentSource::file : TangentSource::none;
}

void append_welded(Document& doc, const Corners& corners, Primitive& primitive, const std::string& place)
{
    VertexTable& table = doc.scene.vertices;
    Column<std::uint32_t>& indices = doc.scene.indices;
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (corners.vertices.size() > kMost - indices.size() || corners.vertices.size() > kMost - table.size())
        fail(place, "the scene has more than 2^32 indices");
    primitive.first_index = static_cast<std::uint32_t>(indices.size());
    primitive.first_vertex = static_cast<std::uint32_t>(table.size());
    Welder welder(table);
    indices.reserve(indices.size() + corners.vertices.size());
    FirstCorners first(corners);
    for (std::size_t i = 0; i < corners.vertices.size(); ++i) {
        std::size_t& own = first.of(corners.vertices[i]);
        if (own != FirstCorners::kNone && same_bits(corners.normals[own], corners.normals[i]) &&
            same_bits(corners.tangents[own], corners.tangents[i])) {
            indices.push_back(indices[primitive.first_index + own]);
            continue;
        }
        own = i;
        bool added = false;
        indices.push_back(static_cast<std::uint32_t>(welder.find_or_add(vertex_at(corners, i), added)));
        if (added)
            doc.charge(sizeof(VertexBits), place);
    }
    primitive.index_count = static_cast<std::uint32_t>(corners.vertices.size());
    primitive.vertex_count = static_cast<std::uint32_t>(table.size()) - primitive.first_vertex;
}

} // namespace burnish::gltf
