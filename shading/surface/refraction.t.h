// The surface of what lets light through (KHR_materials_transmission): a rough interface that reflects and refracts by one distribution of
// microfacets, the ellipsoid's of the surface's two widths, tilted where normals are (shading/models/ellipsoid_dielectric.k.h), with
// Fresnel's exact factors. Values are of radiance over the square of the index, which refraction keeps: what an interface adds on the way
// in, the other takes away on the way out, and of the environment alone, seen through one interface, nothing is lost to the index.
#ifndef BN_REFRACTION_T_H
#define BN_REFRACTION_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/models/ellipsoid_dielectric.k.h"
#include "shading/surface/placed_lobe.t.h"
#include "shading/surface/reflectance.t.h"

BN_KERNELS_BEGIN

// What a material says of its interface.
struct interface_inputs {
    fresnel_parts parts; // exact; ior: of the far side over the eye's
    real3 tint;          // of what passes, [0,1]; the diffuse part has the rest
};

struct rough_interface {
    interface_inputs at;
    ellipsoid_dielectric_params p;
    surface_frame axes; // of the surface, in which the following is
    real3 o;            // to the eye, above
    real3 n;            // the commonest normal of microfacets
};

// Where light would go on unbent there is nothing to sample: an index is at least so far from 1, which bends it by a thousandth.
BN_FN real index_of_far_side(real ior, mask front)
{
    real inside = min(max(ior, lit(1.001)), lit(10.0));
    return select(front, inside, lit(1.0) / inside);
}

// n: normal of the lobe, v: to the eye, unit, world space; axes: of the geometry.
BN_FN rough_interface rough_interface_of(interface_inputs at, aniso_lobe lobe, real3 n, real3 v, surface_frame axes)
{
    placed_lobe a = placed_lobe_of(lobe_that_has(kSeparableOfTilted), lobe, n, v, axes);
    rough_interface r;
    r.at = at;
    r.p = ellipsoid_dielectric_params_of(a.ellipsoid, at.parts.ior);
    r.axes = a.axes;
    r.o = a.o;
    r.n = a.n;
    return r;
}

// Of light that meets a microfacet at this angle, [0,1].
BN_FN real3 interface_reflects(BN_IN(interface_inputs) at, real o_dot_m)
{
    return exact_reflectance(at.parts, k_saturate(o_dot_m));
}

BN_FN real3 interface_passes(BN_IN(interface_inputs) at, real o_dot_m)
{
    real3 r = dielectric_reflectance(at.parts.dielectric_f0, at.parts.dielectric_f90, at.parts.ior, k_saturate(o_dot_m));
    real rest = max(lit(1.0) - max(r.x, max(r.y, r.z)), lit(0.0));
    return at.tint * rest;
}

// What it reflects of light from wi, unit, world space: BRDF times cosine, 1/sr; nothing of light from below. That it is a mirror is not
// looked at.
BN_FN real3 interface_value(BN_IN(rough_interface) g, real3 wi)
{
    real3 i = to_frame(g.axes, wi);
    i.z = max(i.z, lit(0.0));
    ellipsoid_scattering s = ellipsoid_scattering_of(g.p, g.o, i);
    real value = s.value * i.z;
    return interface_reflects(g.at, s.o_dot_m) * value;
}

// Directional albedo where nothing is absorbed, by samples on a Fibonacci lattice: single scattering loses the rest.
BN_STAGE real interface_albedo(BN_IN(rough_interface) g)
{
    real sum = lit(0.0);
    real part = lit(0.0069444444444444444);
    for (int i = 0; i < 144; ++i) {
        real x = (to_real(int_lit(i)) + lit(0.5)) * part;
        real y = (to_real(int_lit(i * 89 % 144)) + lit(0.5)) * part;
        ellipsoid_facet m = ellipsoid_facet_seen(g.p.shape, g.o, vec2_of(x, y));
        real f = fresnel_dielectric(m.o_dot_m, g.p.eta);
        real reflected = ellipsoid_facet_reflects(g.p.shape, m, g.o).weight * f;
        real refracted = ellipsoid_facet_refracts(g.p.shape, m, g.o, g.p.eta).weight * (lit(1.0) - f);
        sum = sum + reflected + refracted;
    }
    return sum * part;
}

BN_KERNELS_END

#endif
