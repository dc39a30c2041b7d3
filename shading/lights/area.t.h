// Light of the frame's area lights: the part of each lobe that they fill, by the transformed cosine that stands for the specular lobe and
// by the plain one for the diffuse part. What is found of a lobe once serves all lights. Nothing is in their way.
#ifndef BN_AREA_T_H
#define BN_AREA_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/lights/environment.t.h"
#include "shading/lights/ltc_polygon.k.h"
#include "shading/lights/ltc_round.k.h"
#include "shading/lights/ltc_table.k.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

// Point k of a light, world space.
BN_FN real3 area_point(frame_ref f, int light, int k)
{
    return vec3_of(splat(the_area_light(f, light).points[3 * k]), splat(the_area_light(f, light).points[3 * k + 1]),
                   splat(the_area_light(f, light).points[3 * k + 2]));
}

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

// The part of a lobe that a light fills, [0,1].
BN_STAGE real area_part(BN_IN(area_view) v, BN_IN(ltc_lobe) lobe)
{
    if (v.shape == kArea_disk)
        return ltc_disk_light(lobe, v.at.corner[0], v.at.corner[1], v.at.corner[2]).part;
    if (v.shape == kArea_sphere)
        return ltc_sphere_light(lobe, v.at.corner[0], v.radius).part;
    if (v.shape == kArea_line)
        return ltc_line_light(lobe, v.at.corner[0], v.at.corner[1], v.radius).part;
    return ltc_polygon_light(lobe, v.at, v.corners).part;
}

// model: the lobe that lights meet; a round one is about the normal, as wide as the surface is rough. position: of x, world space. Lobes of
// other models are taken for GGX's of the same widths; those that only lamps meet have none of this light.
BN_FN real3 light_from_area(frame_ref f, BN_IN(shaded_point) x, int model, real3 position)
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
    real3 specular = vec3_all(lit(0.0));
    real3 diffuse = vec3_all(lit(0.0));
    for (int i = 0; i < the_frame(f).area_light_count; ++i) {
        mask faces = area_faces(f, i, position);
        if (no_lane(faces))
            continue;
        area_view view = area_seen_by(f, i, lobe, x.s.n, position);
        real3 radiance = select(faces, splat3(the_area_light(f, i).radiance), vec3_all(lit(0.0)));
        specular = specular + radiance * area_part(view, shiny);
        if (x.diffuse)
            diffuse = diffuse + radiance * area_part(view, dull);
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

BN_KERNELS_END

#endif
