// Light of the frame's area lights: the part of each lobe that they fill, by the transformed cosine that stands for the specular lobe and
// by the plain one for the diffuse part, where what is found of a lobe once serves all lights; or the lobe's mean over points of them.
// Nothing is in their way.
#ifndef BN_AREA_T_H
#define BN_AREA_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/lights/area_point.t.h"
#include "shading/lights/area_sample.t.h"
#include "shading/lights/environment.t.h"
#include "shading/lights/ltc_polygon.k.h"
#include "shading/lights/ltc_round.k.h"
#include "shading/lights/ltc_table.k.h"
#include "shading/lights/punctual.k.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

BN_FN bool area_is_flat(frame_ref f, int light)
{
    return the_area_light(f, light).shape <= kArea_disk;
}

// Where a light of one side shows it; not from within its plane.
BN_FN mask area_faces(frame_ref f, int light, real3 position)
{
    real towards = k_dot3(area_point(f, light, 0) - position, splat3(the_area_light(f, light).normal));
    if (!area_is_flat(f, light) || the_area_light(f, light).two_sided != 0)
        return towards == towards;
    return towards < lit(0.0);
}

// A light as a point sees it: in a lobe's axes, about the point.
struct area_view {
    int shape, corners;
    real radius;
    ltc_polygon at; // its points; of a disk the centre and half axes
};

BN_FN area_view area_seen_by(frame_ref f, int light, aniso_lobe lobe, real3 n, real3 position)
{
    area_view v;
    v.shape = the_area_light(f, light).shape;
    v.corners = the_area_light(f, light).corners;
    v.radius = splat(the_area_light(f, light).radius);
    for (int k = 0; k < v.corners; ++k) {
        real3 p = area_point(f, light, k);
        if (v.shape == kArea_disk && k > 0)
            v.at.corner[k] = to_lobe(lobe, n, p);
        else
            v.at.corner[k] = to_lobe(lobe, n, p - position);
    }
    return v;
}

// The part of a lobe that a light fills, [0,1]. clipless: polygons are not clipped at the horizon, but spheres like them.
BN_STAGE real area_part(BN_IN(area_view) v, BN_IN(ltc_lobe) lobe, bool clipless)
{
    if (v.shape == kArea_disk)
        return ltc_disk_light(lobe, v.at.corner[0], v.at.corner[1], v.at.corner[2]).part;
    if (v.shape == kArea_sphere)
        return ltc_sphere_light(lobe, v.at.corner[0], v.radius).part;
    if (v.shape == kArea_line)
        return ltc_line_light(lobe, v.at.corner[0], v.at.corner[1], v.radius).part;
    if (area_way_used(kAreaWay_ltc_clipless) && clipless)
        return ltc_polygon_clipless(lobe, v.at, v.corners).part;
    return ltc_polygon_light(lobe, v.at, v.corners).part;
}

// model: the lobe that lights meet; a round one is about the normal, as wide as the surface is rough. position: of x, world space. Lobes of
// other models are taken for GGX's of the same widths; those that only lamps meet have none of this light.
BN_FN real3 area_light_by_cosines(frame_ref f, BN_IN(shaded_point) x, int model, real3 position)
{
    aniso_lobe lobe = x.lobe;
    if (lobe_has(model, kLies_round)) {
        lobe.sigma_u = x.s.roughness * x.s.roughness * lit(0.70710678118654752);
        lobe.sigma_v = lobe.sigma_u;
    }
    real root2 = lit(1.4142135623730951);
    real alpha_u = lobe.sigma_u * root2;
    real alpha_v = lobe.sigma_v * root2;
    ltc_table table;
    table.texels = ltc_texels(f);
    table.root_alpha = the_frame(f).ltc_root_alpha;
    table.basis = the_frame(f).ltc_basis;
    ltc_lobe shiny = ltc_lookup(table, to_lobe(lobe, x.s.n, x.s.v), alpha_u, alpha_v);
    ltc_lobe dull = ltc_cosine();
    bool clipless = the_frame(f).area_way == kAreaWay_ltc_clipless;
    real3 specular = vec3_all(lit(0.0));
    real3 diffuse = vec3_all(lit(0.0));
    for (int i = 0; i < the_frame(f).area_light_count; ++i) {
        mask faces = area_faces(f, i, position);
        if (no_lane(faces))
            continue;
        area_view view = area_seen_by(f, i, lobe, x.s.n, position);
        real3 radiance = select(faces, splat3(the_area_light(f, i).radiance), vec3_all(lit(0.0)));
        specular = specular + radiance * area_part(view, shiny, clipless);
        if (x.diffuse)
            diffuse = diffuse + radiance * area_part(view, dull, clipless);
    }
    dfg_value albedo;
    albedo.scale = shiny.all - shiny.grazing;
    albedo.bias = shiny.grazing;
    real3 sum = seen_of_lobe(f, x, 0, specular * albedo_of(x.s, albedo) * x.gain);
    if ((the_frame(f).lobe_traits & kPunctualOnly) != 0)
        sum = vec3_all(lit(0.0));
    if (x.diffuse) {
        real passed = passed_to_diffuse(f, x);
        sum = sum + x.s.diffuse * diffuse * passed;
    }
    return sum;
}

// By points of each light, a Hammersley set rotated by a hash of pixel and light.
BN_FN real3 area_light_by_samples(frame_ref f, BN_IN(shaded_point) x, int model, real3 position)
{
    placed_lobe lobe = placed_lobe_under_lights(model, x.lobe, x.s, x.surface_axes);
    bool apart = lobe_has(lobe.model, kLies_surface + kLies_thread); // whose value knows the cosine
    rough_interface through;
    if (x.refracts)
        through = rough_interface_at(x);
    int n = the_frame(f).light_samples;
    uniform_real inv = 1.0f / float(n);
    integer seed = k_hash_u32(x.pixel_id ^ int_lit(the_frame(f).seed));
    real3 specular = vec3_all(lit(0.0));
    real3 irradiance = vec3_all(lit(0.0));
    for (int i = 0; i < the_frame(f).area_light_count; ++i) {
        real3 radiance = splat3(the_area_light(f, i).radiance) * splat(inv);
        seed = k_hash_u32(seed ^ int_lit(i));
        real shift_x = k_unit_from_bits(seed);
        real shift_y = k_unit_from_bits(k_hash_u32(seed));
        for (int k = 0; k < n; ++k) {
            uniform_real column = (float(k) + 0.5f) * inv;
            real u = splat(column) + shift_x;
            real v = k_radical_inverse2(int_lit(k)) + shift_y;
            real2 xi = vec2_of(u - floor(u), v - floor(v));
            area_sample s = area_sample_at(f, i, position, xi);
            real cosine = max(k_dot3(x.s.n, s.wi), lit(0.0));
            mask seen = s.pdf > lit(0.0);
            if (x.turned)
                seen = both(seen, k_dot3(x.surface_axes.n, s.wi) > lit(0.0));
            real weight = select(seen, lit(1.0) / max(s.pdf, lit(1e-20)), lit(0.0));
            real value = lit(0.0);
            if (apart)
                value = placed_lobe_value(lobe, s.wi);
            else
                value = select(cosine > lit(0.0), placed_lobe_light(lobe, x.s, s.wi), lit(0.0)) * cosine;
            real3 fresnel = reflectance_of(x.s, punctual_v_dot_h(x.s, s.wi));
            real part = value * weight;
            real3 reflected = fresnel * part;
            if (x.refracts)
                reflected = interface_value(through, s.wi) * weight;
            specular = specular + radiance * reflected;
            real fallen = cosine * weight;
            irradiance = irradiance + radiance * fallen;
        }
    }
    real3 sum = specular * x.gain;
    if (x.diffuse) {
        real passed = passed_to_diffuse(f, x) * lit(0.31830988618379067);
        sum = sum + x.s.diffuse * irradiance * passed;
    }
    return sum;
}

BN_FN real3 light_from_area(frame_ref f, BN_IN(shaded_point) x, int model, real3 position)
{
    if (area_way_used(kAreaWay_mc) && the_frame(f).area_way == kAreaWay_mc)
        return area_light_by_samples(f, x, model, position);
    if (area_way_used(kAreaWay_ltc) || area_way_used(kAreaWay_ltc_clipless))
        return area_light_by_cosines(f, x, model, position);
    return vec3_all(lit(0.0));
}

BN_KERNELS_END

#endif
