// Roughness as the 2x2 covariance of a surface's slopes in its tangent plane: what textures of anisotropic
// materials hold, because covariances can be filtered and mixed linearly where angles and axes cannot. Filter
// first, decompose afterwards, in float32: at eta = 0.95 half floats lose a third of the smaller deviation.
// alpha = sqrt(2) sigma is the GGX width along an axis; alpha_lin = sqrt(alpha) is what artists call
// roughness.
#ifndef BN_COVARIANCE_K_H
#define BN_COVARIANCE_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Slopes are d height / d tangent and d height / d bitangent.
struct slope_covariance {
    real xx, yy, xy;
};

struct slope_axes {
    real sigma_u, sigma_v; // standard deviations of slope, sigma_u >= sigma_v >= 0.001 / sqrt(2)
    real2 u;               // unit, u.x >= 0: the direction of sigma_u, (tangent, bitangent); that of sigma_v is (-u.y, u.x)
};

// glTF 2.0's KHR_materials_anisotropy (section "Anisotropy"). alpha: roughness^2, [0,1]; strength: [0,1]; rotation: (cos, sin) of the angle
// counter-clockwise from the tangent. power2, power4: xx, yy, xy of the texture's strength^2 d d^T and strength^4 d d^T,
// filtered, where d is a texel's direction (shading/bake/mip/anisotropy.h; what has none is isotropic); (1, 0, 0) without
// a texture. The width is mix(alpha, 1, s^2) along d and alpha across it, s the product of both strengths. Linear in
// both tensors, so filtering them filters the covariance exactly.
BN_FN slope_covariance covariance_from_tensors(real alpha, real strength, real2 rotation, real3 power2, real3 power4)
{
    real rest = lit(1.0) - alpha;
    real s2 = strength * strength;
    real k2 = lit(2.0) * alpha * rest * s2;
    real k4 = rest * rest * s2 * s2;
    real3 m = power2 * k2 + power4 * k4;
    real c = rotation.x;
    real s = rotation.y;
    real shear = lit(2.0) * c * s * m.z;
    slope_covariance r;
    r.xx = lit(0.5) * (alpha * alpha + (c * c * m.x + s * s * m.y - shear));
    r.yy = lit(0.5) * (alpha * alpha + (s * s * m.x + c * c * m.y + shear));
    r.xy = lit(0.5) * (c * s * (m.x - m.y) + (c * c - s * s) * m.z);
    return r;
}

BN_FN slope_covariance sum_of_covariances(slope_covariance a, slope_covariance b)
{
    slope_covariance r;
    r.xx = a.xx + b.xx;
    r.yy = a.yy + b.yy;
    r.xy = a.xy + b.xy;
    return r;
}

// Of slopes whose mean and second moments xx, yy, xy are known.
BN_FN slope_covariance covariance_of_moments(real2 mean, real3 second)
{
    slope_covariance r;
    r.xx = second.x - mean.x * mean.x;
    r.yy = second.y - mean.y * mean.y;
    r.xy = second.z - mean.x * mean.y;
    return r;
}

// alpha_lin in [0,1]; eta in [-1,1], the degree of anisotropy: the width is alpha_lin^2 (1 + eta) along the main
// direction of a filtered tensor and alpha_lin^2 (1 - eta) across it. Without a direction the surface is isotropic.
BN_FN slope_covariance covariance_from_eta_tensor(real alpha_lin, real eta, real2 rotation, real3 power2)
{
    real trace = power2.x + power2.y;
    real3 m = power2 * (lit(1.0) / max(trace, lit(1e-6))); // trace 1 where there is a direction
    real sigma = alpha_lin * alpha_lin * lit(0.70710678118654752);
    real e = select(trace > lit(1e-6), eta, lit(0.0));
    real along = sigma * (lit(1.0) + e);
    real across = sigma * (lit(1.0) - e);
    real extra = (along - across) * (along + across);
    real base = across * across;
    real c = rotation.x;
    real s = rotation.y;
    real shear = lit(2.0) * c * s * m.z;
    slope_covariance r;
    r.xx = base + extra * (c * c * m.x + s * s * m.y - shear);
    r.yy = base + extra * (s * s * m.x + c * c * m.y + shear);
    r.xy = extra * (c * s * (m.x - m.y) + (c * c - s * s) * m.z);
    return r;
}

// Eigenvalues and the first eigenvector, for any symmetric matrix with xx + yy >= 0. Free of angles, of scale
// and of cancellation in the axis: with h = (xx - yy) / 2 and d = |(h, xy)|, u is along (d + h, xy) or, where
// h < 0, along (|xy|, +-(d - h)). What has no axis has u = (1, 0). The smaller eigenvalue is kept above
// 0.001^2 / 2, alpha = 0.001, or the mean of both where that is less: a round lobe keeps its width, however narrow.
BN_FN slope_axes axes_of_covariance(slope_covariance s)
{
    real m = lit(0.5) * (s.xx + s.yy);
    real least = max(min(m, lit(5e-7)), lit(0.0));
    real h = lit(0.5) * (s.xx - s.yy);
    real scale = max(abs(h), abs(s.xy));
    mask circular = scale < lit(1e-20);
    real safe = select(circular, lit(1.0), scale);
    real hs = h / safe;
    real cs = s.xy / safe;
    real ds = sqrt(hs * hs + cs * cs);
    real d = ds * scale;
    real l1 = max(m + d, least);
    real product = s.xx * s.yy - s.xy * s.xy;
    real l2 = min(max(product / max(l1, lit(1e-30)), least), l1);
    real steep = ds - hs;
    real2 u = select(hs >= lit(0.0), vec2_of(ds + hs, cs), vec2_of(abs(cs), select(cs < lit(0.0), -steep, steep)));
    slope_axes axes;
    axes.sigma_u = sqrt(l1);
    axes.sigma_v = sqrt(l2);
    axes.u = select(circular, vec2_of(lit(1.0), lit(0.0)), k_normalize2(u));
    return axes;
}

BN_KERNELS_END

#endif
