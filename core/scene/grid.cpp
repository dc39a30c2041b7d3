#include "core/scene/grid.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace burnish {
namespace {

constexpr int kBlockQuads = 8; // 8 * 8 * 2 triangles are one cluster

void put_vertex(VertexTable& v, std::size_t at, const SurfacePoint& p)
{
    const glm::dvec3 n = p.normal / std::sqrt(glm::dot(p.normal, p.normal));
    const glm::dvec3 across = p.tangent - n * glm::dot(n, p.tangent);
    const glm::dvec3 t = across / std::sqrt(glm::dot(across, across));
    const auto put = [at](Column<float>& column, double value) { column[at] = static_cast<float>(value); };
    put(v.px, p.position.x);
    put(v.py, p.position.y);
    put(v.pz, p.position.z);
    put(v.nx, n.x);
    put(v.ny, n.y);
    put(v.nz, n.z);
    put(v.tx, t.x);
    put(v.ty, t.y);
    put(v.tz, t.z);
    put(v.tw, 1.0);
    put(v.u0, p.u);
    put(v.v0, p.v);
    put(v.u1, 0.0);
    put(v.v1, 0.0);
    put(v.cr, p.shade);
    put(v.cg, p.shade);
    put(v.cb, p.shade);
    put(v.ca, 1.0);
}

void push_triangle(Scene& scene, std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    const VertexTable& v = scene.vertices;
    const auto same = [&v](std::uint32_t i, std::uint32_t k) { return v.px[i] == v.px[k] && v.py[i] == v.py[k] && v.pz[i] == v.pz[k]; };
    if (same(a, b) || same(b, c) || same(c, a))
        return;
    for (std::uint32_t i : {a, b, c})
        scene.indices.push_back(i);
}

} // namespace

std::uint32_t begin_primitive(Scene& scene, std::int32_t material)
{
    Primitive primitive;
    primitive.first_index = static_cast<std::uint32_t>(scene.indices.size());
    primitive.first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    primitive.material = material;
    primitive.has_uv0 = primitive.has_file_tangents = true;
    scene.primitives.push_back(primitive);
    return static_cast<std::uint32_t>(scene.primitives.size() - 1);
}

void add_grid(Scene& scene, int columns, int rows, const Surface& surface)
{
    BN_CHECK(!scene.primitives.empty());
    Primitive& primitive = scene.primitives.back();
    const auto base = static_cast<std::uint32_t>(scene.vertices.size());
    VertexTable& v = scene.vertices;
    const std::size_t vertices = base + static_cast<std::size_t>(columns + 1) * static_cast<std::size_t>(rows + 1);
    for (Column<float>* column :
         {&v.px, &v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.tx, &v.ty, &v.tz, &v.tw, &v.u0, &v.v0, &v.u1, &v.v1, &v.cr, &v.cg, &v.cb, &v.ca})
        column->resize_for_overwrite(vertices);
    std::size_t at = base;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) {
            const SurfacePoint p = surface(column, row);
            primitive.has_color = primitive.has_color || p.shade != 1.0;
            put_vertex(v, at++, p);
        }
    const auto id = [&](int column, int row) { return base + static_cast<std::uint32_t>(row * (columns + 1) + column); };
    for (int row0 = 0; row0 < rows; row0 += kBlockQuads)
        for (int column0 = 0; column0 < columns; column0 += kBlockQuads)
            for (int row = row0; row < std::min(row0 + kBlockQuads, rows); ++row)
                for (int column = column0; column < std::min(column0 + kBlockQuads, columns); ++column) {
                    push_triangle(scene, id(column, row), id(column + 1, row), id(column + 1, row + 1));
                    push_triangle(scene, id(column, row), id(column + 1, row + 1), id(column, row + 1));
                }
    primitive.index_count = static_cast<std::uint32_t>(scene.indices.size()) - primitive.first_index;
    primitive.vertex_count = static_cast<std::uint32_t>(scene.vertices.size()) - primitive.first_vertex;
}

std::int32_t add_mesh(Scene& scene, const char* name, std::uint32_t first_primitive)
{
    Mesh mesh;
    mesh.name = name;
    mesh.first_primitive = first_primitive;
    mesh.primitive_count = static_cast<std::uint32_t>(scene.primitives.size()) - first_primitive;
    scene.meshes.push_back(mesh);
    return static_cast<std::int32_t>(scene.meshes.size() - 1);
}

void add_node(Scene& scene, const char* name, std::int32_t mesh, const glm::mat4& local)
{
    Node node;
    node.name = name;
    node.mesh = mesh;
    node.local = local;
    scene.nodes.push_back(node);
}

} // namespace burnish
