#include "core/scene/add_mesh.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "core/scene/tangents.h"

namespace burnish {
namespace {

constexpr std::size_t kMost = 0x7fffffffu; // corners and vertices
constexpr float kLargestPosition = 1e15f;  // metres; sums of areas beyond overflow

// Returns the place of the first number that is NaN or infinite, or an empty text.
template <class Vector> std::string not_finite_place(const char* name, std::span<const Vector> values)
{
    for (std::size_t i = 0; i < values.size(); ++i)
        for (glm::length_t k = 0; k < Vector::length(); ++k)
            if (!std::isfinite(values[i][k]))
                return std::string("/") + name + "/" +
                       std::to_string(i * static_cast<std::size_t>(Vector::length()) + static_cast<std::size_t>(k));
    return "";
}

std::size_t corner_at(const MeshInput& mesh, std::size_t i)
{
    return mesh.triangles.empty() ? i : mesh.triangles[i];
}

glm::vec3 area_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
{
    return glm::cross(b - a, c - a);
}

// Checks numbers that are finite: sizes of positions, lengths of normals, areas of triangles.
Status check_sizes(const MeshInput& mesh, const std::string& place, std::size_t corners)
{
    const auto fault = [&](const std::string& name, std::string reason) {
        return Error{ExitCode::bad_input, "", place + name, std::move(reason)};
    };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int k = 0; k < 3; ++k)
            if (std::fabs(mesh.positions[i][k]) > kLargestPosition)
                return fault(fmt::format("/positions/{}", 3 * i + static_cast<std::size_t>(k)),
                             fmt::format("{:g} is too large: positions lie in -{:g}..{:g} m", mesh.positions[i][k], kLargestPosition,
                                         kLargestPosition));
    for (std::size_t i = 0; !mesh.normals.empty() && i < corners; ++i)
        if (const std::size_t v = corner_at(mesh, i); mesh.normals[v] == glm::vec3(0.0f))
            return fault(fmt::format("/normals/{}", 3 * v), "the normal (0, 0, 0) has no direction");
    const auto placed = [&](std::size_t i) { return glm::vec3(mesh.transform * glm::vec4(mesh.positions[corner_at(mesh, i)], 1.0f)); };
    for (std::size_t t = 0; t < corners; t += 3)
        if (area_of(placed(t), placed(t + 1), placed(t + 2)) != glm::vec3(0.0f))
            return {};
    return fault("/triangles", "have no area in 32-bit floats: nothing can be seen");
}

Status check_mesh(const MeshInput& mesh, const std::string& place)
{
    const auto usage = [&](const char* name, std::string reason) { return Error{ExitCode::usage, "", place + name, std::move(reason)}; };
    const std::size_t vertices = mesh.positions.size(), corners = mesh.triangles.empty() ? vertices : mesh.triangles.size();
    if (mesh.positions.empty())
        return usage("/positions", "are missing");
    if (corners < 3)
        return usage("/triangles", "are missing");
    if (corners % 3 != 0)
        return usage("/triangles",
                     fmt::format("{} {} are no multiple of 3", corners, mesh.triangles.empty() ? "vertices in order" : "indices"));
    if (corners > kMost || vertices > kMost)
        return usage("/triangles", "are too many");
    if (!mesh.normals.empty() && mesh.normals.size() != vertices)
        return usage("/normals", "are not one a vertex");
    if (!mesh.coordinates.empty() && mesh.coordinates.size() != vertices)
        return usage("/coordinates", "are not one a vertex");
    std::vector<glm::vec4> transform;
    for (int i = 0; i < 4; ++i)
        transform.push_back(mesh.transform[i]);
    for (const std::string& found :
         {not_finite_place("positions", mesh.positions), not_finite_place("normals", mesh.normals),
          not_finite_place("coordinates", mesh.coordinates), not_finite_place("transform", std::span<const glm::vec4>(transform))})
        if (!found.empty())
            return Error{ExitCode::bad_input, "", place + found, "is NaN or infinite"};
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (mesh.triangles[i] >= vertices)
            return Error{ExitCode::bad_input, "", place + "/triangles/" + std::to_string(i), "is beyond the vertices"};
    return check_sizes(mesh, place, corners);
}

// Returns a normal a vertex, of any length.
std::vector<glm::vec3> normals_of(const MeshInput& mesh, std::size_t corners)
{
    if (!mesh.normals.empty())
        return {mesh.normals.begin(), mesh.normals.end()};
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0f));
    for (std::size_t t = 0; t < corners; t += 3) {
        const std::size_t a = corner_at(mesh, t), b = corner_at(mesh, t + 1), c = corner_at(mesh, t + 2);
        const glm::vec3 normal = area_of(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
        for (const std::size_t v : {a, b, c})
            normals[v] += normal;
    }
    return normals;
}

} // namespace

Result<std::int32_t> add_mesh(Scene& scene, const MeshInput& mesh)
{
    const std::string place = "/meshes/" + std::to_string(scene.meshes.size());
    BN_TRY(check_mesh(mesh, place));
    // Gather the corners: triangles share no vertex
    const std::size_t corners = mesh.triangles.empty() ? mesh.positions.size() : mesh.triangles.size();
    const std::vector<glm::vec3> normals = normals_of(mesh, corners);
    const bool mapped = !mesh.coordinates.empty();
    std::vector<glm::vec3> p(corners), n(corners);
    std::vector<glm::vec2> uv(corners, glm::vec2(0.0f));
    for (std::size_t i = 0; i < corners; ++i) {
        const std::size_t v = corner_at(mesh, i);
        p[i] = mesh.positions[v];
        const glm::vec3 size = glm::abs(normals[v]);
        const float most = std::max({size.x, size.y, size.z}); // squares of other lengths over- or underflow
        n[i] = most > 0.0f ? glm::normalize(normals[v] / most) : glm::vec3(0, 0, 1);
        if (mapped)
            uv[i] = mesh.coordinates[v];
    }
    if (!mapped && mesh.material.anisotropy_strength > 0.0f)
        scene.warnings.push_back(
            place + ": anisotropy needs coordinates, since the highlight runs along their first axis: the direction is arbitrary");
    // Fill the columns
    VertexTable& to = scene.vertices;
    Primitive primitive;
    primitive.first_index = static_cast<std::uint32_t>(scene.indices.size()), primitive.index_count = static_cast<std::uint32_t>(corners);
    primitive.first_vertex = static_cast<std::uint32_t>(to.size()), primitive.vertex_count = primitive.index_count;
    primitive.material = static_cast<std::int32_t>(scene.materials.size()), primitive.has_uv0 = mapped;
    const std::vector<glm::vec4> tangents = mapped ? mikk_tangents(p, n, uv) : std::vector<glm::vec4>(corners, glm::vec4(0, 0, 0, 1));
    for (std::size_t i = 0; i < corners; ++i) {
        to.px.push_back(p[i].x), to.py.push_back(p[i].y), to.pz.push_back(p[i].z);
        to.nx.push_back(n[i].x), to.ny.push_back(n[i].y), to.nz.push_back(n[i].z);
        to.tx.push_back(tangents[i].x), to.ty.push_back(tangents[i].y), to.tz.push_back(tangents[i].z), to.tw.push_back(tangents[i].w);
        to.u0.push_back(uv[i].x), to.v0.push_back(uv[i].y), to.u1.push_back(0.0f), to.v1.push_back(0.0f);
        to.cr.push_back(1.0f), to.cg.push_back(1.0f), to.cb.push_back(1.0f), to.ca.push_back(1.0f);
        scene.indices.push_back(primitive.first_vertex + static_cast<std::uint32_t>(i));
    }
    Node node;
    node.name = mesh.name, node.mesh = static_cast<std::int32_t>(scene.meshes.size()), node.local = mesh.transform;
    scene.meshes.push_back({mesh.name, static_cast<std::uint32_t>(scene.primitives.size()), 1});
    scene.primitives.push_back(primitive), scene.materials.push_back(mesh.material), scene.nodes.push_back(node);
    return static_cast<std::int32_t>(scene.nodes.size() - 1);
}

} // namespace burnish
