// Polygonal lights through a transformed cosine: the lobe's share inside the polygon's cone. That share times the polygon's
// radiance gives the incoming light. Heitz, Dupuy, Hill, Neubelt 2016, section 4: N maps the polygon to where the lobe is a
// cosine, and Lambert's sum over edges holds there. Corners are in the ellipse frame, relative to the shading point, in
// order, either way around. The polygon is convex and flat. Any unit of length works, as only directions count.
#ifndef BN_LTC_POLYGON_K_H
#define BN_LTC_POLYGON_K_H
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/lights/ltc_table.k.h"

// Most corners of a polygon: 16, and one more where a plane clips the polygon.
#ifndef BN_LTC_CORNERS
#define BN_LTC_CORNERS 17
#endif

BN_KERNELS_BEGIN

struct ltc_polygon {
    real3 corner[BN_LTC_CORNERS];
};

struct ltc_light {
    real part;  // share of the lobe, [0,1]
    real3 flow; // vector form factor of the visible part in the cosine's space, or 0
};

// Returns the arc from a to b: its angle times the unit vector of its rotation; 0 where a and b are parallel. Scale does
// not matter, but |a| |b| must lie in [1e-12, 1e12]. The arc's tangent keeps the digits that its cosine lacks at small and
// large angles.
BN_FN real3 ltc_arc(real3 a, real3 b)
{
    real3 c = k_cross(a, b);
    real sine = sqrt(max(k_dot3(c, c), lit(1e-30)));
    real angle = k_atan2_above(sine, k_dot3(a, b));
    return c * (angle / sine);
}

// Returns an arc's part along the horizon.
BN_FN real ltc_horizon_arc(real2 a, real2 b)
{
    real sine = a.x * b.y - a.y * b.x;
    return k_atan2(sine, k_dot2(a, b));
}

// Transforms a polygon to the cosine's space. Scales the largest coordinate of the corners to 1 first.
BN_FN ltc_polygon ltc_polygon_to_cosine(BN_IN(ltc_lobe) lobe, BN_IN(ltc_polygon) polygon, int corners)
{
    real largest = lit(1e-30);
    for (int i = 0; i < corners; ++i) {
        real3 p = abs(polygon.corner[i]);
        largest = max(largest, max(max(p.x, p.y), p.z));
    }
    real scale = lit(1.0) / largest;
    ltc_polygon u;
    for (int i = 0; i < corners; ++i) {
        u.corner[i] = ltc_to_cosine(lobe, polygon.corner[i] * scale);
    }
    return u;
}

// Makes the light from the sum of arcs around the visible part, along the horizon and upwards. Apart, since callers that want the share
// alone leave no undefined part of a vector to an optimiser.
BN_FN ltc_light ltc_light_of(real2 along, real up)
{
    real scale = select(up < lit(0.0), lit(-0.15915494309189534), lit(0.15915494309189534));
    real height = up * scale;
    ltc_light light;
    light.part = k_saturate(height);
    light.flow = vec3_of(along.x * scale, along.y * scale, height);
    return light;
}

// Returns the light of a polygon in the cosine's space that lies entirely above or entirely below the horizon.
BN_FN ltc_light ltc_uncut_light(BN_IN(ltc_polygon) u, int corners)
{
    real3 sum = vec3_all(lit(0.0));
    for (int i = 0; i < corners; ++i) {
        sum = sum + ltc_arc(u.corner[i], u.corner[i + 1 < corners ? i + 1 : 0]);
    }
    real up = sum.z + lit(0.0); // adds the missing arc along the horizon, for the same bits as a clipped polygon
    mask shown = u.corner[0].z > lit(0.0);
    return ltc_light_of(vec2_of(select(shown, sum.x, lit(0.0)), select(shown, sum.y, lit(0.0))), select(shown, up, lit(0.0)));
}

// Clips at the horizon of the cosine's space, exactly; corners on the horizon count as below. A convex polygon goes down at
// most once. A flat one on the horizon may do so at every second edge by rounding; then each of its pieces is closed along
// the horizon.
BN_FN ltc_light ltc_polygon_light(BN_IN(ltc_lobe) lobe, BN_IN(ltc_polygon) polygon, int corners)
{
    ltc_polygon u = ltc_polygon_to_cosine(lobe, polygon, corners);
    real2 rise = vec2_all(lit(0.0)); // where the boundary came up
    real2 cut[BN_LTC_CORNERS];
    // Return early where no edge crosses the horizon
    mask any_up = u.corner[0].z > lit(0.0);
    mask all_up = any_up;
    for (int i = 1; i < corners; ++i) {
        mask is_up = u.corner[i].z > lit(0.0);
        any_up = either(any_up, is_up);
        all_up = both(all_up, is_up);
    }
    if (no_lane(both(any_up, not_(all_up)))) {
        return ltc_uncut_light(u, corners);
    }
    // Cut the edges at the horizon
    for (int i = 0; i < corners; ++i) {
        real3 a = u.corner[i];
        real3 b = u.corner[i + 1 < corners ? i + 1 : 0];
        mask a_up = a.z > lit(0.0);
        mask b_up = b.z > lit(0.0);
        mask cuts = either(both(a_up, not_(b_up)), both(b_up, not_(a_up)));
        real height = a.z - b.z;
        real t = select(cuts, a.z, lit(0.0)) / select(cuts, height, lit(1.0));
        cut[i] = vec2_of(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t);
        rise = select(both(b_up, not_(a_up)), cut[i], rise);
    }
    // Sum the arcs, and close the pieces along the horizon
    real2 along = vec2_all(lit(0.0));
    real up = lit(0.0);
    real2 fall = vec2_all(lit(0.0)); // where the boundary goes down, and where it came up before: at most once in two edges
    real2 risen = vec2_all(lit(0.0));
    for (int i = 0; i < corners; ++i) {
        real3 a = u.corner[i];
        real3 b = u.corner[i + 1 < corners ? i + 1 : 0];
        mask a_up = a.z > lit(0.0);
        mask b_up = b.z > lit(0.0);
        real3 on_horizon = vec3_of(cut[i].x, cut[i].y, lit(0.0));
        real3 from = select(a_up, a, on_horizon);
        real3 to = select(b_up, b, on_horizon);
        real3 arc = select(either(a_up, b_up), ltc_arc(from, to), vec3_all(lit(0.0)));
        along = along + vec2_of(arc.x, arc.y);
        up = up + arc.z;
        mask falls = both(a_up, not_(b_up));
        fall = select(falls, cut[i], fall);
        risen = select(falls, rise, risen);
        rise = select(both(b_up, not_(a_up)), cut[i], rise);
        if ((i & 1) == 1 || i + 1 == corners) {
            up = up + ltc_horizon_arc(fall, risen);
            fall = vec2_all(lit(0.0));
            risen = fall;
        }
    }
    return ltc_light_of(along, up);
}

// Clips a convex polygon at a plane through the shading point; the result has one more corner. Corners below move to where
// the boundary comes up. The extra corner precedes the first of them, where the boundary goes down. A polygon below the
// plane collapses to one point. normal: the plane's, upwards.
BN_FN ltc_polygon ltc_polygon_above(BN_IN(ltc_polygon) polygon, int corners, real3 normal)
{
    // Measure heights over the plane
    ltc_polygon r;
    real height[BN_LTC_CORNERS];
    for (int i = 0; i < corners; ++i) {
        height[i] = k_dot3(polygon.corner[i], normal);
    }
    // Find where the boundary comes up and goes down
    real3 rise = polygon.corner[0];
    real3 fall = rise;
    for (int i = 0; i < corners; ++i) {
        int next = i + 1 < corners ? i + 1 : 0;
        mask a_up = height[i] > lit(0.0);
        mask b_up = height[next] > lit(0.0);
        mask rises = both(b_up, not_(a_up));
        mask falls = both(a_up, not_(b_up));
        mask cuts = either(rises, falls);
        real span = height[i] - height[next];
        real t = select(cuts, height[i], lit(0.0)) / select(cuts, span, lit(1.0));
        real3 at = polygon.corner[i] + (polygon.corner[next] - polygon.corner[i]) * t;
        rise = select(rises, at, rise);
        fall = select(falls, at, fall);
    }
    mask fallen = lit(1.0) < lit(0.0); // past the extra corner's place
    real3 before = rise;               // the corner that moved on by one
    // Write the corners, with the extra one inserted
    for (int i = 0; i < corners; ++i) {
        int next = i + 1 < corners ? i + 1 : 0;
        mask up = height[i] > lit(0.0);
        real3 kept = select(up, polygon.corner[i], rise);
        r.corner[i] = select(fallen, before, kept);
        mask falls = both(up, not_(height[next] > lit(0.0)));
        before = select(falls, fall, kept);
        fallen = either(fallen, falls);
    }
    r.corner[corners] = select(fallen, before, r.corner[corners - 1]);
    return r;
}

// Returns a sphere's share of a clamped cosine, clipped at the horizon exactly. flow: the sphere's vector form factor; its
// length is the squared sine of the sphere's angular radius. Snyder 1996, "Area Light Sources for Real-Time Graphics".
BN_FN real ltc_sphere_part(real3 flow)
{
    real size = min(k_length3(flow), lit(1.0));
    real z = flow.z / max(size, lit(1e-15));
    z = min(max(z, lit(-1.0)), lit(1.0));
    real sine = sqrt(size); // sine of the radius
    real cosine = sqrt(lit(1.0) - size);
    real across = sqrt(max(lit(1.0) - z * z, lit(1e-12)));
    real sine_g = min(cosine / across, lit(1.0));
    real g_left = k_acos(sine_g); // pi / 2 - g
    real k = sqrt(lit(1.0) - sine_g * sine_g);
    real in_plane = g_left + sine_g * k - lit(2.0) * across * cosine * k;
    real ratio = min(k / max(sine, lit(1e-15)), lit(1.0));
    real arc_sine = lit(1.5707963267948966) - k_acos(ratio);
    real off_plane = abs(z) * (k * sqrt(max(size - k * k, lit(0.0))) + size * arc_sine);
    real part = max(z, lit(0.0)) * size + (in_plane - off_plane) * lit(0.31830988618379067);
    part = select(z >= sine, z * size, part);
    return k_saturate(select(z <= -sine, lit(0.0), part));
}

// Returns a polygon's share without clipping: clips a sphere with the same vector form factor instead, an approximation.
BN_FN ltc_light ltc_polygon_clipless(BN_IN(ltc_lobe) lobe, BN_IN(ltc_polygon) polygon, int corners)
{
    ltc_polygon u = ltc_polygon_to_cosine(lobe, polygon, corners);
    real3 sum = vec3_all(lit(0.0));
    real3 inside = vec3_all(lit(0.0));
    for (int i = 0; i < corners; ++i) {
        real3 a = u.corner[i];
        real3 b = u.corner[i + 1 < corners ? i + 1 : 0];
        sum = sum + ltc_arc(a, b);
        inside = inside + k_normalize3(a);
    }
    // Face the light, whichever way around the corners are.
    real ahead = k_dot3(sum, inside);
    real3 flow = sum * select(ahead < lit(0.0), lit(-0.15915494309189534), lit(0.15915494309189534));
    ltc_light light;
    light.part = ltc_sphere_part(flow);
    light.flow = flow;
    return light;
}

// Returns the share with one-sided lights dark from behind and from within their plane. to_light: from the shading point to
// any point of the light; normal: of the side that shines.
BN_FN real ltc_sided(real part, real3 to_light, real3 normal, int two_sided)
{
    real shown = part;
    if (two_sided == 0) {
        real behind = k_dot3(to_light, normal);
        shown = select(behind < lit(0.0), part, lit(0.0));
    }
    return shown;
}

BN_KERNELS_END
#endif
