// BRDF major axis: environment light of an anisotropic lobe from a few prefiltered samples along the lobe's reflected major
// axis. Cocco, Zanni, Chermain 2024, "Anisotropic Specular Image-Based Lighting Based on BRDF Major Axis Sampling" (sec. 5,
// appendices A to D), in forms that suit float32. All vectors are in the ellipse frame: x along the greater slope
// deviation, y along the smaller, z the normal. A microfacet normal with slope s is normalize(s.x, s.y, 1); the sign is
// free, as the lobe is symmetric.
#ifndef BN_MAJOR_AXIS_K_H
#define BN_MAJOR_AXIS_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct major_axis_ends {
    real t_near, t_far; // parameters of the slope ellipse nearest to and farthest from the mirror direction, (-pi/2, pi/2]
};

struct major_axis_line {
    real3 e0, e1; // microfacet normals at both ends, unit, ellipse frame
    real radius;  // r_s, alpha of each sample's prefiltered level
    real extent;  // L, distance between the reflected ends
    real width;   // Delta', distance between the reflected nearest points
};

// Mirrors o about unit w; both point away from the surface.
BN_FN real3 reflect_about(real3 w, real3 o)
{
    return w * (lit(2.0) * k_dot3(w, o)) - o;
}

BN_FN real fold_half_turn(real t)
{
    real pi = lit(3.14159265358979);
    t = select(t > lit(1.57079632679490), t - pi, t);
    return select(t <= lit(-1.57079632679490), t + pi, t);
}

struct major_axis_points { // points of the unit circle that the slope ellipse stretches; any length
    real2 near_point, far_point;
};

// Finds the nearest and farthest points (appendix A) without cancellation and angles. o: to the eye, unit, o.z > 0; rx, ry:
// k times the slope deviations.
BN_FN major_axis_points major_axis_extreme_points(real3 o, real rx, real ry)
{
    real one = lit(1.0);
    real zero = lit(0.0);
    real bx = one + rx * rx;
    real by = one + ry * ry;
    real g0 = lit(2.0) * o.x * o.y * rx * ry;
    real g1 = (rx - ry) * (rx + ry) + o.x * o.x * ry * ry * bx - o.y * o.y * rx * rx * by;
    real cross_term = g0 * g0 * bx * by;
    real root = sqrt(g1 * g1 + cross_term);
    mask positive = g1 >= zero;
    real w = select(positive, g1 + root, root - g1);
    mask round_lobe = both(positive, w <= lit(1e-30)); // all directions are equally far: any axis will do
    real near_x = select(positive, -g0 * by, w);
    real near_y = select(positive, w, -g0 * bx);
    real far_x = select(positive, w, g0 * by);
    real far_y = select(positive, g0 * bx, w);
    major_axis_points r;
    r.near_point = select(round_lobe, vec2_of(one, zero), vec2_of(near_x, near_y));
    r.far_point = select(round_lobe, vec2_of(zero, one), vec2_of(far_x, far_y));
    return r;
}

// Returns the angles of the nearest and the farthest point.
BN_FN major_axis_ends major_axis_extrema(real3 o, real rx, real ry)
{
    major_axis_points p = major_axis_extreme_points(o, rx, ry);
    major_axis_ends r;
    r.t_near = fold_half_turn(k_atan2(p.near_point.y, p.near_point.x));
    r.t_far = fold_half_turn(k_atan2(p.far_point.y, p.far_point.x));
    return r;
}

// Returns cosine and sine of t_far.
BN_FN real2 major_axis_far_direction(real3 o, real rx, real ry)
{
    real2 far_point = major_axis_extreme_points(o, rx, ry).far_point;
    real scale = lit(1.0) / max(max(abs(far_point.x), abs(far_point.y)), lit(1e-30));
    return k_normalize2(far_point * scale);
}

BN_FN real3 ellipse_normal(real c, real s, real rx, real ry)
{
    return k_normalize3(vec3_of(rx * c, ry * s, lit(1.0)));
}

// Sets up the line. o: to the eye in the ellipse frame, unit; sigma_x, sigma_y: slope deviations; k: number of deviations
// along the line; beta: overlap of samples; inv_count: 1 / number of samples.
BN_FN major_axis_line major_axis_setup(real3 o, real sigma_x, real sigma_y, real k, real beta, real inv_count)
{
    real one = lit(1.0);
    real zero = lit(0.0);
    o.z = max(o.z, lit(1e-4));
    o = k_normalize3(o);
    real rx = k * sigma_x;
    real ry = k * sigma_y;
    major_axis_ends t = major_axis_extrema(o, rx, ry);

    // Move the farthest points inwards until their reflections leave the surface (appendix B, in slopes)
    k_sin_cos_pair farthest = k_sin_cos(t.t_far);
    real x = rx * farthest.cosine;
    real y = ry * farthest.sine;
    real rho2 = x * x + y * y;
    real q = x * o.x + y * o.y;
    real under = q * q + o.z * o.z * rho2;
    real big_q = abs(q) + sqrt(under);
    real huge = lit(1e30);
    real denominator = o.z * rho2;
    real u_small = select(big_q > zero, o.z / select(big_q > zero, big_q, one), huge);
    real u_big = select(denominator > zero, big_q / select(denominator > zero, denominator, one), huge);
    mask forward = q >= zero;
    real a = min(select(forward, u_small, u_big), one);
    real b = min(select(forward, u_big, u_small), one);
    real3 end0 = k_normalize3(vec3_of(-a * x, -a * y, one));
    real3 end1 = k_normalize3(vec3_of(b * x, b * y, one));

    // Measure the lobe's width at the nearest points, shifted with the clamped ends (appendix C; both ends may be clamped)
    real tau0 = (one - a) * lit(0.5);
    real tau1 = (one + b) * lit(0.5);
    real delta = (tau0 + tau1 - one) * (t.t_near - t.t_far);
    k_sin_cos_pair near0 = k_sin_cos(t.t_near + delta);
    k_sin_cos_pair near1 = k_sin_cos(t.t_near - delta);
    real3 m0 = ellipse_normal(-near0.cosine, -near0.sine, rx, ry);
    real3 m1 = ellipse_normal(near1.cosine, near1.sine, rx, ry);

    // Shorten the line by the width, and choose the level's radius
    major_axis_line r;
    r.width = k_length3(reflect_about(m0, o) - reflect_about(m1, o));
    r.extent = k_length3(reflect_about(end0, o) - reflect_about(end1, o));
    real some = select(r.extent > zero, r.extent, one);
    real zeta = select(r.extent > zero, min(max(one - r.width / some, zero), one), zero); // appendix D: leave half a width
    real3 centre = k_normalize3(end0 + end1);
    r.e0 = k_normalize3(centre + (end0 - centre) * zeta);
    r.e1 = k_normalize3(centre + (end1 - centre) * zeta);
    real by_width = r.width / (lit(2.0) * max(k, lit(1e-6)));
    real by_spacing = beta * r.extent * inv_count * lit(0.5);
    r.radius = max(by_width, by_spacing);
    return r;
}

// Sample directions. The mirror of o about w = e0 + s (e1 - e0), times w's squared length, is a parabola in s, without a
// division.
struct major_axis_curve {
    real3 at_start, linear, quadratic;
};

// Makes the parabola, in the space of e0, e1 and o. step: e1 - e0.
BN_FN major_axis_curve major_axis_curve_of(real3 e0, real3 step, real3 o)
{
    real two = lit(2.0);
    real start_o = two * k_dot3(e0, o);
    real step_o = two * k_dot3(step, o);
    major_axis_curve k;
    k.at_start = e0 * start_o - o * k_dot3(e0, e0);
    k.linear = step * start_o + e0 * step_o - o * (two * k_dot3(e0, step));
    k.quadratic = step * step_o - o * k_dot3(step, step);
    return k;
}

// Returns the sample's direction at s in [0,1]; not unit.
BN_FN real3 major_axis_direction(major_axis_curve k, real s)
{
    return k.at_start + (k.linear + k.quadratic * s) * s;
}

// The lobe along its major axis, for samples placed and weighted by density. On the line through the ellipse's middle, GGX
// slopes have the marginal density (1 + x^2)^(-3/2) / 2, x in widths. So x = c / sqrt(1 - c^2) with c uniform in (-1,1).
// The microfacet normal at c is (along c, sqrt(1 - c^2)), and no tail is cut off.
struct major_axis_grain {
    real3 o;        // to the eye, unit, ellipse frame
    real2 along;    // the major axis, with the length that samples must cover
    real own;       // the lobe's own width along it, as the eye sees it
    real width;     // the lobe's width across, as seen along the axis
    real o_along;   // length of o in the plane of axis and normal, [0,1]
    real o_across2; // squared length of o across that plane
    real alpha_x, alpha_y;
};

// Returns the lobe's width across the axis at its middle, as the eye sees it.
BN_FN real major_axis_grain_across(major_axis_grain g)
{
    return g.width * sqrt(g.o_across2 + g.o.z * g.o.z);
}

// Makes the lobe. o: to the eye, ellipse frame; sigma_x, sigma_y: slope deviations; k: factor on the width along the axis,
// 1 for the lobe's own.
BN_FN major_axis_grain major_axis_grain_of(real3 o, real sigma_x, real sigma_y, real k)
{
    real root2 = lit(1.4142135623730951);
    major_axis_grain g;
    o.z = max(o.z, lit(1e-4));
    g.o = k_normalize3(o);
    g.alpha_x = sigma_x * root2;
    g.alpha_y = sigma_y * root2;
    // Find the major axis and the lobe's widths
    real2 t = major_axis_far_direction(g.o, sigma_x, sigma_y);
    real x = g.alpha_x * t.x;
    real y = g.alpha_y * t.y;
    real length = sqrt(x * x + y * y);
    real inv = lit(1.0) / max(length, lit(1e-20));
    g.width = g.alpha_x * g.alpha_y * inv;
    real across = (g.o.y * x - g.o.x * y) * inv;
    g.o_across2 = across * across;
    g.o_along = sqrt(max(lit(1.0) - g.o_across2, lit(0.0)));
    // A prefiltered sample spreads along the axis as far as across, so the line covers the rest, nothing for a round lobe
    g.own = length * g.o_along;
    real ratio = major_axis_grain_across(g) / max(g.own, lit(1e-20));
    real rest = k * sqrt(max(lit(1.0) - ratio * ratio, lit(0.0)));
    g.along = vec2_of(x * rest, y * rest);
    return g;
}

struct grain_sample {
    real3 direction; // not unit, ellipse frame
    real weight;     // at least 0
    real radius;     // alpha of the prefiltered level
};

// Makes a sample. c: uniform in (-1,1), root = sqrt(1 - c^2); spacing: beta times the step of c between samples. At beta =
// 2.3 a level is 0.76 times as wide as the step between half vectors; narrower levels show as ghosts.
BN_FN grain_sample major_axis_grain_sample(major_axis_grain g, real c, real root, real spacing)
{
    real3 w = vec3_of(g.along.x * c, g.along.y * c, root);
    real w2 = k_dot3(w, w);
    real w_dot_o = k_dot3(w, g.o);
    grain_sample r;
    r.direction = w * (lit(2.0) * w_dot_o) - g.o * w2;
    // Weight by the microfacets' visible area and by Smith's masking of the light
    real3 i = r.direction;
    real ix = g.alpha_x * i.x;
    real iy = g.alpha_y * i.y;
    real stretch = sqrt(ix * ix + iy * iy + i.z * i.z);
    real up = max(i.z, lit(0.0));
    r.weight = max(w_dot_o, lit(0.0)) / root * (up / max(up + stretch, lit(1e-20)));
    // Turning w about the axis moves its mirror by 2 sqrt(o_across^2 + (w.o)^2) across; turning it along moves the mirror
    // by 2 o_along
    real inv2 = lit(1.0) / w2;
    real turn = g.o_across2 + w_dot_o * w_dot_o * inv2;
    real across = g.width * sqrt(turn * inv2);
    real step = k_dot2(g.along, g.along);
    real along = sqrt(step) * g.o_along * inv2 / root * spacing * lit(0.33);
    r.radius = max(across, min(along, g.own)); // no sample covers more than the lobe
    return r;
}

// Returns the number of samples that a lobe of this shape needs, a real in [1, limit]: its length over its width, as the
// eye sees them. beta: overlap, 2.3.
BN_FN real major_axis_grain_count(major_axis_grain g, real beta, real limit)
{
    real length = sqrt(k_dot2(g.along, g.along)) * g.o_along;
    real across = major_axis_grain_across(g);
    real count = beta * lit(0.43) * length / max(across, lit(1e-6));
    return min(max(count, lit(1.0)), limit);
}

// Returns true where the count above may exceed the count of the line from Cocco, Zanni, Chermain 2024 (sec. 5): wide lobes
// (roughness above 0.5), grazing views, k other than 1.
BN_FN mask major_axis_count_unsure(major_axis_grain g, real k)
{
    mask wide = g.alpha_x + g.alpha_y > lit(0.5);
    mask other_k = not_(k == lit(1.0));
    return either(either(wide, g.o.z < lit(0.1)), other_k);
}

// Limits the count there to beta L / Delta' of that line. Whole and partial cells add up to it.
BN_FN real major_axis_limited_count(major_axis_grain g, real sigma_x, real sigma_y, real k, real beta, real count)
{
    major_axis_line line = major_axis_setup(g.o, sigma_x, sigma_y, k, beta, lit(1.0));
    real asked = max(beta * line.extent / max(line.width, lit(1e-6)), lit(1.0));
    return select(major_axis_count_unsure(g, k), min(count, asked), count);
}

struct grain_cell {
    real c;      // middle of the cell
    real weight; // its size relative to a whole cell, [0,1]
};

// Returns cell i of the line, i = 1, 2..., on the positive side. The line is cut into `count` cells of equal size, from its
// middle outwards. The line's end shortens the last cell and moves its middle, so samples appear and vanish without a step
// where the count changes.
BN_FN grain_cell major_axis_grain_cell(real count, int i)
{
    real size = lit(2.0) / count;
    real near_end = (to_real(int_lit(i)) - lit(0.5)) * size;
    real left = min(max(lit(1.0) - near_end, lit(0.0)), size);
    grain_cell r;
    r.weight = left / size;
    r.c = min(near_end + left * lit(0.5), lit(1.0)) * lit(0.95); // beyond this, a nearly empty cell would weigh too much
    return r;
}

BN_KERNELS_END

#endif
