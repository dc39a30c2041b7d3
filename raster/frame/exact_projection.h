// Exact projection of one triangle, with the plane and edges in homogeneous coordinates: Olano and Greer 1997,
// "Triangle Scan Conversion using 2D Homogeneous Coordinates". Nothing is clipped or snapped, and arithmetic has at least 64 bits.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "shading/lang/records.h"

namespace burnish {

using Long = long double;
struct Long3 {
    Long x, y, z;
};
inline Long3 cross(const Long3& a, const Long3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Long dot(const Long3& a, const Long3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Long3 long3(const float v[3])
{
    return {Long(v[0]), Long(v[1]), Long(v[2])};
}

// A value that is linear over the screen: at + by_x x + by_y y, in pixels from the top left corner.
struct Linear {
    Long at, by_x, by_y;
    Long value(Long x, Long y) const { return at + by_x * x + by_y * y; }
    Long slope() const { return std::hypot(by_x, by_y); } // per pixel
    // Returns the distance in pixels to where the value is 0, negative beyond.
    Long distance(Long x, Long y) const
    {
        const Long v = value(x, y), s = slope();
        return s > 0 ? v / s : v >= 0 ? std::numeric_limits<Long>::infinity() : -std::numeric_limits<Long>::infinity();
    }
};

struct ProjectedTriangle {
    Linear share[3];  // barycentrics over w
    Linear inv_w;     // their sum
    Linear z;         // depth: 1 at the near plane
    bool seen_at_all; // not edge-on

    // Returns the distance in pixels to the nearest edge or near plane; negative outside, by the distance to the farthest violated one.
    Long inside(Long x, Long y) const
    {
        Long least = Linear{1 - z.at, -z.by_x, -z.by_y}.distance(x, y);
        for (const Linear& s : share)
            least = std::min(least, s.distance(x, y));
        return least;
    }
};

// Projects the corners (world space, float as in the renderer) to an image of width x height pixels.
inline ProjectedTriangle project(const ViewRecord& v, int width, int height, const glm::vec3 corners[3])
{
    Long3 p[3]; // clip space x, y, w
    Long z[3];  // clip space z
    for (int k = 0; k < 3; ++k) {
        const Long3 d = {Long(corners[k].x) - Long(v.eye[0]), Long(corners[k].y) - Long(v.eye[1]), Long(corners[k].z) - Long(v.eye[2])};
        const Long depth = dot(long3(v.forward), d);
        p[k] = {dot(long3(v.right), d) * Long(v.inv_tan_x), dot(long3(v.up), d) * Long(v.inv_tan_y), v.orthographic ? 1 : depth};
        z[k] = v.orthographic ? (Long(v.zfar) - depth) / (Long(v.zfar) - Long(v.znear)) : Long(v.znear);
    }
    ProjectedTriangle t = {};
    const Long volume = dot(p[0], cross(p[1], p[2]));
    t.seen_at_all = volume != 0;
    for (int k = 0; k < 3; ++k) {
        const Long3 edge = cross(p[(k + 1) % 3], p[(k + 2) % 3]);
        // linear form in (2 x / width - 1, 1 - 2 y / height, 1)
        t.share[k] = {(edge.z - edge.x + edge.y) / volume, 2 * edge.x / width / volume, -2 * edge.y / height / volume};
        t.inv_w.at += t.share[k].at, t.inv_w.by_x += t.share[k].by_x, t.inv_w.by_y += t.share[k].by_y;
        t.z.at += z[k] * t.share[k].at, t.z.by_x += z[k] * t.share[k].by_x, t.z.by_y += z[k] * t.share[k].by_y;
    }
    return t;
}

} // namespace burnish
