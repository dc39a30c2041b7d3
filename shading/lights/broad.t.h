// Light of a coating whose lobe is broad and leans away from the mirror direction (kBroadLobe). One fetch or one cosine
// about the lobe's mean direction stands for it. charlie.k.h has the fit, so the trait is that lobe's alone.
#ifndef BN_BROAD_T_H
#define BN_BROAD_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/lights/area.t.h"
#include "shading/models/charlie.k.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

struct broad_lobe {
    real3 direction; // mean direction of the light that the lobe reflects, unit, world space
    real roughness;  // of the round GGX lobe that is as wide
};

BN_FN broad_lobe broad_lobe_of(BN_IN(shaded_point) x)
{
    broad_lobe r;
    // Find the mean direction
    charlie_mean mean = charlie_mean_of(x.s.n_dot_v, x.s.roughness);
    real3 side = x.s.v - x.s.n * k_dot3(x.s.n, x.s.v);
    real3 whole = x.s.n * max(mean.up, lit(0.05)) + side * mean.along;
    real length = k_length3(whole);
    r.direction = k_normalize3(whole);
    // Find the prefiltered lobe whose mean direction is as long: at roughness 1 the length is 2/3
    r.roughness = min(max(lit(1.0) - lit(2.8) * (length - lit(0.66666667)), lit(0.3)), lit(1.0));
    return r;
}

// Returns the environment's light over the lobe, as techniques do.
BN_FN real3 broad_specular(frame_ref f, BN_IN(shaded_point) x)
{
    broad_lobe lobe = broad_lobe_of(x);
    cube_desc cube = prefiltered_env(f);
    return cube_sample(cube, lobe.direction, lobe.roughness * to_real(int_lit(cube.levels - 1))) * x.energy.albedo;
}

// Returns reflected light from all area lights, by a cosine about the lobe's mean direction, clipped at the surface.
BN_FN real3 broad_light_of_areas(frame_ref f, BN_IN(shaded_point) x, real3 position)
{
    broad_lobe lobe = broad_lobe_of(x);
    ltc_lobe dull = ltc_cosine();
    // Make axes about the mean direction, and find the surface's horizon in them, with the cosine's share above it
    area_axes across = area_axes_of(lobe.direction);
    aniso_lobe axes;
    axes.u_axis = across.u;
    axes.v_axis = across.v;
    axes.sigma_u = lit(1.0);
    axes.sigma_v = lit(1.0);
    real3 up = to_lobe(axes, lobe.direction, x.s.n);
    if (x.has_surface_horizon)
        up = to_lobe(axes, lobe.direction, x.geometric_axes.n);
    real above = max(lit(0.5) + lit(0.5) * up.z, lit(0.1));
    // Visit the lights that face the point
    real3 sum = vec3_all(lit(0.0));
    for (int i = 0; i < the_frame(f).area_light_count; ++i) {
        mask faces = area_faces(f, i, position);
        if (no_lane(faces))
            continue;
        // View the light, with its sides where it has a picture
        area_view view = area_seen_by(f, i, axes, lobe.direction, position);
        bool pictured = the_area_light(f, i).picture >= 0;
        real3 corner = view.at.corner[0];
        real3 side_u = corner;
        real3 side_v = corner;
        if (pictured) {
            side_u = view.at.corner[1] - corner;
            side_v = view.at.corner[3] - corner;
        }
        // Clip it at the surface, and find its share
        view = area_above(view, up);
        ltc_light seen = area_part(view, dull, false);
        real3 radiance = splat3(the_area_light(f, i).radiance);
        if (pictured)
            radiance = area_radiance_through(f, i, dull, seen.flow, corner, side_u, side_v);
        sum = sum + select(faces, radiance, vec3_all(lit(0.0))) * seen.part;
    }
    return sum * x.energy.albedo / above;
}

BN_KERNELS_END

#endif
