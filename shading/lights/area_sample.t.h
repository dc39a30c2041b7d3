// Random points on area lights, and intersections of directions with area lights, for Monte Carlo sums.
#ifndef BN_AREA_SAMPLE_T_H
#define BN_AREA_SAMPLE_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/lights/area_point.t.h"

BN_KERNELS_BEGIN

struct area_sample { // a direction from a point to a light
    real3 wi;        // unit
    real distance;
    real pdf; // density of area_sample_at(), 1/sr; 0 where the light is not visible
};

struct area_axes { // unit, perpendicular to a unit vector and to each other
    real3 u, v;
};

// Returns axes across w: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
BN_FN area_axes area_axes_of(real3 w)
{
    real sign_z = select(w.z < lit(0.0), lit(-1.0), lit(1.0));
    real k = lit(-1.0) / (sign_z + w.z);
    real mixed = w.x * w.y * k;
    area_axes a;
    a.u = vec3_of(lit(1.0) + sign_z * w.x * w.x * k, sign_z * mixed, -(sign_z * w.x));
    a.v = vec3_of(mixed, sign_z + w.y * w.y * k, -w.y);
    return a;
}

// Returns a uniform point of a polygon; picks triangles of its fan by area. xi: [0,1)^2.
BN_FN real3 polygon_point(frame_ref f, int light, real2 xi)
{
    real left = xi.x * splat(the_area_light(f, light).area);
    real3 first = area_point(f, light, 0);
    real3 at = first;
    mask open = left == left;
    // Visit the fan's triangles until the area is used up
    for (int k = 1; k + 1 < the_area_light(f, light).corners; ++k) {
        real3 a = area_point(f, light, k) - first;
        real3 b = area_point(f, light, k + 1) - first;
        real part = max(lit(0.5) * k_length3(k_cross(a, b)), lit(1e-30));
        mask here = open;
        if (k + 2 < the_area_light(f, light).corners)
            here = both(open, left <= part);
        // Map xi uniformly to the triangle
        real side = sqrt(k_saturate(left / part));
        at = select(here, first + a * (side * (lit(1.0) - xi.y)) + b * (side * xi.y), at);
        open = both(open, not_(here));
        left = left - part;
    }
    return at;
}

// Returns the sample for a point of a surface. way: to the point, not unit; normal: the surface's.
BN_FN area_sample area_towards(frame_ref f, int light, real3 way, real3 normal, bool both_sides)
{
    area_sample s;
    // Normalize the direction
    real d2 = max(k_dot3(way, way), lit(1e-20));
    s.distance = sqrt(d2);
    s.wi = way / s.distance;
    // Convert the area density to solid angle
    real cosine = -k_dot3(s.wi, normal);
    if (both_sides)
        cosine = abs(cosine);
    real pdf = d2 / max(cosine * splat(the_area_light(f, light).area), lit(1e-20));
    s.pdf = select(cosine > lit(1e-7), pdf, lit(0.0));
    return s;
}

// Returns 1 minus the cosine of a sphere's angular radius; 2 from inside.
BN_FN real sphere_cone(real3 centre, real radius)
{
    real ratio = radius * radius / max(k_dot3(centre, centre), lit(1e-20));
    mask outside = ratio < lit(1.0);
    real cosine = sqrt(max(lit(1.0) - ratio, lit(0.0)));
    return select(outside, ratio / (lit(1.0) + cosine), lit(2.0));
}

// Intersects wi with a sphere. centre: relative to the point; cone: sphere_cone(). The density is 0 where wi misses.
BN_FN area_sample sphere_along(real3 centre, real radius, real3 wi, real cone)
{
    // Find the chord along wi
    real ahead = k_dot3(wi, centre);
    real3 beside = centre - wi * ahead;
    real half2 = radius * radius - k_dot3(beside, beside);
    real half_chord = sqrt(max(half2, lit(0.0)));
    // Take its far end from inside, its near end from outside
    mask within = cone > lit(1.5);
    area_sample s;
    s.wi = wi;
    s.distance = select(within, ahead + half_chord, max(ahead - half_chord, lit(0.0)));
    mask met = either(within, both(half2 >= lit(0.0), ahead > lit(0.0)));
    s.pdf = select(met, lit(0.15915494309189534) / max(cone, lit(1e-20)), lit(0.0));
    return s;
}

// Samples a light: surfaces uniformly by area, spheres uniformly by direction. position: world space; xi: [0,1)^2.
BN_STAGE area_sample area_sample_at(any_frame f, int light, BN_IN(real3) position, BN_IN(real2) xi)
{
    real turn = lit(6.2831853071795865) * xi.y;
    k_sin_cos_pair around = k_sin_cos(turn);
    real3 first = area_point(f, light, 0);
    real radius = splat(the_area_light(f, light).radius);
    // Sample the cone of a sphere
    if (the_area_light(f, light).shape == kArea_sphere) {
        // Build axes about the direction to the centre
        real3 centre = first - position;
        real cone = sphere_cone(centre, radius);
        real3 w = k_normalize3(select(k_dot3(centre, centre) > lit(1e-20), centre, vec3_of(lit(0.0), lit(0.0), lit(1.0))));
        area_axes axes = area_axes_of(w);
        // Sample a uniform direction in the cone
        real fall = xi.x * cone;
        real sine = sqrt(max(fall * (lit(2.0) - fall), lit(0.0)));
        real3 wi = k_normalize3(w * (lit(1.0) - fall) + (axes.u * around.cosine + axes.v * around.sine) * sine);
        // Find the point on the sphere
        area_sample s = sphere_along(centre, radius, wi, cone);
        s.pdf = lit(0.15915494309189534) / max(cone, lit(1e-20)); // rounding would miss the sphere at its very edge
        return s;
    }
    // Sample the side of a tube
    if (the_area_light(f, light).shape == kArea_line) {
        real3 along = area_point(f, light, 1) - first;
        area_axes axes = area_axes_of(k_normalize3(along));
        real3 normal = axes.u * around.cosine + axes.v * around.sine;
        real3 way = first + along * xi.x + normal * radius - position;
        return area_towards(f, light, way, normal, false);
    }
    // Sample a disk or a polygon
    real3 at = first;
    if (the_area_light(f, light).shape == kArea_disk) {
        real from_centre = sqrt(xi.x);
        at = first + area_point(f, light, 1) * (from_centre * around.cosine) + area_point(f, light, 2) * (from_centre * around.sine);
    } else {
        at = polygon_point(f, light, xi);
    }
    // Convert the density
    real3 way = at - position;
    return area_towards(f, light, way, splat3(the_area_light(f, light).normal), the_area_light(f, light).two_sided != 0);
}

// Intersects wi with a tube's side.
BN_FN area_sample tube_along(frame_ref f, int light, real3 position, real3 wi)
{
    real radius = splat(the_area_light(f, light).radius);
    // Split position and direction along and across the tube
    real3 from = position - area_point(f, light, 0);
    real3 whole = area_point(f, light, 1) - area_point(f, light, 0);
    real extent = k_length3(whole);
    real3 along = whole / max(extent, lit(1e-20));
    real3 beside = from - along * k_dot3(from, along);
    real3 across = wi - along * k_dot3(wi, along);
    // Solve for the first intersection
    real a = max(k_dot3(across, across), lit(1e-12));
    real b = k_dot3(across, beside);
    real c = k_dot3(beside, beside) - radius * radius;
    real root2 = b * b - a * c;
    real root = sqrt(max(root2, lit(0.0)));
    area_sample s;
    s.wi = wi;
    s.distance = (-b - root) / a;
    real3 at = from + wi * s.distance;
    // Test the ends, and convert the area density
    real place = k_dot3(at, along);
    mask met = both(both(root2 > lit(0.0), c > lit(0.0)), both(s.distance > lit(0.0), both(place >= lit(0.0), place <= extent)));
    real cosine = root / radius;
    real pdf = s.distance * s.distance / max(cosine * splat(the_area_light(f, light).area), lit(1e-20));
    s.pdf = select(met, pdf, lit(0.0));
    return s;
}

// Intersects a unit direction with a light. The density is 0 where the direction misses.
BN_STAGE area_sample area_along(any_frame f, int light, BN_IN(real3) position, BN_IN(real3) wi)
{
    real3 first = area_point(f, light, 0);
    // Intersect spheres and tubes
    if (the_area_light(f, light).shape == kArea_sphere) {
        real3 centre = first - position;
        real radius = splat(the_area_light(f, light).radius);
        return sphere_along(centre, radius, wi, sphere_cone(centre, radius));
    }
    if (the_area_light(f, light).shape == kArea_line)
        return tube_along(f, light, position, wi);
    // Intersect the light's plane
    real3 normal = splat3(the_area_light(f, light).normal);
    real slant = k_dot3(wi, normal);
    mask meets = abs(slant) > lit(1e-7);
    real t = k_dot3(first - position, normal) / select(meets, slant, lit(1.0));
    real3 at = position + wi * t;
    mask inside = both(meets, t > lit(0.0));
    // Test a disk or a polygon's edges
    if (the_area_light(f, light).shape == kArea_disk) {
        // Find coordinates in the disk's half axes
        real3 u = area_point(f, light, 1);
        real3 v = area_point(f, light, 2);
        real3 from_centre = at - first;
        real x = k_dot3(from_centre, u) / k_dot3(u, u);
        real y = k_dot3(from_centre, v) / k_dot3(v, v);
        real r2 = x * x + y * y;
        inside = both(inside, r2 <= lit(1.0));
    } else {
        int corners = the_area_light(f, light).corners;
        // Test the inner side of every edge
        for (int k = 0; k < corners; ++k) {
            real3 corner = area_point(f, light, k);
            real3 edge = area_point(f, light, k + 1 < corners ? k + 1 : 0) - corner;
            real left = k_dot3(k_cross(edge, at - corner), normal);
            inside = both(inside, left >= lit(0.0));
        }
    }
    // Return the density at the intersection
    area_sample s = area_towards(f, light, wi * t, normal, the_area_light(f, light).two_sided != 0);
    s.pdf = select(inside, s.pdf, lit(0.0));
    return s;
}

BN_KERNELS_END

#endif
