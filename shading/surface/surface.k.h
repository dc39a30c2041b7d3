// The surface at a visible point for techniques and lights, and its frames.
#ifndef BN_SURFACE_K_H
#define BN_SURFACE_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/lobe.k.h"

BN_KERNELS_BEGIN

struct fresnel_parts {          // inputs of Fresnel's equations: see reflectance.t.h
    real dielectric, conductor; // shares of the surface, [0,1]
    real3 dielectric_f0;        // the dielectric's, at normal incidence
    real dielectric_f90, ior;   // at grazing incidence; its index
    real3 eta, k;               // the conductor's index
    real3 rest_f0, rest_f90;    // for Schlick's approximation, times the share of the rest
    real film;                  // share of the surface under a thin film, [0,1]
    real film_thickness;        // nm
    real film_ior;
    real film_side; // below 1 where the eye looks from inside: index of the far side over the eye's
    real metal;     // share of metal below the film, [0,1]; the dielectric has the rest
    real3 metal_f0; // the metal's reflectance at normal incidence
};

const int kFilmReflects = 4; // above kFresnelSchlick...

struct surface {
    real3 n;             // shading normal, unit, world space
    real3 v;             // to the eye, unit, world space
    real n_dot_v;        // clamped to [1e-4, 1]
    real3 diffuse;       // albedo of the diffuse part, [0,1]
    real3 f0, f90;       // specular reflectance at normal and grazing incidence
    real roughness;      // perceptual, [0,1]
    real occlusion;      // [0,1], 1 open
    int exact;           // uniform; 0: all parts reflect by Schlick's approximation; else the frame's way, and kFilmReflects
    fresnel_parts parts; // for these parts
};

struct surface_frame {
    real3 n, t, b; // orthonormal, world space; b = +-cross(n, t)
};

// Makes a frame. n: unit; t: perpendicular to n, any length; handedness: +1 or -1.
BN_FN surface_frame frame_of(real3 n, real3 t, real handedness)
{
    surface_frame f;
    f.n = n;
    f.t = k_normalize3(t);
    f.b = k_cross(f.n, f.t) * handedness;
    return f;
}

// Makes the geometry's frame. normal, tangent: interpolated, any length, not parallel; normal on the viewer's side.
BN_FN surface_frame geometric_frame(real3 normal, real3 tangent, real handedness)
{
    real3 n = k_normalize3(normal);
    real3 t = tangent - n * k_dot3(n, tangent);
    return frame_of(n, t, handedness);
}

// Turns a frame to a mapped normal. map: tangent-space normal from the texture, any length. Where the normal lies along the
// tangent, the old normal becomes the tangent.
BN_FN surface_frame mapped_frame(surface_frame f, real3 map, real handedness)
{
    real3 n = k_normalize3(f.t * map.x + f.b * map.y + f.n * map.z);
    real3 t = f.t - n * k_dot3(n, f.t);
    return frame_of(n, select(k_dot3(t, t) > lit(1e-8), t, f.n), handedness); // shorter tangents are rounding errors
}

// Returns the shortest rotation from (0,0,1) to n, unit, as the quaternion (a; b, c, 0) of conj(q) v q. The square root
// keeps its digits near z = -1, where the rotation becomes half a turn about x.
BN_FN real3 rotation_to(real3 n)
{
    real flat_part = n.x * n.x + n.y * n.y;
    real upper = (lit(1.0) + n.z) * lit(0.5);
    real lower = flat_part / (lit(2.0) + abs(n.z) * lit(2.0));
    real a = sqrt(max(select(n.z < lit(0.0), lower, upper), lit(0.0)));
    real part = lit(0.5) / max(a, lit(1e-6));
    return select(a < lit(1e-6), vec3_of(lit(0.0), lit(1.0), lit(0.0)), vec3_of(a, n.y * part, -(n.x * part)));
}

// Returns tangent, bitangent and normal of a rotation (a; b, c, 0), unit, in the rotated space.
BN_FN surface_frame rotated_axes(real3 q)
{
    real a2 = q.x * q.x;
    real b2 = q.y * q.y;
    real c2 = q.z * q.z;
    real ab = lit(2.0) * q.x * q.y;
    real ac = lit(2.0) * q.x * q.z;
    real bc = lit(2.0) * q.y * q.z;
    surface_frame r;
    r.t = vec3_of(a2 + b2 - c2, bc, ac);
    r.b = vec3_of(bc, a2 - b2 + c2, -ab);
    r.n = vec3_of(-ac, ab, a2 - b2 - c2);
    return r;
}

// Turns a frame to a mapped normal by the shortest rotation, which turns tangent and bitangent alike. map: as in
// mapped_frame(); a map of length 0 turns nothing.
BN_FN surface_frame turned_frame(surface_frame f, real3 map)
{
    real3 up = vec3_of(lit(0.0), lit(0.0), lit(1.0));
    real3 n = k_normalize3(select(k_dot3(map, map) > lit(1e-12), map, up));
    surface_frame by = rotated_axes(rotation_to(n));
    surface_frame r;
    r.t = f.t * by.t.x + f.b * by.t.y + f.n * by.t.z;
    r.b = f.t * by.b.x + f.b * by.b.y + f.n * by.b.z;
    r.n = f.t * by.n.x + f.b * by.n.y + f.n * by.n.z;
    return r;
}

// Replaces the normal by the mapped one, and keeps the mesh's tangent and bitangent, which are then not perpendicular to
// it.
BN_FN surface_frame bent_frame(surface_frame f, real3 map)
{
    real3 n = f.t * map.x + f.b * map.y + f.n * map.z;
    f.n = k_normalize3(select(k_dot3(n, n) > lit(1e-12), n, f.n));
    return f;
}

// Tilts a frame for a lobe whose most frequent normal is tilted against the surface: returns the rows of R = Rx(theta_x)
// Ry(theta_y), given by cosines and sines. Positive theta_x tilts to +b, positive theta_y to -t. Walter et al. 2014, eq. 3.
BN_FN surface_frame tilted_frame(surface_frame f, real2 cosine, real2 sine)
{
    surface_frame r;
    real3 across = f.n * cosine.y - f.t * sine.y;
    r.t = f.t * cosine.y + f.n * sine.y;
    r.b = f.b * cosine.x - across * sine.x;
    r.n = f.b * sine.x + across * cosine.x;
    return r;
}

// Tilts a frame by the lobe's mean slopes, d height / d t and d height / d b.
BN_FN surface_frame sloped_frame(surface_frame f, real2 slope)
{
    real one = lit(1.0);
    real2 cosine;
    real2 sine;
    real along2 = one + slope.x * slope.x;
    cosine.y = one / sqrt(along2);
    sine.y = slope.x * cosine.y;
    real across = -(slope.y * cosine.y); // tan theta_x
    real across2 = one + across * across;
    cosine.x = one / sqrt(across2);
    sine.x = across * cosine.x;
    return tilted_frame(f, cosine, sine);
}

// Returns the share of a lobe above a horizon, [0,1]. cosine: between the lobe's middle and the horizon's normal; width:
// above 0.
BN_FN real share_above(real cosine, real width)
{
    real t = cosine / width;
    return lit(0.5) + lit(0.5) * t / sqrt(lit(1.0) + t * t);
}

// Returns the share of a lobe about a turned normal n above the surface's own horizon, [0,1]. surface_n, v: unit; v: to the
// eye.
BN_FN real horizon_fade(aniso_lobe lobe, real3 n, real3 v, real3 surface_n)
{
    // Find the lobe's middle
    real n_dot_v = k_dot3(n, v);
    real3 mirrored = n * (lit(2.0) * n_dot_v) - v;
    // Find the lobe's width towards surface_n
    real along_u = k_dot3(surface_n, lobe.u_axis) * lobe.sigma_u;
    real along_v = k_dot3(surface_n, lobe.v_axis) * lobe.sigma_v;
    real upright = k_dot3(n, surface_n);
    real across2 = max(lit(1.0) - upright * upright, lit(1e-6));
    real width = max(lit(4.2426407) * sqrt((along_u * along_u + along_v * along_v) / across2), lit(0.02)); // 3 alpha towards surface_n
    return min(share_above(k_dot3(surface_n, mirrored), width) / share_above(n_dot_v, width),
               lit(1.0)); // the lobe's own horizon has taken its part
}

// Makes a surface from glTF metallic-roughness inputs. base: linear [0,1]; metallic [0,1]; dielectric_f0, dielectric_f90:
// from the index of refraction and the specular extension.
BN_FN surface metallic_roughness_surface(real3 n, real3 v, real3 base, real metallic, real roughness, real3 dielectric_f0,
                                         real dielectric_f90, real occlusion)
{
    surface s;
    s.n = n;
    s.v = v;
    s.n_dot_v = min(max(k_dot3(n, v), lit(1e-4)), lit(1.0));
    s.diffuse = base * (lit(1.0) - metallic);
    s.f0 = dielectric_f0 + (base - dielectric_f0) * metallic;
    s.f90 = vec3_all(dielectric_f90 + (lit(1.0) - dielectric_f90) * metallic);
    s.roughness = min(max(roughness, lit(0.0)), lit(1.0));
    s.occlusion = occlusion;
    s.exact = 0;
    return s;
}

BN_KERNELS_END

#endif
