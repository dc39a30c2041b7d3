// The surface of transmissive materials (KHR_materials_transmission): a rough interface that reflects and refracts with one
// distribution of microfacets. The distribution is the ellipsoid's, with the surface's two widths and tilted with its
// normals (shading/models/ellipsoid_dielectric.k.h); Fresnel factors are exact. Values are radiance over the squared index,
// which refraction preserves. An interface's factor on the way in cancels on the way out, and the environment seen through
// one interface loses nothing to the index.
#ifndef BN_REFRACTION_T_H
#define BN_REFRACTION_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/models/ellipsoid_dielectric.k.h"
#include "shading/surface/bsdf_lobe.t.h"
#include "shading/surface/reflectance.t.h"

BN_KERNELS_BEGIN

// Material inputs of an interface.
struct interface_inputs {
    fresnel_parts parts; // exact; ior: the far side's index over the eye side's
    real3 tint;          // factor on transmitted light, [0,1]; the diffuse part has the rest
    real dispersion;     // 20 over the Abbe number, at least 0
};

// Returns the interface as light of one channel meets it: red 0, green 1, blue 2. KHR_materials_dispersion.
BN_FN interface_inputs interface_of_channel(interface_inputs at, real channel)
{
    real given = at.parts.ior;
    mask enters = given >= lit(1.0);
    real inside = select(enters, given, lit(1.0) / max(given, lit(1e-3)));
    real half_spread = (inside - lit(1.0)) * lit(0.025) * min(at.dispersion, lit(100.0));
    real own = min(max(inside + half_spread * (channel - lit(1.0)), lit(1.001)), lit(10.0));
    at.parts.ior = select(enters, own, lit(1.0) / own);
    at.parts.film_side = at.parts.ior;
    return at;
}

// Returns a colour with one channel of a radiance, 0 elsewhere.
BN_FN real3 channel_alone(real3 radiance, int channel)
{
    return vec3_of(radiance.x * lit(channel == 0 ? 1.0 : 0.0), radiance.y * lit(channel == 1 ? 1.0 : 0.0),
                   radiance.z * lit(channel == 2 ? 1.0 : 0.0));
}

struct rough_interface {
    interface_inputs at;
    ellipsoid_dielectric_params p;
    surface_frame axes; // the surface's; the members below are in this frame
    real3 o;            // to the eye, above the horizon
    real3 n;            // most frequent microfacet normal
};

// Returns the index ratio, kept at least a thousandth away from 1: unbent light would leave nothing to sample.
BN_FN real index_of_far_side(real ior, mask front)
{
    real inside = min(max(ior, lit(1.001)), lit(10.0));
    return select(front, inside, lit(1.0) / inside);
}

// Makes an interface. n: lobe normal, v: to the eye, unit, world space; axes: the geometry's.
BN_FN rough_interface rough_interface_of(interface_inputs at, aniso_lobe lobe, real3 n, real3 v, surface_frame axes)
{
    bsdf_lobe a = make_bsdf_lobe(lobe_that_has(kSeparableTiltedLobe), lobe, n, v, axes);
    rough_interface r;
    r.at = at;
    r.p = ellipsoid_dielectric_params_of(a.ellipsoid, at.parts.ior);
    r.axes = a.axes;
    r.o = a.o;
    r.n = a.n;
    return r;
}

// Returns the reflected share of light that meets a microfacet at this angle, [0,1].
BN_FN real3 interface_reflects(BN_IN(interface_inputs) at, real o_dot_m)
{
    return exact_reflectance(at.parts, k_saturate(o_dot_m));
}

// Returns the transmitted share, with tint. Glass passes white light, a film the colours that it does not reflect.
BN_FN real3 interface_passes(BN_IN(interface_inputs) at, real o_dot_m)
{
    real3 r = dielectric_reflectance(at.parts.dielectric_f0, at.parts.dielectric_f90, at.parts.ior, k_saturate(o_dot_m));
    real rest = max(lit(1.0) - max(r.x, max(r.y, r.z)), lit(0.0));
    if (!film_used() || no_lane(at.parts.film > lit(0.0)))
        return at.tint * rest;
    real3 passed = vec3_all(lit(1.0)) - filmed_dielectric(at.parts, r, k_saturate(o_dot_m));
    return at.tint * select(at.parts.film > lit(0.0), passed, vec3_all(rest));
}

// Returns BRDF times cosine for reflected light from wi (unit, world space), 1/sr; 0 for light from below. Ignores the
// mirror limit.
BN_FN real3 interface_value(BN_IN(rough_interface) g, real3 wi)
{
    real3 i = to_frame(g.axes, wi);
    i.z = max(i.z, lit(0.0));
    ellipsoid_scattering s = ellipsoid_scattering_of(g.p, g.o, i);
    real value = s.value * i.z;
    return interface_reflects(g.at, s.o_dot_m) * value;
}

// Transmitted light of a lobe, as one direction with a width.
struct refracted_ray {
    real3 direction; // unit, away from the surface
    real spread;     // change of the direction per change of the normal, across the plane of incidence; a reflected one has up to 2
};

// Returns the mean microfacet normal that the eye sees, unit: n turned towards the eye. alpha: the lobe's width. The turn is a fit
// to means over visible GGX normals with alpha .09, .25 and .49, weighted by transmitted light, within 1.5 degrees from n.v = .1 on.
BN_FN real3 mean_visible_normal(real3 n, real3 v, real n_dot_v, real alpha)
{
    real alpha2 = alpha * alpha;
    real seen = sqrt(n_dot_v * n_dot_v + alpha2 * (lit(1.0) - n_dot_v * n_dot_v));
    real turn = (alpha2 * lit(1.3) + alpha * lit(0.11)) / max(seen, lit(1e-4));
    return k_normalize3(n + v * turn);
}

// Refracts the ray to the eye at the mean visible normal. n, v: unit; n_dot_v: their cosine; ior: the far side's index over the
// eye side's. Under total reflection the direction lies in the surface.
BN_FN refracted_ray refracted_ray_of(real3 n, real3 v, real n_dot_v, real alpha, real ior)
{
    real3 normal = mean_visible_normal(n, v, n_dot_v, alpha);
    real c = k_saturate(k_dot3(normal, v));
    real inverse = lit(1.0) / ior;
    real sine2 = (lit(1.0) - c * c) * (inverse * inverse);
    real cosine = sqrt(max(lit(1.0) - sine2, lit(0.0)));
    real along = c * inverse - cosine;
    refracted_ray r;
    r.direction = normal * along - v * inverse;
    r.spread = abs(along);
    return r;
}

// Way of transmitted light through a body, from the seen interface to the interface where the light leaves.
struct body_way {
    real3 exit;      // place where the light leaves, from the place that the eye sees, metres
    real3 direction; // unit, away from the body
    real distance;   // inside the body, metres
    real spread;     // refracted_ray's, of both interfaces
    real cosine;     // between the direction and the far normal, outside
    real3 normal;    // of the far side, unit, outwards
};

// Returns a ray's way through a body. inside: the ray behind the first interface. n: the geometry's normal, unit. ior: the body's. extent:
// metres through the body along n. roundness: 0: the far side is parallel to the near one; 1: the body is a ball; others lie between.
BN_FN body_way way_through_body(refracted_ray inside, real3 n, real ior, real extent, real roundness)
{
    // Cross to the far side
    real c = max(-k_dot3(inside.direction, n), lit(1e-3));
    real on_plate = lit(1.0) / c;
    real chord = on_plate + (c - on_plate) * roundness;
    body_way way;
    way.distance = extent * chord;
    way.exit = inside.direction * way.distance;
    // Refract there: a ball's far normal is its near normal, mirrored about the middle of the chord
    real3 plate = -n;
    real3 ball = n + inside.direction * (lit(2.0) * c);
    real3 far_normal = k_normalize3(plate + (ball - plate) * roundness);
    real cos_in = k_saturate(k_dot3(inside.direction, far_normal));
    real sine2 = (lit(1.0) - cos_in * cos_in) * (ior * ior);
    real cos_out = sqrt(max(lit(1.0) - sine2, lit(0.0)));
    real along = ior * cos_in - cos_out;
    way.cosine = cos_out;
    way.normal = far_normal;
    way.direction = k_normalize3(inside.direction * ior - far_normal * along);
    // A change of direction inside also moves the exit, whose normal then turns
    real turned = inside.spread * (ior * cos_in / max(cos_out, lit(0.2)) - lit(2.0) * roundness);
    way.spread = sqrt(turned * turned + along * along);
    return way;
}

// Returns the ray that the far side reflects back into the body. way: the way of `inside` through the body.
BN_FN refracted_ray reflected_inside(refracted_ray inside, BN_IN(body_way) way)
{
    refracted_ray r;
    r.direction = inside.direction - way.normal * (lit(2.0) * k_dot3(inside.direction, way.normal));
    r.spread = inside.spread + lit(2.0); // a facet's reflection turns by twice as much as the facet
    return r;
}

// Returns directional albedo without absorption, by samples on a Fibonacci lattice. Single scattering loses the rest.
BN_STAGE real interface_albedo(BN_IN(rough_interface) g)
{
    real sum = lit(0.0);
    real part = lit(0.0069444444444444444);
    for (int i = 0; i < 144; ++i) {
        // Sample a visible microfacet
        real x = (to_real(int_lit(i)) + lit(0.5)) * part;
        real y = (to_real(int_lit(i * 89 % 144)) + lit(0.5)) * part;
        ellipsoid_facet m = ellipsoid_facet_seen(g.p.shape, g.o, vec2_of(x, y));
        // Add reflection and refraction, weighted by Fresnel
        real f = fresnel_dielectric(m.o_dot_m, g.p.eta);
        real reflected = ellipsoid_facet_reflects(g.p.shape, m, g.o).weight * f;
        real refracted = ellipsoid_facet_refracts(g.p.shape, m, g.o, g.p.eta).weight * (lit(1.0) - f);
        sum = sum + reflected + refracted;
    }
    return sum * part;
}

BN_KERNELS_END

#endif
