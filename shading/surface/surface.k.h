// The surface at a visible point that techniques shade: what is left of geometry and textures.
#ifndef BN_SURFACE_K_H
#define BN_SURFACE_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/lobe.k.h"

BN_KERNELS_BEGIN

struct fresnel_parts {          // what reflectances by Fresnel's equations are made of: see reflectance.t.h
    real dielectric, conductor; // shares of the surface, [0,1]
    real3 dielectric_f0;        // of the dielectric, at normal incidence
    real dielectric_f90, ior;   // and at grazing; its index
    real3 eta, k;               // index of the conductor
    real3 rest_f0, rest_f90;    // Schlick's, times the share of the rest
};

struct surface {
    real3 n;             // shading normal, unit, world space
    real3 v;             // to the eye, unit, world space
    real n_dot_v;        // clamped to [1e-4, 1]
    real3 diffuse;       // albedo of the diffuse part, [0,1]
    real3 f0, f90;       // specular reflectance at normal and grazing incidence
    real roughness;      // perceptual (alpha_lin), [0,1]
    real occlusion;      // [0,1], 1 open
    int exact;           // uniform; whether parts of it reflect by Fresnel's equations
    fresnel_parts parts; // then
};

struct surface_frame {
    real3 n, t, b; // orthonormal, world space; b = +-cross(n, t)
};

// n: unit; t: orthogonal to it, any length; handedness: +1 or -1.
BN_FN surface_frame frame_of(real3 n, real3 t, real handedness)
{
    surface_frame f;
    f.n = n;
    f.t = k_normalize3(t);
    f.b = k_cross(f.n, f.t) * handedness;
    return f;
}

// normal, tangent: interpolated, any length, not along each other, turned to the viewer's side.
BN_FN surface_frame geometric_frame(real3 normal, real3 tangent, real handedness)
{
    real3 n = k_normalize3(normal);
    real3 t = tangent - n * k_dot3(n, tangent);
    return frame_of(n, t, handedness);
}

// The frame turned to a mapped normal. map: tangent-space normal from the texture, any length. Where it lies along the tangent, the old
// normal is the new tangent.
BN_FN surface_frame mapped_frame(surface_frame f, real3 map, real handedness)
{
    real3 n = k_normalize3(f.t * map.x + f.b * map.y + f.n * map.z);
    real3 t = f.t - n * k_dot3(n, f.t);
    return frame_of(n, select(k_dot3(t, t) > lit(1e-8), t, f.n), handedness); // less is rounding
}

// The shortest rotation from (0,0,1) to n, unit, as the quaternion (a; b, c, 0) of conj(q) v q. Its square root loses nothing near z = -1,
// where it goes to half a turn about x.
BN_FN real3 rotation_to(real3 n)
{
    real flat_part = n.x * n.x + n.y * n.y;
    real upper = (lit(1.0) + n.z) * lit(0.5);
    real lower = flat_part / (lit(2.0) + abs(n.z) * lit(2.0));
    real a = sqrt(max(select(n.z < lit(0.0), lower, upper), lit(0.0)));
    real part = lit(0.5) / max(a, lit(1e-6));
    return select(a < lit(1e-6), vec3_of(lit(0.0), lit(1.0), lit(0.0)), vec3_of(a, n.y * part, -(n.x * part)));
}

// Tangent, bitangent and normal of a rotation (a; b, c, 0), unit, in the space that it turns.
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

// The frame turned to a mapped normal by the shortest way, which turns tangent and bitangent alike. map: as in mapped_frame; one without
// length turns nothing.
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

// With a mapped normal and the mesh's own tangent and bitangent, which are not orthogonal to it any more.
BN_FN surface_frame bent_frame(surface_frame f, real3 map)
{
    real3 n = f.t * map.x + f.b * map.y + f.n * map.z;
    f.n = k_normalize3(select(k_dot3(n, n) > lit(1e-12), n, f.n));
    return f;
}

// The frame of a lobe whose commonest normal is tilted against the surface: the rows of R = Rx(theta_x) Ry(theta_y), of which cosines and
// sines are given, in the frame. Positive theta_x tilts to +b, positive theta_y to -t. Walter et al. 2014, eq. 3.
BN_FN surface_frame tilted_frame(surface_frame f, real2 cosine, real2 sine)
{
    surface_frame r;
    real3 across = f.n * cosine.y - f.t * sine.y;
    r.t = f.t * cosine.y + f.n * sine.y;
    r.b = f.b * cosine.x - across * sine.x;
    r.n = f.b * sine.x + across * cosine.x;
    return r;
}

// The same by the lobe's mean slopes, d height / d t and d height / d b.
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

// Share of a lobe above a horizon, [0,1]. cosine: of its middle to the horizon's normal; width: greater than 0.
BN_FN real share_above(real cosine, real width)
{
    real t = cosine / width;
    return lit(0.5) + lit(0.5) * t / sqrt(lit(1.0) + t * t);
}

// Share of a lobe about a turned normal n that the surface's own horizon leaves, [0,1]. surface_n, v: unit; v: to the eye.
BN_FN real horizon_fade(aniso_lobe lobe, real3 n, real3 v, real3 surface_n)
{
    real n_dot_v = k_dot3(n, v);
    real3 mirrored = n * (lit(2.0) * n_dot_v) - v;
    real along_u = k_dot3(surface_n, lobe.u_axis) * lobe.sigma_u;
    real along_v = k_dot3(surface_n, lobe.v_axis) * lobe.sigma_v;
    real upright = k_dot3(n, surface_n);
    real across2 = max(lit(1.0) - upright * upright, lit(1e-6));
    real width = max(lit(4.2426407) * sqrt((along_u * along_u + along_v * along_v) / across2), lit(0.02)); // 3 alpha towards surface_n
    return min(share_above(k_dot3(surface_n, mirrored), width) / share_above(n_dot_v, width), lit(1.0)); // its own horizon has had its part
}

// glTF metallic-roughness to reflectances. base: linear [0,1]; metallic [0,1]; dielectric_f0, dielectric_f90: from index of
// refraction and the specular extension.
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
