#include "core/scene/check_columns.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

#include "core/scene/check_scene.h"

namespace burnish {
namespace {

struct VertexColumn {
    const char* name;
    Column<float> VertexTable::*column;
    bool needed;
    float fallback; // where the column is missing
};
constexpr VertexColumn kColumns[] = {
    {"px", &VertexTable::px, true, 0},  {"py", &VertexTable::py, true, 0},  {"pz", &VertexTable::pz, true, 0},
    {"nx", &VertexTable::nx, true, 0},  {"ny", &VertexTable::ny, true, 0},  {"nz", &VertexTable::nz, true, 0},
    {"tx", &VertexTable::tx, false, 0}, {"ty", &VertexTable::ty, false, 0}, {"tz", &VertexTable::tz, false, 0},
    {"tw", &VertexTable::tw, false, 1}, {"u0", &VertexTable::u0, false, 0}, {"v0", &VertexTable::v0, false, 0},
    {"u1", &VertexTable::u1, false, 0}, {"v1", &VertexTable::v1, false, 0}, {"cr", &VertexTable::cr, false, 1},
    {"cg", &VertexTable::cg, false, 1}, {"cb", &VertexTable::cb, false, 1}, {"ca", &VertexTable::ca, false, 1}};

constexpr std::uint32_t kMagnitude = 0x7fffffffu, kInfinite = 0x7f800000u;
constexpr std::size_t kBlock = 1024; // numbers tested together before the search for the first fault

std::uint32_t magnitude(float v)
{
    return std::bit_cast<std::uint32_t>(v) & kMagnitude;
}

std::size_t first_without_normal(const VertexTable& v)
{
    for (std::size_t i = 0; i < v.size(); ++i)
        if (magnitude(v.nx[i]) == 0 && magnitude(v.ny[i]) == 0 && magnitude(v.nz[i]) == 0)
            return i;
    return v.size();
}

std::size_t first_without_sign(const Column<float>& tw)
{
    for (std::size_t i = 0; i < tw.size(); ++i)
        if (std::fabs(tw[i]) != 1.0f)
            return i;
    return tw.size();
}

} // namespace

std::size_t first_not_finite(const float* v, std::size_t size)
{
    for (std::size_t block = 0; block < size; block += kBlock) {
        const std::size_t end = std::min(size, block + kBlock);
        std::uint32_t most = 0;
        for (std::size_t i = block; i < end; ++i)
            most = std::max(most, magnitude(v[i]));
        for (std::size_t i = block; most >= kInfinite && i < end; ++i)
            if (magnitude(v[i]) >= kInfinite)
                return i;
    }
    return size;
}

Status fault_of_file(Status status, const std::string& file)
{
    if (status)
        return status;
    Error error = status.error();
    error.file = file;
    return error;
}

void fill_missing_columns(Scene& scene)
{
    for (const VertexColumn& c : kColumns)
        if (Column<float>& column = scene.vertices.*c.column; !c.needed && column.empty()) {
            column.resize(scene.vertices.size());
            std::fill(column.begin(), column.end(), c.fallback);
        }
}

Status check_columns(const Scene& scene)
{
    const VertexTable& v = scene.vertices;
    for (const VertexColumn& c : kColumns)
        if (const std::size_t size = (v.*c.column).size(); size != v.size())
            return scene_fault(fmt::format("/vertices/{}", c.name), fmt::format("holds {} numbers for {} vertices", size, v.size()));
    for (const VertexColumn& c : kColumns)
        if (const std::size_t i = first_not_finite((v.*c.column).data(), v.size()); i < v.size())
            return scene_fault(fmt::format("/vertices/{}/{}", c.name, i), "is NaN or infinite");
    if (const std::size_t i = first_without_normal(v); i < v.size())
        return scene_fault(fmt::format("/vertices/nx/{}", i), "the normal (0, 0, 0) has no direction");
    if (const std::size_t i = first_without_sign(v.tw); i < v.size())
        return scene_fault(fmt::format("/vertices/tw/{}", i), fmt::format("{:g} is neither 1 nor -1", v.tw[i]));
    return {};
}

Status check_primitive(const Scene& scene, std::size_t at)
{
    const Primitive& p = scene.primitives[at];
    const auto place = [&](const char* field) { return fmt::format("/primitives/{}/{}", at, field); };
    if (p.index_count % 3 != 0)
        return scene_fault(place("index_count"), fmt::format("{} is no multiple of 3", p.index_count));
    if (std::uint64_t{p.first_index} + p.index_count > scene.indices.size())
        return scene_fault(place(p.first_index > scene.indices.size() ? "first_index" : "index_count"),
                           fmt::format("indices {} to {} do not exist, the scene has {}", p.first_index,
                                       std::uint64_t{p.first_index} + p.index_count, scene.indices.size()));
    if (std::uint64_t{p.first_vertex} + p.vertex_count > scene.vertices.size())
        return scene_fault(place(p.first_vertex > scene.vertices.size() ? "first_vertex" : "vertex_count"),
                           fmt::format("vertices {} to {} do not exist, the scene has {}", p.first_vertex,
                                       std::uint64_t{p.first_vertex} + p.vertex_count, scene.vertices.size()));
    if (p.material < 0 || static_cast<std::size_t>(p.material) >= scene.materials.size())
        return scene_fault(place("material"),
                           fmt::format("material {} does not exist, the scene has {}", p.material, scene.materials.size()));
    return {};
}

Status check_indices(const Scene& scene)
{
    for (std::size_t at = 0; at < scene.primitives.size(); ++at) {
        const Primitive& p = scene.primitives[at];
        const std::uint32_t* const indices = scene.indices.data() + p.first_index;
        std::uint32_t most = 0; // largest index minus first vertex; wraps for an index below the first vertex
        for (std::size_t i = 0; i < p.index_count; ++i)
            most = std::max(most, indices[i] - p.first_vertex);
        if (p.index_count == 0 || most < p.vertex_count)
            continue;
        std::size_t i = 0;
        while (indices[i] - p.first_vertex < p.vertex_count)
            ++i;
        return scene_fault(fmt::format("/primitives/{}/indices/{}", at, i),
                           fmt::format("vertex {} is none of its {} from {} on", indices[i], p.vertex_count, p.first_vertex));
    }
    return {};
}

} // namespace burnish
