// BRDF major axis: environment light of an anisotropic lobe from a few prefiltered samples along the lobe's reflected major axis.
// Cocco, Zanni, Chermain 2024, "Anisotropic Specular Image-Based Lighting Based on BRDF Major Axis Sampling" (sec. 5, appendices A to D), in the
// forms that float32 survives. All of it happens in the ellipse frame: x along the greater slope deviation, y along the smaller, z
// the normal. A microfacet normal of slope s is normalize(s.x, s.y, 1) here, the sign being free as the lobe is symmetric.
#ifndef BN_MAJOR_AXIS_K_H
#define BN_MAJOR_AXIS_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct major_axis_ends {
    real t_near, t_far; // parameters of the slope ellipse closest to and farthest from the mirror direction, (-pi/2, pi/2]
};

struct major_axis_line {
    real3 e0, e1;   // microfacet normals at both ends, unit, ellipse frame
    real radius;    // r_s, alpha of the prefiltered level that a sample stands for
    real extent;    // L, distance of the reflected ends
    real width;     // Delta', distance of the reflected closest points
};

// Mirror of o about unit w; both point away from the surface.
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

// Appendix A without cancellation. o: to the eye, unit, o.z > 0; rx, ry: k times the slope deviations.
BN_FN major_axis_ends major_axis_extrema(real3 o, real rx, real ry)
{
    real one = lit(1.0);
    real bx = one + rx * rx;
    real by = one + ry * ry;
    real g0 = lit(2.0) * o.x * o.y * rx * ry;
    real g1 = (rx - ry) * (rx + ry) + o.x * o.x * ry * ry * bx - o.y * o.y * rx * rx * by;
    real cross_term = g0 * g0 * bx * by;
    real root = sqrt(g1 * g1 + cross_term);
    mask positive = g1 >= lit(0.0);
    real w = select(positive, g1 + root, root - g1);
    mask round_lobe = both(positive, w <= lit(1e-30)); // all directions are equally far: any axis will do
    real near_y = select(positive, w, -g0 * bx);
    real near_x = select(positive, -g0 * by, w);
    real far_y = select(positive, g0 * bx, w);
    real far_x = select(positive, w, g0 * by);
    major_axis_ends r;
    r.t_near = fold_half_turn(k_atan2(select(round_lobe, lit(0.0), near_y), select(round_lobe, one, near_x)));
    r.t_far = fold_half_turn(k_atan2(select(round_lobe, one, far_y), select(round_lobe, lit(0.0), far_x)));
    return r;
}

BN_FN real3 ellipse_normal(real c, real s, real rx, real ry)
{
    return k_normalize3(vec3_of(rx * c, ry * s, lit(1.0)));
}

// o: to the eye in the ellipse frame, unit; sigma_x, sigma_y: slope deviations; k: how many deviations the line covers; beta: how
// densely samples overlap; inv_count: 1 / number of samples.
BN_FN major_axis_line major_axis_setup(real3 o, real sigma_x, real sigma_y, real k, real beta, real inv_count)
{
    real one = lit(1.0);
    real zero = lit(0.0);
    o.z = max(o.z, lit(1e-4));
    o = k_normalize3(o);
    real rx = k * sigma_x;
    real ry = k * sigma_y;
    major_axis_ends t = major_axis_extrema(o, rx, ry);

    // the farthest points, moved inwards until their reflections leave the surface (appendix B, in slopes)
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

    // the width of the lobe, at the closest points shifted with the clamped ends (appendix C; both ends may be clamped)
    real tau0 = (one - a) * lit(0.5);
    real tau1 = (one + b) * lit(0.5);
    real delta = (tau0 + tau1 - one) * (t.t_near - t.t_far);
    k_sin_cos_pair near0 = k_sin_cos(t.t_near + delta);
    k_sin_cos_pair near1 = k_sin_cos(t.t_near - delta);
    real3 m0 = ellipse_normal(-near0.cosine, -near0.sine, rx, ry);
    real3 m1 = ellipse_normal(near1.cosine, near1.sine, rx, ry);

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

// Direction of the sample at s in [0,1] along the line, in the space of e0, e1 and o; not unit. The mirror of o about
// e0 + s (e1 - e0), scaled by the square of its length: no division.
BN_FN real3 major_axis_direction(real3 e0, real3 step, real3 o, real s)
{
    real3 w = e0 + step * s;
    real along = lit(2.0) * k_dot3(w, o);
    return w * along - o * k_dot3(w, w);
}

struct adaptive_count {
    real count;  // fractional number of samples, [1, limit]
    real radius; // r_s at that count
};

// As many samples as make their own size, the width of the lobe, fit the line's length: beta L / Delta'. limit: uniform, at least 1.
BN_FN adaptive_count major_axis_needed(major_axis_line line, real k, real beta, real limit)
{
    real wanted = beta * line.extent * max(k, lit(1e-6)) / max(line.width, lit(1e-20));
    adaptive_count r;
    r.count = min(max(wanted, lit(1.0)), limit);
    real by_spacing = beta * line.extent * lit(0.5) / r.count;
    real by_width = line.width * lit(0.5) / max(k, lit(1e-6));
    r.radius = max(by_width, by_spacing);
    return r;
}

struct adaptive_pair {
    real offset; // of both samples from the middle of the line, [0, 1/2]
    real weight; // [0,1], relative to the sample in the middle
};

// The i-th pair around the middle, i = 1, 2...: absent up to a count of 2i - 1, whole from 2i + 1 on.
BN_FN adaptive_pair major_axis_pair(adaptive_count need, int i)
{
    real index = to_real(int_lit(i));
    adaptive_pair r;
    r.offset = min(index / max(need.count - lit(1.0), lit(1e-6)), lit(0.5));
    real whole = (need.count - index * lit(2.0) + lit(1.0)) * lit(0.5);
    r.weight = min(max(whole, lit(0.0)), lit(1.0));
    return r;
}

// Relative density of slopes, GGX with the deviations of a Gaussian of sigma_x, sigma_y (alpha = sqrt(2) sigma), at the microfacet
// normal w (any length, ellipse frame).
BN_FN real major_axis_density(real3 w, real sigma_x, real sigma_y)
{
    real least = lit(1e-6);
    real z = max(w.z, least);
    real x = w.x / (z * max(sigma_x, least));
    real y = w.y / (z * max(sigma_y, least));
    real t = lit(1.0) + (x * x + y * y) * lit(0.5);
    return lit(1.0) / (t * t);
}

BN_KERNELS_END

#endif
