// Offsets of texture coordinates for depths below a surface.
#ifndef BN_PARALLAX_K_H
#define BN_PARALLAX_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

struct parallax_plane {  // from the triangle: two sides, metres, and the change of both coordinate sets along them
    real3 along, across; // world space
    real4 coordinates_along, coordinates_across;
};

// Returns the change of both coordinate sets along surface vector w, through the inverse of the first fundamental form. The
// unit of w is a length in `set` (0 or 1): the square root of the area that its unit square has on the surface.
BN_FN real4 moved_on_surface(BN_IN(parallax_plane) plane, int set, real3 w)
{
    // Measure the areas on the surface and in the texture
    real3 normal = k_cross(plane.along, plane.across);
    real area2 = max(k_dot3(normal, normal), lit(1e-30));
    real4 a = plane.coordinates_along;
    real4 c = plane.coordinates_across;
    real in_texture = a.x * c.y - a.y * c.x;
    if (set != 0)
        in_texture = a.z * c.w - a.w * c.z;
    // Convert w's unit to metres
    real unit = sqrt(sqrt(area2) / max(abs(in_texture), lit(1e-15)));
    real by = unit / area2;
    // Resolve w along both sides
    real part_along = k_dot3(k_cross(plane.across, normal), w) * by;
    real part_across = k_dot3(k_cross(normal, plane.along), w) * by;
    return a * part_along + c * part_across;
}

// Returns the same for a plane on which coordinates are as long as metres: u along the tangent, v against the bitangent.
BN_FN real4 moved_in_texture(BN_IN(surface_frame) axes, real3 w)
{
    real u = k_dot3(axes.t, w);
    real v = -k_dot3(axes.b, w);
    return vec4_of(u, v, u, v);
}

BN_KERNELS_END

#endif
