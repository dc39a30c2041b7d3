// Parallax occlusion mapping (Tatarchuk 2006, "Practical parallax occlusion mapping"): moves a visible point's texture
// coordinates to where its ray meets the height map below the surface. The normal map's alpha holds heights: 1 at the
// surface, 0 at parallax_depth below it, in lengths of texture coordinates. All fetches use the derivatives of the original
// coordinates.
#ifndef BN_PARALLAX_T_H
#define BN_PARALLAX_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/texture_place.k.h"
#include "shading/kernels/visible_point.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/parallax.k.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Returns the depth below the surface, [0,1], as a fraction of parallax_depth.
BN_FN real depth_in_map(BN_IN(texture_one_level) map, real2 uv)
{
    real depth = lit(1.0) - texel_at_level(map, kNormalTex, uv).w;
    return depth;
}

// Returns where on its way through the height map, [0,1], a ray meets the heights. n_dot_v: [0,1], sets the number of
// steps. from, way: coordinates at the ray's start, and their change until its end.
BN_FN real parallax_hit(BN_IN(texture_one_level) map, real2 from, real2 way, real n_dot_v)
{
    // Choose the step
    real most = to_real(int_lit(kMostParallaxSteps));
    real fewer = to_real(int_lit(kMostParallaxSteps - kLeastParallaxSteps));
    real step = lit(1.0) / (most - fewer * n_dot_v);
    real met = lit(0.0);
    real reach = lit(0.0);              // position of rays still open; a fetch never waits for another fetch
    real gap = depth_in_map(map, from); // height of the ray above the map
    mask open = gap > lit(0.0);
    for (int i = 0; i <= kMostParallaxSteps; ++i) {
        if (no_lane(open))
            break;
        // Advance the ray and compare it with the map
        real further = reach + step;
        real next = min(further, lit(1.0));
        real2 at = from + way * next;
        real below = depth_in_map(map, at) - next;
        mask hit = both(open, below <= lit(0.0));
        // Interpolate the crossing linearly between two steps
        real closed = gap - below;
        real there = reach + (next - reach) * (gap / max(closed, lit(1e-12)));
        // Close the rays that hit
        met = select(open, select(hit, there, next), met);
        gap = select(open, below, gap);
        open = both(open, not_(hit));
        reach = next;
    }
    return met;
}

// Moves p's texture coordinates. m has a height map. p needs all members except colour and position.
BN_STAGE void apply_parallax(any_frame f, material_ref m, BN_IN(parallax_plane) plane, BN_INOUT(visible_point) p)
{
    // Build the geometric frame
    real3 v = k_normalize3(-p.ray);
    real3 normal = select(p.front, p.normal, -p.normal);
    real handedness = select(p.front, p.tangent_sign, -p.tangent_sign);
    surface_frame axes = geometric_frame(normal, p.tangent, handedness);
    // Find the texture offset at the full depth
    real n_dot_v = k_saturate(k_dot3(axes.n, v));
    real3 w = (axes.n * k_dot3(axes.n, v) - v) / max(n_dot_v, lit(0.1)) * splat(the_material(m).parallax_depth);
    real4 way = moved_in_texture(axes, w);
    if (the_frame(f).pom_metric == kParallaxOnSurface)
        way = moved_on_surface(plane, the_material(m).textures[kNormalTex].uv_set, w);
    // Choose the level and the ray's way through the map
    texture_place place = texture_place_of(the_material(m).textures[kNormalTex], p);
    visible_point bottom = p;
    bottom.uv0 = p.uv0 + vec2_of(way.x, way.y);
    bottom.uv1 = p.uv1 + vec2_of(way.z, way.w);
    texture_place last = texture_place_of(the_material(m).textures[kNormalTex], bottom);
    real2 through = last.uv - place.uv;
    texture_desc desc = texture_desc_of(f, m, kNormalTex);
    texture_one_level map = texture_one_level_of(desc, texture_footprint_of(desc, place.dx, place.dy, the_frame(f).texture_taps));
    // Move the coordinates to the crossing
    real met = parallax_hit(map, place.uv, through, n_dot_v);
    p.uv0 = p.uv0 + vec2_of(way.x, way.y) * met;
    p.uv1 = p.uv1 + vec2_of(way.z, way.w) * met;
}

BN_KERNELS_END

#endif
