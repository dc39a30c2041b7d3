#include "apps/bake/displaced.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/scene/height_map.h"

namespace burnish {
namespace {

constexpr std::size_t kMostDisplaced = std::size_t{1} << 24; // at most 156 bytes each, and a .glb holds less than 2^32

template <std::size_t N> glm::dvec3 vector_of(const float (&v)[N])
{
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

glm::dvec3 place_of(const DrawTables& t, std::uint32_t v)
{
    return {static_cast<double>(t.px[v]), static_cast<double>(t.py[v]), static_cast<double>(t.pz[v])};
}

glm::dvec2 coordinates_of(const DrawTables& t, std::uint32_t v)
{
    return {static_cast<double>(t.shading[v].uv0[0]), static_cast<double>(t.shading[v].uv0[1])};
}

// Returns metres a unit of texture coordinates, by vertex. Vertices at one position share a value.
std::vector<double> texture_lengths(const DrawTables& t)
{
    struct Sum {
        double length = 0.0;
        int triangles = 0;
    };
    std::map<std::array<float, 3>, Sum> places;
    const auto key = [&](std::uint32_t v) { return std::array<float, 3>{t.px[v], t.py[v], t.pz[v]}; };
    for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3) {
        const std::uint32_t v[3] = {t.indices[i], t.indices[i + 1], t.indices[i + 2]};
        const glm::dvec3 p = place_of(t, v[0]);
        const glm::dvec2 c = coordinates_of(t, v[0]), a = coordinates_of(t, v[1]) - c, b = coordinates_of(t, v[2]) - c;
        const double in_texture = std::abs(a.x * b.y - a.y * b.x);
        if (!(in_texture > 1e-15))
            continue;
        const double in_space = glm::length(glm::cross(place_of(t, v[1]) - p, place_of(t, v[2]) - p));
        for (const std::uint32_t k : v) {
            Sum& sum = places[key(k)];
            sum.length += std::sqrt(in_space / in_texture);
            ++sum.triangles;
        }
    }
    std::vector<double> lengths(t.px.size());
    for (std::uint32_t v = 0; v < lengths.size(); ++v)
        if (const auto found = places.find(key(v)); found != places.end())
            lengths[v] = found->second.length / found->second.triangles;
    return lengths;
}

class Displacer {
  public:
    Displacer(const DrawTables& t, const Image& heights, double depth, int parts)
        : t_(t), heights_(heights), depth_(depth), parts_(parts), lengths_(texture_lengths(t))
    {
    }

    void triangle(std::size_t first)
    {
        for (int k = 0; k < 3; ++k)
            corner_[k] = t_.indices[first + static_cast<std::size_t>(k)];
        const auto base = static_cast<std::uint32_t>(words_.size() / kWords);
        for (int j = 0; j <= parts_; ++j)
            for (int i = 0; i + j <= parts_; ++i)
                vertex(static_cast<double>(i) / parts_, static_cast<double>(j) / parts_);
        const auto at = [&](int i, int j) { return base + static_cast<std::uint32_t>(j * (parts_ + 1) - j * (j - 1) / 2 + i); };
        for (int j = 0; j < parts_; ++j)
            for (int i = 0; i + j < parts_; ++i) {
                indices_.insert(indices_.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
                if (i + j + 1 < parts_)
                    indices_.insert(indices_.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    }

    std::string glb() const;

  private:
    static constexpr std::size_t kWords = 12; // a vertex: position, normal, tangent, texture coordinates

    template <class Value> auto blend(double b, double c, const Value& value) const
    {
        return value(corner_[0]) * (1.0 - b - c) + value(corner_[1]) * b + value(corner_[2]) * c;
    }
    glm::dvec3 place(double b, double c) const
    {
        const glm::dvec2 uv = blend(b, c, [&](std::uint32_t v) { return coordinates_of(t_, v); });
        const glm::dvec3 n = glm::normalize(blend(b, c, [&](std::uint32_t v) { return vector_of(t_.shading[v].normal); }));
        const double length = blend(b, c, [&](std::uint32_t v) { return lengths_[v]; });
        const double below = 1.0 - static_cast<double>(height_at(heights_, Texture(), uv.x, uv.y));
        return blend(b, c, [&](std::uint32_t v) { return place_of(t_, v); }) - n * (below * depth_ * length);
    }
    void vertex(double b, double c)
    {
        const double step = 0.25 / parts_;
        // Estimate the normal from displaced neighbours
        const glm::dvec3 along = place(b + step, c) - place(b - step, c), across = place(b, c + step) - place(b, c - step);
        glm::dvec3 n = glm::cross(along, across);
        const glm::dvec3 before = blend(b, c, [&](std::uint32_t v) { return vector_of(t_.shading[v].normal); });
        n = glm::dot(n, n) > 0.0 ? glm::normalize(n) : glm::normalize(before);
        // Make the tangent perpendicular to the normal
        glm::dvec3 t = blend(b, c, [&](std::uint32_t v) { return vector_of(t_.shading[v].tangent); });
        t -= n * glm::dot(n, t);
        if (!(glm::dot(t, t) > 1e-12))
            t = std::abs(n.x) < 0.7 ? glm::cross(n, glm::dvec3(1.0, 0.0, 0.0)) : glm::cross(n, glm::dvec3(0.0, 1.0, 0.0));
        t = glm::normalize(t);
        // Append the vertex
        const glm::dvec2 uv = blend(b, c, [&](std::uint32_t v) { return coordinates_of(t_, v); });
        const glm::dvec3 p = place(b, c);
        for (const double word :
             {p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y, t.z, static_cast<double>(t_.shading[corner_[0]].tangent[3]), uv.x, uv.y})
            words_.push_back(static_cast<float>(word));
        for (int k = 0; k < 3; ++k)
            low_[k] = std::min(low_[k], static_cast<float>(p[k])), high_[k] = std::max(high_[k], static_cast<float>(p[k]));
    }

    const DrawTables& t_;
    const Image& heights_;
    double depth_;
    int parts_; // along a triangle's side
    std::vector<double> lengths_;
    std::uint32_t corner_[3] = {};
    std::vector<float> words_;
    std::vector<std::uint32_t> indices_;
    float low_[3] = {1e30f, 1e30f, 1e30f}, high_[3] = {-1e30f, -1e30f, -1e30f};
};

void put_word(std::string& to, std::size_t word)
{
    for (int i = 0; i < 4; ++i)
        to += static_cast<char>(word >> 8 * i & 255);
}

void put_chunk(std::string& to, const char* kind, const std::string& bytes)
{
    put_word(to, bytes.size());
    to.append(kind, 4);
    to += bytes;
}

std::string Displacer::glb() const
{
    using Json = nlohmann::ordered_json;
    const std::size_t vertices = words_.size() / kWords, vertex_bytes = words_.size() * sizeof(float);
    const auto column = [&](std::size_t first, const char* type) {
        return Json{{"bufferView", 0}, {"byteOffset", first * sizeof(float)}, {"componentType", 5126}, {"count", vertices}, {"type", type}};
    };
    Json position = column(0, "VEC3");
    position["min"] = low_, position["max"] = high_;
    const Json gltf = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}, {"name", "displaced"}}}},
        {"materials", {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.4}}}}}},
        {"meshes",
         {{{"primitives",
            {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TANGENT", 2}, {"TEXCOORD_0", 3}}}, {"indices", 4}, {"material", 0}}}}}}},
        {"accessors",
         {position,
          column(3, "VEC3"),
          column(6, "VEC4"),
          column(10, "VEC2"),
          {{"bufferView", 1}, {"componentType", 5125}, {"count", indices_.size()}, {"type", "SCALAR"}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteLength", vertex_bytes}, {"byteStride", kWords * sizeof(float)}, {"target", 34962}},
          {{"buffer", 0}, {"byteOffset", vertex_bytes}, {"byteLength", indices_.size() * 4}, {"target", 34963}}}},
        {"buffers", {{{"byteLength", vertex_bytes + indices_.size() * 4}}}}};
    std::string text = gltf.dump(), data(vertex_bytes + indices_.size() * 4, '\0');
    text.append((4 - text.size() % 4) % 4, ' ');
    std::memcpy(data.data(), words_.data(), vertex_bytes);
    std::memcpy(data.data() + vertex_bytes, indices_.data(), indices_.size() * 4);
    std::string out = "glTF";
    put_word(out, 2);
    put_word(out, 12 + 8 + text.size() + 8 + data.size());
    put_chunk(out, "JSON", text);
    put_chunk(out, "BIN\0", data);
    return out;
}

} // namespace

Result<Displaced> displaced(const DrawTables& tables, const Image& heights, double depth, std::size_t least_triangles,
                            const std::string& file)
{
    const std::size_t whole = tables.triangle_count();
    if (whole == 0)
        return Error{ExitCode::bad_input, file, "", "has no triangle of any size"};
    int parts = 1;
    while (whole * static_cast<std::size_t>(parts) * static_cast<std::size_t>(parts) < least_triangles)
        ++parts;
    const std::size_t count = whole * static_cast<std::size_t>(parts) * static_cast<std::size_t>(parts);
    if (count > kMostDisplaced)
        return Error{ExitCode::bad_input, file, "", fmt::format("{} triangles are more than {}", count, kMostDisplaced)};
    Displacer made(tables, heights, depth, parts);
    for (std::size_t i = 0; i < whole; ++i)
        made.triangle(3 * i);
    return Displaced{made.glb(), count};
}

} // namespace burnish
