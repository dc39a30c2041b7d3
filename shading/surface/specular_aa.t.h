// Specular antialiasing: widens a lobe by the variation of shading normals between neighbouring pixels. A glint between two
// samples then shows in both, dimmer. Tokuyoshi and Kaplanyan 2019, "Improved geometric specular antialiasing": adds the
// covariance of slopes within a pixel to the lobe's, within a bound. Two choices differ. The paper differentiates half
// vectors; here normals are, as in Kaplanyan et al. 2016, because normals need no lights. The paper's pixel filter is a
// Gaussian with variance 1 / (2 pi); here it is the resolve's box, variance 1 / 12.
#ifndef BN_SPECULAR_AA_T_H
#define BN_SPECULAR_AA_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/make_shaded_point.t.h"

BN_KERNELS_BEGIN

// Returns the shading normal one pixel away: moves p's normal and texture coordinates by their change per pixel.
BN_FN real3 normal_beside(frame_ref f, material_ref m, BN_IN(material_inputs) at, visible_point p, real3 normal_step, real2 uv0_step,
                          real2 uv1_step)
{
    p.normal = p.normal + normal_step;
    material_inputs there = at;
    if (texture_used(m, kNormalTex)) {
        p.uv0 = p.uv0 + uv0_step;
        p.uv1 = p.uv1 + uv1_step;
        there.normal_map = normal_of_texel(m, texel_beside(f, m, kNormalTex, p));
    }
    surface_frame axes = lobe_axes(f, m, there, facing_geometric_axes(p), facing_handedness(p));
    return axes.n;
}

// Returns the covariance of slopes along t and b within the pixel.
BN_STAGE slope_covariance covariance_of_pixel(any_frame f, material_ref m, BN_IN(material_inputs) at, BN_IN(visible_point) p)
{
    // Difference the shading normals of neighbouring pixels
    surface_frame here = lobe_axes(f, m, at, facing_geometric_axes(p), facing_handedness(p));
    real3 dx = normal_beside(f, m, at, p, p.normal_dx, p.uv0_dx, p.uv1_dx) - here.n;
    real3 dy = normal_beside(f, m, at, p, p.normal_dy, p.uv0_dy, p.uv1_dy) - here.n;
    // Project them as slopes
    real2 x = vec2_of(k_dot3(here.t, dx), k_dot3(here.b, dx));
    real2 y = vec2_of(k_dot3(here.t, dy), k_dot3(here.b, dy));
    real filter2 = lit(0.083333333333333333); // variance of a square pixel
    slope_covariance r;
    r.xx = filter2 * (x.x * x.x + y.x * y.x);
    r.yy = filter2 * (x.y * x.y + y.y * y.y);
    r.xy = filter2 * (x.x * x.y + y.x * y.y);
    // Bound the covariance's trace
    real trace = r.xx + r.yy;
    real most = lit(0.09); // half of the paper's kappa, which bounds the growth of alpha^2 = 2 sigma^2
    real part = min(most / max(trace, lit(1e-12)), lit(1.0));
    mask known = trace >= lit(0.0); // NaN where a neighbour lies behind the eye
    r.xx = select(known, r.xx * part, lit(0.0));
    r.yy = select(known, r.yy * part, lit(0.0));
    r.xy = select(known, r.xy * part, lit(0.0));
    return r;
}

// Returns the widened lobe. A round lobe stays round.
BN_STAGE lobe_shape grown_shape(any_frame f, material_ref m, BN_IN(material_inputs) at, BN_IN(visible_point) p)
{
    lobe_shape shape = lobe_shape_of(f, m, at);
    slope_covariance more = covariance_of_pixel(f, m, at, p);
    real u2 = shape.sigma_u * shape.sigma_u;
    real v2 = shape.sigma_v * shape.sigma_v;
    // Widen a round lobe by the mean variance
    if (the_material(m).anisotropic == 0) {
        slope_axes round;
        round.sigma_u = sqrt(u2 + lit(0.5) * (more.xx + more.yy));
        round.sigma_v = round.sigma_u;
        round.u = shape.u;
        return shape_of_axes(round);
    }
    // Add the covariances
    slope_covariance own;
    own.xx = u2 * shape.u.x * shape.u.x + v2 * shape.u.y * shape.u.y;
    own.yy = u2 * shape.u.y * shape.u.y + v2 * shape.u.x * shape.u.x;
    own.xy = (u2 - v2) * shape.u.x * shape.u.y;
    return shape_of_axes(axes_of_covariance(sum_of_covariances(own, more)));
}

// Returns the lobe that the frame draws at a point.
BN_FN lobe_shape lobe_shape_at(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_IN(visible_point) p)
{
    if (the_frame(f).specular_aa != 0)
        return grown_shape(f, m, at, p);
    return lobe_shape_of(f, m, at);
}

BN_KERNELS_END

#endif
