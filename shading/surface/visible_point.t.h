// From a triangle's setup to a visible point: attributes interpolated at the shading position, and the derivatives that a
// GPU would compute. The derivatives are differences in the 2x2 quad, taken from the plane equations, so no helper lanes
// run.
#ifndef BN_VISIBLE_POINT_T_H
#define BN_VISIBLE_POINT_T_H

#include "shading/inputs/stage.h"
#include "shading/inputs/triangle.h"
#include "shading/kernels/camera.t.h"
#include "shading/kernels/interpolate.k.h"
#include "shading/kernels/visible_point.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/coverage.t.h"
#include "shading/surface/parallax.k.h"

BN_KERNELS_BEGIN

// Returns the interpolated normal, not unit.
BN_FN real3 blend_normal(frame_ref f, triangle_ref t, real3 b)
{
    vertex_words a;
    blend_vertices(f, t, b, false, a);
    return real3_of_words(a, 0);
}

// Returns true where the light of a material reads normal_dx and normal_dy.
BN_FN bool wants_bends(frame_ref f, material_ref m)
{
    return the_frame(f).specular_aa != 0 || (the_material(m).technique_traits & kSharesSamples) != 0;
}

struct corner_coordinates { // both coordinate sets at a triangle's vertices
    real4 of0, of1, of2;
};
BN_FN corner_coordinates coordinates_of(frame_ref f, triangle_ref t)
{
    corner_coordinates c;
    c.of0 = vertex_coordinates(f, t, 0);
    c.of1 = vertex_coordinates(f, t, 1);
    c.of2 = vertex_coordinates(f, t, 2);
    return c;
}
BN_FN real4 blend_corners(BN_IN(corner_coordinates) c, real3 b)
{
    real4 blend = b.x * c.of0 + b.y * c.of1 + b.z * c.of2;
    return blend;
}

// Makes the visible point. view: the frame's. px, py: pixel in the image. samples: mask of the samples that the triangle
// covers there. uses_color, textured, lights: requested values (shading/visible_point.def). bends: asks for normal_dx and
// normal_dy. The point lies at the pixel centre if the triangle covers the centre; else at the mean of the covered samples, which lies in
// the triangle.
BN_FN visible_point point_of(frame_ref f, BN_IN(view_params) view, triangle_ref t, integer px, integer py, integer samples, bool uses_color,
                             bool textured, bool lights, bool bends)
{
    // Find the weights at the pixel centre
    integer corner_x = shl(px, 8) - int_lit(the_frame(f).center_x);
    integer corner_y = shl(py, 8) - int_lit(the_frame(f).center_y);
    integer middle_x = corner_x + int_lit(kSubpixel / 2);
    integer middle_y = corner_y + int_lit(kSubpixel / 2);
    bary_weights center = weights_at(t, middle_x, middle_y);
    bary_weights w = center;
    real2 place = place_of_center(f, view, px, py);
    // Move to the mean of the covered samples where the centre is outside
    if (any_lane(not_(center.inside))) {
        sample_mean mean = mean_of_samples(f, samples);
        integer x = select(center.inside, middle_x, corner_x + mean.x);
        integer y = select(center.inside, middle_y, corner_y + mean.y);
        w = weights_at(t, x, y);
        // Find the point's place on the screen
        real across = to_real(x + int_lit(center_in_picture_x(f))) * lit(0.00390625);
        real down = to_real(y + int_lit(center_in_picture_y(f))) * lit(0.00390625);
        place = place_on_screen(f, view, across, down);
    }
    // Interpolate the attributes
    visible_point p;
    vertex_words a;
    blend_vertices(f, t, w.b, uses_color || textured, a);
    set_interpolants(a, uses_color, textured, p);
    p.front = (t.info & int_lit(kFrontFacing)) != int_lit(0);
    p.ray = ray_to(place, view);
    // Interpolate the position
    if (lights) {
        real3 v0 = vertex_place(f, t, 0);
        real3 v1 = vertex_place(f, t, 1);
        real3 v2 = vertex_place(f, t, 2);
        p.position = w.b.x * v0 + w.b.y * v1 + w.b.z * v2;
        if (t.clipped && the_frame(f).view.orthographic == 0) {
            // Cut-off corners may lie so far away that rounding in their blend exceeds the eye's distance, so use the ray.
            real3 along_ray = view.eye + p.ray * w.w;
            p.position = select(t.piece, along_ray, p.position);
        }
    }
    // Difference the normals, without steps between quads
    if (bends && the_frame(f).specular_aa == 0) {
        real3 normal = blend_normal(f, t, center.b);
        bary_weights right = weights_at(t, middle_x + int_lit(kSubpixel), middle_y);
        bary_weights below = weights_at(t, middle_x, middle_y + int_lit(kSubpixel));
        p.normal_dx = blend_normal(f, t, right.b) - normal;
        p.normal_dy = blend_normal(f, t, below.b) - normal;
        bends = false;
    }
    if (!textured && !bends)
        return p;
    // Find the weights at the quad's other pixels in x and y: right of or below an even pixel, left of or above an odd one
    integer odd_x = px & int_lit(1);
    integer odd_y = py & int_lit(1);
    bary_weights wx = weights_at(t, middle_x + int_lit(kSubpixel) - shl(odd_x, 9), middle_y);
    bary_weights wy = weights_at(t, middle_x, middle_y + int_lit(kSubpixel) - shl(odd_y, 9));
    // Difference the normals in the quad, as textures are
    if (bends) {
        real3 normal = blend_normal(f, t, center.b);
        p.normal_dx = (blend_normal(f, t, wx.b) - normal) * to_real(int_lit(1) - shl(odd_x, 1));
        p.normal_dy = (blend_normal(f, t, wy.b) - normal) * to_real(int_lit(1) - shl(odd_y, 1));
    }
    if (!textured)
        return p;
    // Difference the texture coordinates
    corner_coordinates corners = coordinates_of(f, t);
    real4 here = blend_corners(corners, center.b);
    real4 dx = (blend_corners(corners, wx.b) - here) * to_real(int_lit(1) - shl(odd_x, 1));
    real4 dy = (blend_corners(corners, wy.b) - here) * to_real(int_lit(1) - shl(odd_y, 1));
    // Split both coordinate sets
    p.uv0_dx = vec2_of(dx.x, dx.y);
    p.uv0_dy = vec2_of(dy.x, dy.y);
    p.uv1_dx = vec2_of(dx.z, dx.w);
    p.uv1_dy = vec2_of(dy.z, dy.w);
    return p;
}

// Returns the triangle's sides and coordinate changes for parallax occlusion mapping.
BN_FN parallax_plane parallax_plane_of(frame_ref f, triangle_ref t)
{
    // Take vertex 0 as the origin
    real3 corner = vertex_place(f, t, 0);
    corner_coordinates corners = coordinates_of(f, t);
    real4 coordinates = blend_corners(corners, vec3_of(lit(1.0), lit(0.0), lit(0.0)));
    parallax_plane p;
    // Subtract it from the other vertices
    p.along = vertex_place(f, t, 1) - corner;
    p.across = vertex_place(f, t, 2) - corner;
    p.coordinates_along = blend_corners(corners, vec3_of(lit(0.0), lit(1.0), lit(0.0))) - coordinates;
    p.coordinates_across = blend_corners(corners, vec3_of(lit(0.0), lit(0.0), lit(1.0))) - coordinates;
    return p;
}

BN_KERNELS_END

#endif
