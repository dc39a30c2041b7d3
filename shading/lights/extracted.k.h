// The share of a GGX lobe that an evenly bright ellipse on the sky fills. A normal with slopes s mirrors the eye to one
// direction, so the light is an ellipse among slopes, too. Divided by the lobe's widths, slopes have the density 1 / (pi (1
// + |s|^2)^2).
//
// That density is uniform on a sphere under stereographic projection. A disc of radius R with its centre at distance d is a
// spherical cap. The cap's share of the sphere is exactly (1 - A / sqrt(A^2 + 4 R^2)) / 2 with A = 1 + d^2 - R^2: a point's
// share for small R, a sharp disc for large R. An ellipse with half axes R1 > R2 uses one of two methods.
// - Round ellipses: widen the lobe by the ellipse, to squared widths 1 + R1^2 and 1 + R2^2. In it take a disc with R^2 = K
//   = 2 R1^2 R2^2 / (R1^2 + R2^2), so that the edge is sharp where both axes are long. Exact for discs and points.
// - Long ellipses, such as the sun in a lobe that is much narrower across than along: take a needle along the long axis in
//   the lobe widened by R2 alone. The needle holds as much light along it as the ellipse. With x along and y across the
//   needle, B^2 = 1 + y^2, A = B^2 + x^2 - R1^2 and b = sqrt(A^2 + 4 R1^2 B^2), the integral of the density under a
//   semicircle (its Hilbert transform, differentiated by B) is 2 R1 R2 sqrt(1 + 2 R1^2 / (b + A)) / (b (b + A)). Exact for
//   R2 = 0.
// Both are exact at the ellipse's centre. One blends into the other between 1 : 3 and 2 : 3. Errors are largest at sharp
// edges, where R1 > 1.
#ifndef BN_EXTRACTED_K_H
#define BN_EXTRACTED_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// An ellipse among slopes, in units of the lobe's widths.
struct slope_ellipse {
    real2 centre;
    real xx, yy, xy; // u u' + v v' of its half axes u and v
    real area;       // |u x v|: area over pi
    real beside;     // |u x centre|^2 + |v x centre|^2
};

// Makes an ellipse. u, v: half axes, or any two conjugate radii. part: share of the area to keep about its centre, (0,1].
BN_FN slope_ellipse slope_ellipse_of(real2 centre, real2 u, real2 v, real part)
{
    slope_ellipse r;
    r.centre = centre;
    r.xx = (u.x * u.x + v.x * v.x) * part;
    r.yy = (u.y * u.y + v.y * v.y) * part;
    r.xy = (u.x * u.y + v.x * v.y) * part;
    r.area = abs(u.x * v.y - u.y * v.x) * part;
    real of_u = u.x * centre.y - u.y * centre.x;
    real of_v = v.x * centre.y - v.y * centre.x;
    r.beside = (of_u * of_u + of_v * of_v) * part;
    return r;
}

// Returns a round ellipse's share of the lobe, [0,1].
BN_FN real ggx_share_of_disc(slope_ellipse e)
{
    real one = lit(1.0);
    real area2 = e.area * e.area;
    real trace = e.xx + e.yy;
    real widened = one + trace + area2; // product of the squared widths
    real k = lit(2.0) * area2 / max(trace, lit(1e-20));
    real q = (k_dot2(e.centre, e.centre) + e.beside) / widened;
    real a = one - k + (one + k) * q;
    real b = sqrt(a * a + lit(4.0) * k);
    real sum = max(a + b, lit(1e-6));
    real share = lit(2.0) * e.area * (one + k) / (sqrt(widened) * b * sum);
    return share;
}

// An ellipse in its own axes.
struct slope_needle {
    real along2, across2; // squared half axes, along2 >= across2
    real x2, y2;          // squared centre coordinates along and across
};

BN_FN slope_needle slope_needle_of(slope_ellipse e)
{
    real h = lit(0.5) * (e.xx - e.yy);
    real root = sqrt(h * h + e.xy * e.xy);
    slope_needle r;
    r.along2 = lit(0.5) * (e.xx + e.yy) + root;
    r.across2 = e.area * e.area / max(r.along2, lit(1e-20));
    // Take the eigenvector of along2 from the row that keeps its digits
    mask wide = h >= lit(0.0);
    real x = select(wide, root + h, e.xy);
    real y = select(wide, e.xy, root - h);
    real inv = lit(1.0) / max(x * x + y * y, lit(1e-30));
    real along = e.centre.x * x + e.centre.y * y;
    real across = e.centre.y * x - e.centre.x * y;
    r.x2 = along * along * inv;
    r.y2 = across * across * inv;
    return r;
}

// Returns a needle's share of the lobe. area: the ellipse's, over pi.
BN_FN real ggx_share_of_needle(slope_needle e, real area)
{
    real one = lit(1.0);
    real narrowed = one / (one + e.across2);
    real b2 = one + e.y2 * narrowed;
    real a = b2 + e.x2 - e.along2;
    real b = sqrt(a * a + lit(4.0) * e.along2 * b2);
    real sum = max(a + b, lit(1e-6));
    real share = lit(2.0) * area * sqrt((one + lit(2.0) * e.along2 / sum) * narrowed) / (b * sum);
    return share;
}

// Returns an upper bound of the share: the ellipse's area times the density at its nearest point to the lobe's centre.
BN_FN real ggx_most_of_ellipse(slope_ellipse e)
{
    real one = lit(1.0);
    real c2 = k_dot2(e.centre, e.centre);
    real reach = sqrt(max((e.xx + e.yy) * c2 - e.beside, lit(0.0))); // reach towards the lobe's centre, times the distance
    real rest = max(c2 - reach, lit(0.0));
    real near2 = one + rest * rest / max(c2, lit(1e-20));
    real most = e.area / (near2 * near2);
    return most;
}

// Returns an ellipse's share of the lobe, [0,1].
BN_FN real ggx_share_of_ellipse(slope_ellipse e)
{
    real disc = ggx_share_of_disc(e);
    mask small = e.xx + e.yy <= lit(0.01);
    if (no_lane(not_(small)))
        return disc;
    // Blend to the needle where the ellipse is long, thin and soft
    slope_needle n = slope_needle_of(e);
    real longer = k_saturate((n.along2 - lit(0.01)) * lit(30.0));
    real thin = k_saturate(lit(1.3333333333333333) - lit(3.0) * n.across2 / max(n.along2, lit(1e-20)));
    real soft = k_saturate(lit(1.5) - lit(0.25) * n.across2);
    real part = longer * thin * soft;
    part = select(small, lit(0.0), part);
    real share = disc + (ggx_share_of_needle(n, e.area) - disc) * part;
    mask large = e.xx + e.yy > lit(1.0); // the disc's tail is too bright for long ellipses that are not thin
    if (any_lane(large))
        share = select(large, min(share, ggx_most_of_ellipse(e)), share);
    return share;
}

BN_KERNELS_END

#endif
