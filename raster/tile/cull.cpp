#include "raster/tile/cull.h"

#include <algorithm>
#include <cmath>

namespace burnish {

namespace {

struct Plane {
    glm::vec3 n; // unit, inside is dot(n, p) + d >= 0
    float d;
};

// Returns the four side planes and the near plane.
std::vector<Plane> frustum(const View& v)
{
    std::vector<Plane> planes;
    const auto add = [&](glm::vec3 n, glm::vec3 through) {
        n = glm::normalize(n);
        planes.push_back({n, -glm::dot(n, through)});
    };
    if (v.orthographic) {
        add(v.right, v.eye - v.right * v.tan_half_x);
        add(-v.right, v.eye + v.right * v.tan_half_x);
        add(v.up, v.eye - v.up * v.tan_half_y);
        add(-v.up, v.eye + v.up * v.tan_half_y);
        add(v.forward, v.eye + v.forward * v.znear);
        return planes;
    }
    add(v.forward * v.tan_half_x + v.right, v.eye);
    add(v.forward * v.tan_half_x - v.right, v.eye);
    add(v.forward * v.tan_half_y + v.up, v.eye);
    add(v.forward * v.tan_half_y - v.up, v.eye);
    add(v.forward, v.eye);
    return planes;
}

// Returns a tolerance for distances, well above float rounding at these sizes.
float slack(const glm::vec3& p, const View& v, float size)
{
    return 1e-4f * (glm::length(p - v.eye) + size) + 1e-6f * glm::length(v.eye);
}

bool sphere_outside(const std::vector<Plane>& planes, const View& v, const glm::vec3& center, float radius)
{
    const float margin = radius + slack(center, v, radius);
    return std::any_of(planes.begin(), planes.end(), [&](const Plane& p) { return glm::dot(p.n, center) + p.d < -margin; });
}

// Returns a tolerance for triangles that rounding may turn over. Corners are floats, and the eye is subtracted first (clip_position,
// shading/kernels/vertex.k.h). So a corner's error grows with its distance, and where the error is a fraction of the triangle's size, the
// triangle may turn. The estimate takes a triangle's height as a sixteenth of the cluster's radius. Metres, as slack().
float turning(const Cluster& c, float distance)
{
    return 1e-5f * distance / c.radius * distance;
}

bool faces_away(const Cluster& c, const View& v)
{
    if (v.orthographic || c.cone_cutoff >= 1.0f)
        return false;
    const glm::vec3 d = c.center - v.eye;
    const float distance = glm::length(d);
    // Planes lie at the eye's distance from the origin; cones depend only on the distance in between.
    return glm::dot(d, c.cone_axis) >= c.cone_cutoff * distance + c.radius + 1e-4f * (distance + c.radius) + turning(c, distance);
}

} // namespace

Visible cull(const DrawTables& tables, const std::vector<MaterialRecord>& materials, const View& view)
{
    const TraceSpan span("cull");
    const std::vector<Plane> planes = frustum(view);
    Visible visible;
    std::vector<bool> seen(tables.draws.size());
    for (std::size_t i = 0; i < tables.draws.size(); ++i) {
        const Draw& d = tables.draws[i];
        const glm::vec3 center = 0.5f * (d.bounds_min + d.bounds_max);
        seen[i] = materials[static_cast<std::size_t>(d.material)].hidden == 0 &&
                  !sphere_outside(planes, view, center, 0.5f * glm::length(d.bounds_max - d.bounds_min));
        if (seen[i])
            visible.draws.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t i = 0; i < tables.clusters.size(); ++i) {
        const Cluster& c = tables.clusters[i];
        if (seen[c.draw] && !sphere_outside(planes, view, c.center, c.radius) && !faces_away(c, view))
            visible.clusters.push_back(static_cast<std::uint32_t>(i));
    }
    return visible;
}

void transform_draws(const FrameParams& f, const DrawTables& tables, const Visible& visible, const TileFns& fns, const Jobs& jobs,
                     Profiler* profiler)
{
    const TraceSpan span("transform");
    constexpr std::uint32_t kPiece = 16384; // vertices per task
    struct Piece {
        std::uint32_t first, count;
    };
    std::vector<Piece> pieces;
    for (std::uint32_t id : visible.draws) {
        const Draw& d = tables.draws[id];
        for (std::uint32_t i = 0; i < d.vertex_count; i += kPiece)
            pieces.push_back({d.first_vertex + i, std::min(kPiece, d.vertex_count - i)});
    }
    jobs.parallel_for(pieces.size(), [&](std::size_t i, int worker) {
        ProfiledWork work(profiler, worker);
        fns.transform_vertices(f, pieces[i].first, pieces[i].count);
        work.count(FrameStage::transform, pieces[i].count);
        work.lap(FrameStage::transform);
    });
}

} // namespace burnish
