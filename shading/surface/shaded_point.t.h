// A point of a surface as lights and techniques see it: normal, lobe, reflectances, albedo.
#ifndef BN_SHADED_POINT_T_H
#define BN_SHADED_POINT_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/bsdf_lobe.t.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/diffuse.k.h"
#include "shading/surface/energy.k.h"
#include "shading/surface/reflectance.t.h"
#include "shading/surface/refraction.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Directional albedos of a point's lobe, and factors that follow from them.
struct lobe_energy_terms {
    dfg_value dfg;      // of the default lobe
    real3 albedo;       // the lobe's directional albedo, for techniques with a split integral
    real phong_albedo;  // directional albedo of an Ashikhmin-Shirley lobe with the same widths, from a table; -1: no table
    int phong_set;      // MaterialRecord's
    real albedo_ratio;  // albedo(frame's lobe) / albedo(default lobe, untilted); 1 for the default lobe
    dfg_value own_dfg;  // of a lobe compensated by its own albedo (has_own_gain); else dfg
    dfg_value whole;    // own_dfg of the material's lobe before normals widen it: the reflectance of all facets in a pixel
    real3 compensation; // the lobe's energy compensation; 1 without
    real3 gain;         // factor on the specular lobe: energy compensation, loss by widening, and light that facets keep
};

// The interface of a point that transmits light.
struct transmission_terms {
    bool refracts;           // transmits light; else the others do not count
    bool disperses;          // refracts each channel by an index of its own
    bool samples_interface;  // then the technique samples both sides of the interface; others fetch transmitted light once
    mask body;               // then transmitted light enters a body here and leaves it by a second interface
    interface_inputs inputs; // of both sides
};

struct shaded_point {
    surface s;
    aniso_lobe lobe;
    surface_frame geometric_axes; // the geometry's
    bool has_surface_horizon;     // a normal map or a tilt turns s.n from geometric_axes.n; the surface's horizon cuts off light
    bool diffuse;                 // s.diffuse may be above 0
    real3 dielectric_f0;
    real dielectric_f90;
    integer pixel_id;           // y * width + x, for random numbers
    int samples;                // of the technique
    real3 normal_dx, normal_dy; // of visible_point; only for techniques that share samples
    lobe_energy_terms energy;
    transmission_terms transmission;
};

// Returns the frame's lobe on the surface.
BN_FN bsdf_lobe bsdf_lobe_at(frame_ref f, BN_IN(shaded_point) x)
{
    return make_bsdf_lobe(the_frame(f).lobe, x.lobe, x.s.n, x.s.v, x.geometric_axes);
}

// Returns true where samples of an interface replace the lobe.
BN_FN bool interface_is_sampled(BN_IN(shaded_point) x)
{
    return x.transmission.refracts && x.transmission.samples_interface;
}

// Returns the transmissive surface's interface.
BN_FN rough_interface rough_interface_at(BN_IN(shaded_point) x)
{
    return rough_interface_of(x.transmission.inputs, x.lobe, x.s.n, x.s.v, x.geometric_axes);
}

// A layer of a material, as lights see it: its lobe's index in shading/models.def, and the lobe's traits.
struct lobe_layer {
    int lobe;
    int traits;
};

// Returns the material's own layer: the frame's lobe.
BN_FN lobe_layer base_layer(frame_ref f)
{
    lobe_layer r;
    r.lobe = the_frame(f).lobe;
    r.traits = the_frame(f).lobe_traits;
    return r;
}

// Returns a layer with a lobe of its own, whatever lobe the frame has. lobe: index in shading/models.def.
BN_FN lobe_layer layer_with_lobe(int lobe)
{
    lobe_layer r;
    r.lobe = lobe;
    r.traits = traits_of_model(lobe);
    return r;
}

BN_FN bool layer_has(lobe_layer layer, int traits)
{
    return (layer.traits & traits) != 0;
}

// Returns true where lobes lie in the surface's frame: they can tilt, and know the surface's horizon.
BN_FN bool lies_in_surface(frame_ref f)
{
    return (the_frame(f).lobe_traits & kLies_surface) != 0;
}

// Returns true where a material's lobes may tilt against the normal of their surface.
BN_FN bool can_tilt(frame_ref f, material_ref m)
{
    bool upright = the_material(m).tilted == 0 && !texture_used(m, kNormalTex) && the_frame(f).lobe != the_frame(f).brdf;
    return lies_in_surface(f) && !upright;
}

// Returns true where the frame's lobe replaces the default one, for tilts or separable masking. The tables hold the default
// lobe.
BN_FN bool uses_substitute_lobe(frame_ref f)
{
    return (the_frame(f).lobe_traits & kDefaultLobe) == 0 && lobe_has(the_frame(f).brdf, kDefaultLobe);
}

// Returns the factor of energy compensation, or 1.
BN_FN real3 energy_gain(frame_ref f, real3 f0, dfg_value dfg)
{
    if (the_frame(f).energy_compensation == 0)
        return vec3_all(lit(1.0));
    return energy_compensation(f0, dfg);
}

// Returns the diffuse part's ratio to Lambert's BRDF for light at a cosine.
BN_FN real diffuse_lit(frame_ref f, real n_dot_l)
{
    if (the_frame(f).diffuse_model == 0)
        return lit(1.0);
    return phong_diffuse_lit(n_dot_l);
}

// Returns the diffuse transmittance: the share of light that the dielectric's specular part lets through to the diffuse
// part, for any light. It is 1 minus the lobe's directional albedo. (The uncompensated diffuse part of Ashikhmin and
// Shirley uses f0 instead, with phong_diffuse_lit() for the light.)
BN_FN real diffuse_energy_share(frame_ref f, BN_IN(shaded_point) x)
{
    if (the_frame(f).diffuse_model != 0 && the_frame(f).energy_compensation == 0 && !x.transmission.refracts) {
        real3 own = x.dielectric_f0;
        return phong_diffuse_seen(max(own.x, max(own.y, own.z)), x.s.n_dot_v);
    }
    real3 f0 = x.dielectric_f0;
    if (film_used() && x.s.exact >= kFilmReflects && the_frame(f).energy_compensation != 0) {
        real3 f90 = vec3_all(x.dielectric_f90);
        f0 = schlick_f0_of(filmed_dielectric(x.s.parts, fresnel_schlick(f0, f90, x.s.n_dot_v), x.s.n_dot_v), f90, x.s.n_dot_v);
    }
    real3 dielectric = dielectric_albedo_of(x.s, x.dielectric_f0, x.dielectric_f90, x.energy.whole) * energy_gain(f, f0, x.energy.whole);
    real passed = lit(1.0) - max(dielectric.x, max(dielectric.y, dielectric.z));
    if (!x.transmission.refracts)
        return BN_MUTANT(no_energy_share, passed, lit(1.0));
    // Glass reflects by Fresnel's equations, the table's lobe by Schlick's approximation: scale by the ratio of both in a
    // mirror. No table has the albedo from inside, so a mirror's replaces it there.
    real3 r = dielectric_reflectance(x.dielectric_f0, x.dielectric_f90, x.transmission.inputs.parts.ior, x.s.n_dot_v);
    real3 schlick = fresnel_schlick(x.dielectric_f0, vec3_all(x.dielectric_f90), x.s.n_dot_v);
    if (film_used() && x.s.exact >= kFilmReflects) {
        r = filmed_dielectric(x.transmission.inputs.parts, r, x.s.n_dot_v);
        schlick = filmed_dielectric(x.transmission.inputs.parts, schlick, x.s.n_dot_v);
    }
    real mirrored = max(r.x, max(r.y, r.z));
    real rough = (lit(1.0) - passed) / max(max(schlick.x, max(schlick.y, schlick.z)), lit(1e-4));
    real reflected = select(x.transmission.inputs.parts.ior >= lit(1.0), mirrored * rough, mirrored);
    return k_saturate(lit(1.0) - reflected);
}

// Returns the transmittance of a transmissive surface under a film, which passes the colours that it does not reflect.
BN_FN real3 transmittance_under_film(frame_ref f, BN_IN(shaded_point) x)
{
    real passed = diffuse_energy_share(f, x);
    real3 bare = dielectric_reflectance(x.dielectric_f0, x.dielectric_f90, x.transmission.inputs.parts.ior, x.s.n_dot_v);
    real3 r = filmed_dielectric(x.transmission.inputs.parts, bare, x.s.n_dot_v);
    real most = max(r.x, max(r.y, r.z));
    real scale = (lit(1.0) - passed) / max(most, lit(1e-4));
    return vec3_all(lit(1.0)) - r * scale;
}

// Returns the diffuse part's BRDF, 1/sr; multiply by diffuse_lit().
BN_FN real3 diffuse_brdf(frame_ref f, BN_IN(shaded_point) x)
{
    real share = diffuse_energy_share(f, x) * lit(0.31830988618379067);
    return x.s.diffuse * share;
}

BN_KERNELS_END

#endif
