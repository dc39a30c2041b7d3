// A line of isotropic lobes: environment light of an anisotropic GGX lobe from prefiltered samples along its grain, each as
// wide as the lobe is across. Over slopes in units of the widths, GGX's density 1 / (pi (1 + u^2 + v^2)^2) is a product.
// Its factors are the marginal (1 + u^2)^(-3/2) / 2 and, at each u, a density of width sqrt(1 + u^2) in v. So a lobe with
// two widths is a line of round lobes. Let l1 >= l2 be its squared widths as the eye sees them. The line follows the
// marginal with scale sqrt(l1 - l2), and the round lobe's width is sqrt(l2) sqrt(1 + z^2) at z scales along it. Across the
// grain, only the lobe itself spreads light.
//
// A narrow round lobe has its mean direction at its middle. A wide one does not: masking and the horizon hide its lower
// part, slopes crowd towards the horizon, and its mean direction rises. So each sample moves to the mean direction, and its
// level is as wide as the spread about the mean. To first order the amounts are proportional to the squared width. Their
// factors were fitted to pictures of spheres with the whole lobe.
//
// All vectors are in the ellipse frame: x along the greater slope deviation, y along the smaller, z the normal. As in
// major_axis.k.h, a microfacet normal with slope (x, y) is normalize(-x, -y, 1).
#ifndef BN_LOBE_LINE_K_H
#define BN_LOBE_LINE_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

#define kLineSamplesAlone 4.0  // lobe_line_count() for fragments that share no samples
#define kLineSamplesUnlike 2.6 // for fragments whose neighbours are unlike them
#define kLineSamplesShared 1.7 // where neighbours' samples lie between a fragment's own
#define kLineWidening 0.7      // relative widening of a fragment's only sample

struct lobe_line {
    real3 o;      // to the eye, unit
    real2 along;  // slopes at z = 1
    real width;   // sqrt(l2) / o.z, the round lobe's width at z = 0
    real level;   // alpha of the prefiltered level at z = 0, seen from above: see lobe_line_at()
    real widen;   // additional level width of wide round lobes: see lobe_line_at()
    real lift;    // rise of a sample, per width of its round lobe
    real upright; // added to the height of microfacet normals: slopes of wide lobes count less
    real3 axis;   // o minus the rise common to all samples
    real extent;  // sqrt(l1 / l2 - 1): length of the line in widths
    real even;    // [0,1): 0: samples take equal shares of the lobe, 1: equal distances in widths; see lobe_line_at()
    real stretch; // Smith's |(alpha_x o.x, alpha_y o.y, o.z)|
    real alpha_x, alpha_y;
};

// Makes the line. o: to the eye, ellipse frame; sigma_x >= sigma_y: slope deviations. At a slant, a round lobe is a
// line, too.
BN_FN lobe_line lobe_line_of(real3 o, real sigma_x, real sigma_y)
{
    real root2 = lit(1.4142135623730951);
    // Bring the eye above the horizon
    real one = lit(1.0);
    lobe_line r;
    o.z = max(o.z, lit(1e-4));
    r.o = k_normalize3(o);
    r.alpha_x = sigma_x * root2;
    r.alpha_y = sigma_y * root2;
    // Find the visible ellipse of the lobe
    real x = r.alpha_x * r.o.x;
    real y = r.alpha_y * r.o.y;
    real zx = r.alpha_x * r.o.z;
    real zy = r.alpha_y * r.o.z;
    real m = lit(0.5) * (x * x + y * y + zx * zx + zy * zy);
    // Half of alpha_x^2 (o.z^2 + o.x^2) - alpha_y^2 (o.z^2 + o.y^2)
    real h = lit(0.5) * ((zx - zy) * (zx + zy) + (x - y) * (x + y));
    real shear = x * y;
    real d = sqrt(h * h + shear * shear);
    real l1 = max(m + d, lit(1e-20));
    real least = r.alpha_x * zy;                      // sqrt(l1 l2)
    real ratio = min(least * least / (l1 * l1), one); // l2 / l1
    // Find its major axis, the direction of the line
    real steep = d - h;
    real2 e = select(h >= lit(0.0), vec2_of(d + h, shear), vec2_of(abs(shear), select(shear < lit(0.0), -steep, steep)));
    real inv = one / max(sqrt(k_dot2(e, e)), lit(1e-20));
    real rest = sqrt(one - ratio) * inv;
    r.along = vec2_of(r.alpha_x * e.x * rest, r.alpha_y * e.y * rest);
    // Choose the level's width
    r.width = sqrt(l1 * ratio) / r.o.z;
    real grazing = (lit(0.78) + lit(0.22) * r.o.z) * r.width;
    r.level = (lit(0.66) - lit(0.13) * ratio) * grazing;
    r.widen = lit(1.29) * r.width * grazing;
    // Correct the mean direction of wide lobes
    real square = r.width * r.width;
    real narrow2 = square * r.o.z * r.o.z;
    real3 axis = r.o * (one + lit(0.64) * narrow2);
    axis.z = axis.z - lit(1.19) * square * r.o.z;
    r.axis = axis;
    r.upright = lit(0.13) * narrow2;
    r.lift = lit(1.92) * square;
    // Measure the line and its samples' spacing
    r.extent = sqrt((one - ratio) / max(ratio, lit(1e-12)));
    r.even = r.extent / (r.extent + lit(6.0));
    r.stretch = sqrt(x * x + y * y + r.o.z * r.o.z);
    return r;
}

struct lobe_line_sample {
    real3 direction; // not unit, ellipse frame
    real weight;     // at least 0: visible area and Smith's height-correlated masking
    real radius;     // alpha of the prefiltered level
    real v_dot_h;    // cosine between the eye and the half vector, [0,1]
};

// Makes the sample at t in [-1,1]. Its z is c / sqrt(1 - c^2) with c = (1 + e) t / (1 + e t^2), e = line.even. The marginal
// is uniform in c. With e = 0, samples take equal shares of the lobe; the gaps in a long line's tails then show single
// samples. With e = 1, samples are as far apart, in widths, as sqrt(1 + z^2). The weight includes dc / dt. The vector w is
// 1 + e t^2 times as long as by c, except for the corrections of wide lobes. A GGX with 0.77 times the round lobe's width
// has the same median, as (1 + r^2)^(-5/2) falls faster. Pictures ask for 0.6 for narrow lobes and more for wide ones; 0.66
// hides single samples.
BN_FN lobe_line_sample lobe_line_at(lobe_line line, real t)
{
    // Find the microfacet normal
    real one = lit(1.0);
    real t2 = t * t;
    real bend = line.even * t2;
    real scale = one + bend;
    real root = sqrt(max((one - t2) * (one - line.even * bend), lit(1e-3))) + line.upright;
    real c = t + line.even * t;
    real3 w = vec3_of(-line.along.x * c, -line.along.y * c, root);
    // Mirror the eye, with the rise of wide lobes
    real w2 = k_dot3(w, w);
    real w_dot_o = k_dot3(w, line.o);
    real seen = max(w_dot_o, lit(0.0));
    real scale2 = scale * scale;
    lobe_line_sample r;
    r.direction = w * (lit(2.0) * w_dot_o) - line.axis * w2;
    // Choose the level's width
    real share = seen / w2;
    real cosine2 = share * seen;
    real size = share * scale;
    r.direction.z = r.direction.z + line.lift * size * seen;
    r.radius = (line.level + line.widen * size) * size;
    r.v_dot_h = min(sqrt(cosine2), one);
    // Weight by visible area and masking
    real ix = line.alpha_x * r.direction.x;
    real iy = line.alpha_y * r.direction.y;
    real iz = r.direction.z;
    real stretch = sqrt(ix * ix + iy * iy + iz * iz);
    real up = max(iz, lit(0.0));
    r.weight = seen * up * (one - bend) / (root * scale2 * max(up * line.stretch + line.o.z * stretch, lit(1e-20)));
    return r;
}

// Returns the number of samples that a line of this length needs, a real in [1, limit]. per_width: samples for each width
// of its length. At kLineSamplesAlone they lie half a width apart in its middle, one in a long line. A third as many would
// show single samples far out on the tails.
BN_FN real lobe_line_count(lobe_line line, real per_width, real limit)
{
    return min(lit(1.0) + per_width * line.extent, limit);
}

// Returns the most samples that a line may take where all neighbours are alike, a real. samples: of the frame. A lobe twelve
// times as long as it is wide may take two thirds of them, a short lobe a third. At a slant a short lobe is a long line too,
// but its far end is masked.
BN_FN real lobe_line_limit(lobe_line line, real samples)
{
    real share = line.alpha_x / max(line.alpha_y * lit(18.0), lit(1e-20));
    return samples * min(max(share, lit(0.33333333333333333)), lit(0.66666666666666667));
}

struct lobe_line_cell {
    real begin, size; // of t
    real weight;      // its size relative to a whole cell, [0,1]
};

// Returns cell i of the line, i = 1, 2..., on the positive side. The line is cut into `count` cells of equal size, from its
// middle outwards. The line's end shortens the last cell, so samples appear and vanish without a step where the count
// changes.
BN_FN lobe_line_cell lobe_line_cell_of(real count, int i)
{
    real whole = lit(2.0) / count;
    lobe_line_cell r;
    r.begin = (to_real(int_lit(i)) - lit(0.5)) * whole;
    r.size = min(max(lit(1.0) - r.begin, lit(0.0)), whole);
    r.weight = r.size / whole;
    return r;
}

BN_KERNELS_END

#endif
