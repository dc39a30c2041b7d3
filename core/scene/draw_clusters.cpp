// Proof of the cone test in Cluster. Let a triangle's normal n lie within angle theta of the axis, and its points
// within radius r of the center. The eye sees the center at distance d, at angle phi from the axis. The triangle faces
// away where d cos(phi + theta) >= r. With cos(phi) >= sin(theta), cos(phi) - cos(phi + theta) <= sin(theta), so d
// cos(phi) >= d sin(theta) + r suffices. cutoff is sin(theta) plus slack.
#include "core/scene/draw_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burnish {
namespace {

// Slack in the cutoff. Vertices snap to 1/256 pixel after culling, which can turn a grazing triangle towards the eye;
// and the eye, the view and the test are floats.
constexpr double kConeSlack = 0.02;
// Slack relative to the sphere, and to the coordinates (float rounding of center - eye).
constexpr double kRadiusSlack = 1e-4;
constexpr double kPositionSlack = 1e-6;
// Cosine of the widest angle from the axis for which a cone is useful.
constexpr double kMinConeCosine = 0.1;

glm::dvec3 position(const DrawTables& tables, std::size_t corner)
{
    const std::uint32_t i = tables.indices[corner];
    return {static_cast<double>(tables.px[i]), static_cast<double>(tables.py[i]), static_cast<double>(tables.pz[i])};
}

void set_sphere(const DrawTables& tables, Cluster& cluster)
{
    const std::size_t first = std::size_t{cluster.first_triangle} * 3;
    const std::size_t end = first + std::size_t{cluster.triangle_count} * 3;
    glm::dvec3 low = position(tables, first), high = low;
    for (std::size_t k = first; k < end; ++k) {
        low = glm::min(low, position(tables, k));
        high = glm::max(high, position(tables, k));
    }
    cluster.center = glm::vec3(0.5 * low + 0.5 * high);
    const glm::dvec3 center(cluster.center);
    double radius2 = 0.0, largest = 0.0;
    for (std::size_t k = first; k < end; ++k) {
        const glm::dvec3 p = position(tables, k), d = p - center;
        radius2 = std::fmax(radius2, glm::dot(d, d));
        largest = std::fmax(largest, std::fmax(std::fabs(p.x), std::fmax(std::fabs(p.y), std::fabs(p.z))));
    }
    const double radius = std::sqrt(radius2) * (1.0 + kRadiusSlack) + largest * kPositionSlack;
    cluster.radius = static_cast<float>(
        std::fmin(radius + static_cast<double>(std::numeric_limits<float>::min()), static_cast<double>(std::numeric_limits<float>::max())));
}

// Returns a triangle's unit normal. Zero where two corners coincide: the triangle covers nothing, however it snaps.
// Clears `certain` for distinct but collinear corners, where the front side is unknown.
glm::dvec3 face_normal(const DrawTables& tables, std::size_t triangle, bool& certain)
{
    const glm::dvec3 a = position(tables, 3 * triangle), b = position(tables, 3 * triangle + 1), c = position(tables, 3 * triangle + 2);
    if (a == b || b == c || c == a)
        return glm::dvec3(0.0);
    const glm::dvec3 e = b - a, f = c - a, n = glm::cross(e, f);
    const double n2 = glm::dot(n, n), scale = glm::dot(e, e) * glm::dot(f, f);
    if (!(n2 > 1e-12 * scale) || !(n2 < std::numeric_limits<double>::max())) {
        certain = false;
        return glm::dvec3(0.0);
    }
    return n / std::sqrt(n2);
}

void set_cone(const DrawTables& tables, Cluster& cluster)
{
    glm::dvec3 normals[kClusterTriangles];
    glm::dvec3 sum(0.0);
    bool certain = true;
    for (std::uint32_t k = 0; k < cluster.triangle_count; ++k) {
        normals[k] = face_normal(tables, std::size_t{cluster.first_triangle} + k, certain);
        sum += normals[k];
    }
    const double length = std::sqrt(glm::dot(sum, sum));
    if (!certain || !(length > 1e-6))
        return;
    cluster.cone_axis = glm::vec3(sum / length);
    const glm::dvec3 axis(cluster.cone_axis);
    double least = 1.0;
    for (std::uint32_t k = 0; k < cluster.triangle_count; ++k)
        if (normals[k] != glm::dvec3(0.0))
            least = std::fmin(least, glm::dot(axis, normals[k]));
    if (least <= kMinConeCosine)
        return;
    const double sine = std::sqrt(std::fmax(0.0, 1.0 - least * least));
    cluster.cone_cutoff = static_cast<float>(std::fmin(1.0, sine + kConeSlack));
}

} // namespace

void append_clusters(DrawTables& tables, std::uint32_t draw_id, bool double_sided)
{
    const Draw& draw = tables.draws[draw_id];
    for (std::uint32_t first = 0; first < draw.triangle_count; first += kClusterTriangles) {
        Cluster cluster;
        cluster.first_triangle = draw.first_triangle + first;
        cluster.triangle_count = std::min(kClusterTriangles, draw.triangle_count - first);
        cluster.draw = draw_id;
        set_sphere(tables, cluster);
        if (!double_sided)
            set_cone(tables, cluster);
        tables.clusters.push_back(cluster);
    }
}

} // namespace burnish
