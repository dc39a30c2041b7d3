// The method in short (Mikkelsen 2008, sections 3 and 4). Corners with equal position, normal and texture coordinate
// form one vertex. Around a vertex, triangles that share edges and have one orientation in texture space form a group.
// The group's tangent is the mean of its triangles' texture gradients. Each gradient is projected into the plane of the
// vertex normal, normalized, and weighted by the triangle's angle at the vertex. Triangles without a gradient (no area
// in texture space) join any group and add nothing. Triangles without an area in space take the result of another
// triangle at the vertex.
#include "core/scene/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr std::uint32_t kNobody = 0xffffffffu;

bool is_finite(const glm::dvec3& v)
{
    return std::fabs(v.x) <= DBL_MAX && std::fabs(v.y) <= DBL_MAX && std::fabs(v.z) <= DBL_MAX;
}

glm::dvec3 unit_or_zero(const glm::dvec3& v)
{
    const double length2 = glm::dot(v, v);
    return length2 > DBL_MIN && is_finite(v) ? v / std::sqrt(length2) : glm::dvec3(0.0);
}

glm::dvec3 flattened(const glm::dvec3& v, const glm::dvec3& n)
{
    return unit_or_zero(v - n * glm::dot(n, v));
}

// Returns each corner's vertex: the lowest corner with equal position, normal and texture coordinate.
std::vector<std::uint32_t> weld(std::span<const glm::vec3> p, std::span<const glm::vec3> n, std::span<const glm::vec2> uv)
{
    using Key = std::array<std::uint32_t, 8>;
    std::vector<Key> keys(p.size());
    const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f + 0.0f); }; // -0 becomes 0
    for (std::size_t i = 0; i < p.size(); ++i)
        keys[i] = {bits(p[i].x), bits(p[i].y), bits(p[i].z), bits(n[i].x), bits(n[i].y), bits(n[i].z), bits(uv[i].x), bits(uv[i].y)};
    std::vector<std::uint32_t> order(p.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = static_cast<std::uint32_t>(i);
    std::sort(order.begin(), order.end(),
              [&keys](std::uint32_t a, std::uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
    std::vector<std::uint32_t> vertex(p.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        vertex[order[k]] = k > 0 && keys[order[k]] == keys[order[k - 1]] ? vertex[order[k - 1]] : order[k];
    return vertex;
}

struct Face {
    glm::dvec3 gradient{0.0};                                 // unit, towards growing u
    bool preserving = false;                                  // equal orientation in space and in texture space
    bool free = true;                                         // no gradient: joins any group
    bool collapsed = false;                                   // two corners in one place
    std::uint32_t neighbour[3] = {kNobody, kNobody, kNobody}; // across the edge from corner k to k + 1
    std::uint32_t group[3] = {kNobody, kNobody, kNobody};     // group of each corner
};

Face make_face(const glm::vec3* p, const glm::vec2* uv)
{
    Face face;
    face.collapsed = p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
    const glm::vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    // Use float like all implementations of the method: for a sliver, rounding decides whether a gradient exists.
    const float area = a.x * b.y - a.y * b.x;
    face.preserving = area > 0.0f;
    if (!(std::fabs(area) > FLT_MIN))
        return face;
    const glm::vec3 d1 = p[1] - p[0], d2 = p[2] - p[0];
    const glm::dvec3 along_u = unit_or_zero(glm::dvec3(d1 * b.y - d2 * a.y)), along_v = unit_or_zero(glm::dvec3(d2 * a.x - d1 * b.x));
    face.gradient = face.preserving ? along_u : -along_u;
    face.free = along_u == glm::dvec3(0.0) || along_v == glm::dvec3(0.0);
    return face;
}

// Pairs triangles that traverse an edge in opposite directions, in the triangles' order.
void find_neighbours(const std::vector<std::uint32_t>& vertex, std::vector<Face>& faces)
{
    struct Edge {
        std::uint32_t low, high, face, side;
    };
    // List the edges of all triangles, sorted by vertices and then triangles
    std::vector<Edge> edges;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        if (faces[f].collapsed)
            continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t from = vertex[3 * f + k], to = vertex[3 * f + (k + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), f, k});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::array{a.low, a.high, a.face, a.side} < std::array{b.low, b.high, b.face, b.side};
    });
    // Edges not yet paired, by direction. For each edge, at most one list is not empty.
    std::vector<const Edge*> waiting[2];
    std::size_t taken[2] = {0, 0};
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& edge = edges[i];
        if (i == 0 || edge.low != edges[i - 1].low || edge.high != edges[i - 1].high)
            for (int way = 0; way < 2; ++way) {
                waiting[way].clear();
                taken[way] = 0;
            }
        // Pair this edge with a waiting edge in the opposite direction, or let it wait
        const int way = vertex[3 * edge.face + edge.side] == edge.low ? 0 : 1, back = 1 - way;
        if (taken[back] < waiting[back].size()) {
            const Edge& other = *waiting[back][taken[back]++];
            faces[edge.face].neighbour[edge.side] = other.face;
            faces[other.face].neighbour[other.side] = edge.face;
        } else {
            waiting[way].push_back(&edge);
        }
    }
}

struct Group {
    std::uint32_t vertex = 0;
    bool preserving = false;
    glm::dvec3 sum{0.0};
};

// Walks from triangle to triangle around the group's vertex.
void spread_group(const std::vector<std::uint32_t>& vertex, std::vector<Face>& faces, const Group& group, std::uint32_t id,
                  std::uint32_t first, std::vector<std::uint32_t>& stack)
{
    stack.assign(1, first);
    while (!stack.empty()) {
        const std::uint32_t f = stack.back();
        stack.pop_back();
        Face& face = faces[f];
        std::uint32_t corner = 0;
        while (corner < 3 && vertex[3 * f + corner] != group.vertex)
            ++corner;
        BN_CHECK_OP(corner, <, 3u);
        if (face.group[corner] != kNobody)
            continue;
        // A free triangle takes the orientation of the first group that reaches it.
        if (face.free && face.group[0] == kNobody && face.group[1] == kNobody && face.group[2] == kNobody)
            face.preserving = group.preserving;
        if (face.preserving != group.preserving)
            continue;
        face.group[corner] = id;
        for (const std::uint32_t next : {face.neighbour[(corner + 2) % 3], face.neighbour[corner]})
            if (next != kNobody)
                stack.push_back(next);
    }
}

std::vector<Group> make_groups(const std::vector<std::uint32_t>& vertex, std::vector<Face>& faces)
{
    std::vector<Group> groups;
    std::vector<std::uint32_t> stack;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (faces[f].collapsed || faces[f].free || faces[f].group[k] != kNobody)
                continue;
            const auto id = static_cast<std::uint32_t>(groups.size());
            groups.push_back({vertex[3 * f + k], faces[f].preserving, glm::dvec3(0.0)});
            spread_group(vertex, faces, groups.back(), id, f, stack);
        }
    return groups;
}

// Adds each triangle's gradient to its corners' groups, in the triangles' order.
void sum_gradients(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals, const std::vector<Face>& faces,
                   std::vector<Group>& groups)
{
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            if (faces[f].free || faces[f].group[k] == kNobody)
                continue;
            const glm::dvec3 n(normals[3 * f + k]), at(positions[3 * f + k]);
            const glm::dvec3 a = flattened(glm::dvec3(positions[3 * f + (k + 1) % 3]) - at, n);
            const glm::dvec3 b = flattened(glm::dvec3(positions[3 * f + (k + 2) % 3]) - at, n);
            groups[faces[f].group[k]].sum += flattened(faces[f].gradient, n) * det_acos(glm::dot(a, b));
        }
}

// Returns a unit tangent orthogonal to the normal for any input. An untextured corner gets +X, or another direction
// where the normal is +X.
glm::vec4 finish(const glm::dvec3& tangent, bool preserving, const glm::vec3& normal)
{
    const glm::dvec3 n = unit_or_zero(glm::dvec3(normal));
    glm::dvec3 t = flattened(tangent, n);
    if (t == glm::dvec3(0.0)) {
        const glm::dvec3 x = glm::dvec3(1.0, 0.0, 0.0) - n * n.x;
        t = glm::dot(x, x) > 1e-6 ? unit_or_zero(x) : glm::dvec3(any_tangent(glm::vec3(n)));
    }
    return glm::vec4(glm::vec3(t), preserving ? 1.0f : -1.0f);
}

// Returns for each vertex the first corner that holds a result, or kNobody.
std::vector<std::uint32_t> lenders(const std::vector<std::uint32_t>& vertex, const std::vector<Face>& faces)
{
    std::vector<std::uint32_t> lender(vertex.size(), kNobody);
    for (std::uint32_t i = 0; i < vertex.size(); ++i)
        if (!faces[i / 3].collapsed && lender[vertex[i]] == kNobody)
            lender[vertex[i]] = i;
    return lender;
}

} // namespace

glm::vec3 any_tangent(const glm::vec3& n)
{
    // Frisvad 2012, "Building an Orthonormal Basis from a 3D Unit Vector without Normalization", first vector. Restore
    // the length, because n is unit only up to rounding.
    const glm::dvec3 d(n);
    if (!(d.z > -0.9999999))
        return {0.0f, -1.0f, 0.0f};
    const double a = 1.0 / (1.0 + d.z);
    const glm::dvec3 t(1.0 - d.x * d.x * a, -d.x * d.y * a, -d.x);
    return glm::vec3(unit_or_zero(t - d * (glm::dot(t, d) / std::fmax(glm::dot(d, d), DBL_MIN))));
}

std::vector<glm::vec4> mikk_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                     std::span<const glm::vec2> uvs)
{
    BN_CHECK_OP(positions.size() % 3, ==, 0u);
    BN_CHECK_OP(positions.size(), ==, normals.size());
    BN_CHECK_OP(positions.size(), ==, uvs.size());
    BN_CHECK_OP(positions.size(), <, std::size_t{kNobody});
    // Weld corners, and find triangle gradients and neighbours
    const std::vector<std::uint32_t> vertex = weld(positions, normals, uvs);
    std::vector<Face> faces(positions.size() / 3);
    for (std::size_t f = 0; f < faces.size(); ++f)
        faces[f] = make_face(&positions[3 * f], &uvs[3 * f]);
    find_neighbours(vertex, faces);
    // Form groups around vertices, and sum their gradients
    std::vector<Group> groups = make_groups(vertex, faces);
    sum_gradients(positions, normals, faces, groups);

    // Write each corner's tangent from its group
    const std::vector<std::uint32_t> lender = lenders(vertex, faces);
    std::vector<glm::vec4> out(positions.size());
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const std::uint32_t from = faces[i / 3].collapsed && lender[vertex[i]] != kNobody ? lender[vertex[i]] : i;
        const Face& face = faces[from / 3];
        const std::uint32_t id = face.group[from % 3];
        glm::dvec3 tangent = face.gradient; // where opposite gradients cancel, a corner keeps its own gradient
        bool preserving = false;
        if (id != kNobody) {
            preserving = groups[id].preserving;
            if (glm::dot(groups[id].sum, groups[id].sum) > 1e-20)
                tangent = groups[id].sum;
        }
        out[i] = finish(id == kNobody ? glm::dvec3(0.0) : tangent, preserving, normals[i]);
    }
    return out;
}

} // namespace burnish
