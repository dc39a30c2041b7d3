// A specular lobe in place, with the contract of the models in shading/models over directions of world space: value, density, sample and
// albedo, all without Fresnel. It is GGX of two widths about the lobe's own normal; or, where lobes are tilted, an ellipsoid in the
// surface's frame, whose masking knows the surface. A lobe of no width is a mirror, which values do not meet.
#ifndef BN_PLACED_LOBE_K_H
#define BN_PLACED_LOBE_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/models/ellipsoid.k.h"
#include "shading/models/ggx_aniso.k.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

struct placed_lobe {
    bool tilted;          // which of the two it is
    surface_frame axes;   // that its directions are in: the lobe's own or, of a tilted one, the surface's
    ggx_aniso_params ggx; // of one that is not tilted
    ellipsoid_params ellipsoid;
    real3 o; // to the eye, above the horizon
};

// Between world space and a frame (t, b, n).
BN_FN real3 to_frame(surface_frame g, real3 w)
{
    return vec3_of(k_dot3(g.t, w), k_dot3(g.b, w), k_dot3(g.n, w));
}
BN_FN real3 from_frame(surface_frame g, real3 w)
{
    return g.t * w.x + g.b * w.y + g.n * w.z;
}

// n: the lobe's normal, v: to the eye, unit, world space; axes: of the geometry.
BN_FN placed_lobe placed_lobe_of(bool tilted, aniso_lobe lobe, real3 n, real3 v, surface_frame axes)
{
    real root2 = lit(1.4142135623730951);
    real alpha_u = lobe.sigma_u * root2;
    real alpha_v = lobe.sigma_v * root2;
    placed_lobe r;
    r.tilted = tilted;
    r.axes = axes;
    if (tilted) {
        r.ellipsoid =
            ellipsoid_params_of_rows(alpha_u, alpha_v, to_frame(axes, lobe.u_axis), to_frame(axes, lobe.v_axis), to_frame(axes, n));
    } else {
        r.ggx = ggx_aniso_params_of(alpha_u, alpha_v);
        r.axes.n = n;
        r.axes.t = lobe.u_axis;
        r.axes.b = lobe.v_axis;
    }
    r.o = to_frame(r.axes, v);
    r.o.z = max(r.o.z, lit(1e-4));
    r.o = k_normalize3(r.o);
    return r;
}

// BRDF times the cosine of wi, 1/sr; wi unit.
BN_FN real placed_lobe_value(placed_lobe a, real3 wi)
{
    real3 i = to_frame(a.axes, wi);
    real cosine = max(i.z, lit(0.0));
    if (a.tilted)
        return ellipsoid_eval(a.ellipsoid, a.o, i) * cosine;
    return ggx_aniso_eval(a.ggx, a.o, i) * cosine;
}

// The same over the density of normals that D would be if it were GGX's about the lobe's own normal; i: unit, in the lobe's axes.
BN_FN real placed_lobe_masking(placed_lobe a, real3 i)
{
    real cosine = max(i.z, lit(0.0));
    if (a.tilted) {
        real value = lit(0.25) * ellipsoid_g1_over_z(a.ellipsoid, a.o) * ellipsoid_g1_over_z(a.ellipsoid, i) * cosine;
        return value / sqrt(a.ellipsoid.an_length2);
    }
    return ggx_aniso_visibility(a.ggx, a.o, vec3_of(i.x, i.y, cosine)) * cosine;
}

// Density of placed_lobe_sample(), 1/sr.
BN_FN real placed_lobe_pdf(placed_lobe a, real3 wi)
{
    real3 i = to_frame(a.axes, wi);
    if (a.tilted)
        return ellipsoid_pdf(a.ellipsoid, a.o, i);
    return ggx_aniso_pdf(a.ggx, a.o, i);
}

// Cosine between view and half vector, for Fresnel.
BN_FN real placed_lobe_o_dot_h(placed_lobe a, real3 wi)
{
    return k_dot3(a.o, half_vector(a.o, to_frame(a.axes, wi)));
}

// xi in [0,1)^2.
BN_FN bsdf_sample placed_lobe_sample(placed_lobe a, real2 xi)
{
    bsdf_sample b;
    if (a.tilted)
        b = ellipsoid_sample(a.ellipsoid, a.o, xi);
    else
        b = ggx_aniso_sample(a.ggx, a.o, xi);
    b.wi = from_frame(a.axes, b.wi);
    return b;
}

// Directional albedo where nothing is absorbed, [0,1], of a tilted lobe. Tables have the others': see directional_albedo().
BN_FN real tilted_lobe_albedo(placed_lobe a)
{
    return ellipsoid_albedo(a.ellipsoid, a.o);
}

// What masking leaves of the lobe as a mirror.
BN_FN real placed_lobe_mirror_albedo(placed_lobe a)
{
    if (a.tilted)
        return ellipsoid_mirror_albedo(a.ellipsoid, a.o);
    return lit(1.0);
}

BN_KERNELS_END

#endif
