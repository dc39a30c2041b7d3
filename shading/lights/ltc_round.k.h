// Discs, ellipses, spheres and lines as lights, through a transformed cosine. Centres and ends are in the ellipse frame,
// relative to the shading point.
#ifndef BN_LTC_ROUND_K_H
#define BN_LTC_ROUND_K_H
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/lights/ltc_polygon.k.h"
#include "shading/lights/ltc_table.k.h"

BN_KERNELS_BEGIN

// An ellipse in the cosine's space in its own axes, scaled so that its middle lies at distance 1 from the shading point, or
// nearer.
struct ltc_ellipse {
    real a, b;    // half axes
    real x, y, z; // the middle along the axes and the normal; >= 0 but for rounding
    real3 along_a, along_b, along_normal;
};

BN_FN ltc_ellipse ltc_ellipse_of(BN_IN(ltc_lobe) lobe, real3 middle, real3 axis_a, real3 axis_b)
{
    real3 c = ltc_to_cosine(lobe, middle);
    real3 p = ltc_to_cosine(lobe, axis_a);
    real3 q = ltc_to_cosine(lobe, axis_b);
    // Where the shading point is the middle, the axes give the scale.
    real largest2 = max(k_dot3(p, p), k_dot3(q, q));
    real scale2 = max(k_dot3(c, c), largest2 * lit(1e-12));
    real near_scale = lit(1.0) / sqrt(max(scale2, lit(1e-30)));
    c = c * near_scale;
    p = p * near_scale;
    q = q * near_scale;
    // The images of orthogonal half axes are not orthogonal. The longest radius is p cos t + q sin t with tan 2t = 2 p.q /
    // (p.p - q.q).
    real pp = k_dot3(p, p);
    real qq = k_dot3(q, q);
    real mixed = lit(2.0) * k_dot3(p, q);
    real difference = pp - qq;
    real root = sqrt(difference * difference + mixed * mixed);
    real larger2 = lit(0.5) * (pp + qq + root);
    mask p_longer = difference >= lit(0.0);
    real straight = abs(difference) + root;
    // cos t : sin t, without cancellation
    real2 turn = select(p_longer, vec2_of(straight, mixed), vec2_of(mixed, straight));
    turn = select(straight > lit(1e-30), turn, vec2_of(lit(1.0), lit(0.0)));
    turn = k_normalize2(turn / max(abs(turn.x), abs(turn.y)));
    ltc_ellipse e;
    e.along_a = k_normalize3(p * turn.x + q * turn.y);
    // Take the normal from the untransformed axes' product, as the images may be nearly parallel.
    real3 n = ltc_normal_to_cosine(lobe, k_cross(axis_a, axis_b)) * (near_scale * near_scale / lobe.det);
    real area = k_length3(n);
    e.along_normal = n * (lit(1.0) / max(area, lit(1e-30)));
    e.along_b = k_cross(e.along_normal, e.along_a);
    e.a = sqrt(larger2);
    e.b = area / max(e.a, lit(1e-15));
    e.x = k_dot3(c, e.along_a);
    e.y = k_dot3(c, e.along_b);
    e.z = k_dot3(c, e.along_normal);
    return e;
}

// Returns a flat ellipse's vector form factor: the axis of its cone, times the size of the cone with the same form factor.
// Let h be the half axes with h_3 = 0, c the middle, and m > 0 the root of sum(c_i^2 / (h_i^2 + m)) = 1. Then the cone's
// axis is (c_i / (h_i^2 + m)): the eigenvector of diag(h_i^2) - c c^T for the negative eigenvalue -m. The sum falls
// monotonically with m, and its terms share one sign, so nothing cancels.
BN_FN real3 ltc_disk_flow(BN_IN(ltc_lobe) lobe, real3 middle, real3 axis_a, real3 axis_b)
{
    ltc_ellipse e = ltc_ellipse_of(lobe, middle, axis_a, axis_b);
    real a2 = e.a * e.a;
    real b2 = e.b * e.b;
    real x2 = e.x * e.x;
    real y2 = e.y * e.y;
    real z2 = e.z * e.z;
    // Newton's method on m - m sum(m), which is convex. Start at the least of three bounds: all h as 0; the longest as
    // infinite against m; both as infinite.
    real left_a = lit(1.0) - x2 / max(a2, lit(1e-20));
    real left_b = left_a - y2 / max(b2, lit(1e-20));
    real bound_a = (y2 + z2) / max(left_a, lit(1e-6));
    real bound_b = z2 / max(left_b, lit(1e-6));
    real least = max(z2, lit(1e-20));
    real m = min(lit(1.0), select(left_a > lit(1e-6), bound_a, lit(1.0)));
    m = max(min(m, select(left_b > lit(1e-6), bound_b, lit(1.0))), least);
    for (int i = 0; i < 6; ++i) {
        real pa = lit(1.0) / (a2 + m);
        real pb = lit(1.0) / (b2 + m);
        real value = m - z2 - m * (x2 * pa + y2 * pb);
        real slope = lit(1.0) - x2 * a2 * pa * pa - y2 * b2 * pb * pb;
        real next = m - value / max(slope, lit(1e-6));
        m = min(max(next, least), lit(1.0));
    }
    // Form the cone's axis
    real pa = m / (a2 + m);
    real pb = m / (b2 + m);
    real3 axis = k_normalize3(e.along_a * (e.x * pa) + e.along_b * (e.y * pb) + e.along_normal * e.z);
    // With the other eigenvalues s, t >= 0: sqrt(s t / ((s + m) (t + m))), s t = (a b z)^2 / m, s + t = a^2 + b^2 - c.c +
    // m.
    real others = max(a2 + b2 - x2 - y2 - z2 + lit(2.0) * m, m);
    real ratio = e.a * e.b * abs(e.z) / (m * sqrt(others));
    real size = ratio / sqrt(lit(1.0) + ratio * ratio);
    return axis * size;
}

// Returns a disc's share of the lobe. axis_a, axis_b: half axes, orthogonal.
BN_FN ltc_light ltc_disk_light(BN_IN(ltc_lobe) lobe, real3 middle, real3 axis_a, real3 axis_b)
{
    ltc_light light;
    light.flow = ltc_disk_flow(lobe, middle, axis_a, axis_b);
    light.part = ltc_sphere_part(light.flow);
    return light;
}

struct ltc_outline {
    real3 middle, axis_a, axis_b; // of a disc; half axes, orthogonal
    mask outside;                 // the point is outside the sphere; inside, the disc covers nearly everything above the plane of `up`
};

// Returns the disc with a sphere's outline.
BN_FN ltc_outline ltc_sphere_outline(real3 middle, real radius, real3 up)
{
    ltc_outline o;
    real distance2 = k_dot3(middle, middle);
    real radius2 = radius * radius;
    real outside2 = distance2 - radius2;
    o.outside = outside2 > lit(0.0);
    // Find the direction to the sphere and the tangent of its radius
    real3 w = select(o.outside, k_normalize3(middle), up);
    real seen = select(o.outside, radius, lit(1e4));
    real tangent = seen / sqrt(select(o.outside, max(outside2, radius2 * lit(1e-8)), lit(1.0)));
    // Build axes across that direction: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
    real sign_z = select(w.z < lit(0.0), lit(-1.0), lit(1.0));
    real k = lit(-1.0) / (sign_z + w.z);
    real mixed = w.x * w.y * k;
    real3 s = vec3_of(lit(1.0) + sign_z * w.x * w.x * k, sign_z * mixed, -(sign_z * w.x));
    real3 t = vec3_of(mixed, sign_z + w.y * w.y * k, -w.y);
    o.middle = w;
    o.axis_a = s * tangent;
    o.axis_b = t * tangent;
    return o;
}

// Returns a sphere's share of the lobe. Inside the sphere, the whole lobe is lit.
BN_FN ltc_light ltc_sphere_light(BN_IN(ltc_lobe) lobe, real3 middle, real radius)
{
    ltc_outline o = ltc_sphere_outline(middle, radius, vec3_of(lit(0.0), lit(0.0), lit(1.0)));
    ltc_light seen = ltc_disk_light(lobe, o.middle, o.axis_a, o.axis_b);
    ltc_light light;
    light.part = select(o.outside, seen.part, lit(1.0));
    light.flow = select(o.outside, seen.flow, vec3_of(lit(0.0), lit(0.0), lit(1.0)));
    return light;
}

// Returns a tube's share of the lobe, from p to q, thin against its distance; the ends emit no light. Heitz, Hill 2017,
// "Linear-Light Shading with Linearly Transformed Cosines": the integral over a line in the cosine's space, times the width
// of a line with this radius there.
BN_FN ltc_light ltc_line_light(BN_IN(ltc_lobe) lobe, real3 p, real3 q, real radius)
{
    // Transform the ends to the cosine's space
    real3 size = max(abs(p), abs(q));
    real scale = lit(1.0) / max(max(max(size.x, size.y), size.z), lit(1e-15));
    real3 near_p = p * scale;
    real3 near_q = q * scale;
    real3 a = ltc_to_cosine(lobe, near_p);
    real3 b = ltc_to_cosine(lobe, near_q);
    // Clip at the horizon; ends on the horizon count as below.
    mask a_up = a.z > lit(0.0);
    mask b_up = b.z > lit(0.0);
    mask cuts = either(both(a_up, not_(b_up)), both(b_up, not_(a_up)));
    real height = a.z - b.z;
    real share = select(cuts, a.z, lit(0.0)) / select(cuts, height, lit(1.0));
    real3 cut = vec3_of(a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, lit(0.0));
    a = select(both(b_up, not_(a_up)), cut, a);
    b = select(both(a_up, not_(b_up)), cut, b);
    // Find the line's direction and its foot point
    real3 span = b - a;
    real extent = k_length3(span);
    real3 t = span * (lit(1.0) / max(extent, lit(1e-15)));
    real from = k_dot3(a, t);
    real to = from + extent;
    real3 foot = a - t * from;
    // Keep the distance to the line at 1e-4 of its extent or more: the line cannot point at the shading point.
    real d = max(max(k_length3(foot), extent * lit(1e-4)), lit(1e-15));
    // Integrate the clamped cosine along the line
    real3 up = foot * (lit(1.0) / d);
    real d2 = d * d;
    real a2 = d2 + from * from;
    real b2 = d2 + to * to;
    real over = extent / max(a2 * b2, lit(1e-30));
    real sine = d * extent;
    real angle = k_atan2(sine, d2 + from * to);
    real across = over * (d2 - from * to) + angle / d;
    real along = over * d * (from + to);
    real line = (across * up.z + along * t.z) * lit(0.31830988618379067);
    // A step along o, perpendicular to the line and the direction to it, grows by 1 / |M^T o|. A line that points here has
    // no o.
    real3 o = k_normalize3(k_cross(near_p, near_q));
    real narrow = k_length3(ltc_normal_to_cosine(lobe, o));
    mask seen = both(either(a_up, b_up), narrow > lit(1e-7));
    real part = select(seen, radius * scale, lit(0.0)) * line / max(narrow, lit(1e-7));
    ltc_light light;
    light.part = k_saturate(part);
    light.flow = (up * across + t * along) * (light.part / max(line, lit(1e-15)) * lit(0.31830988618379067));
    return light;
}

BN_KERNELS_END
#endif
