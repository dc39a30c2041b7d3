// Roughness as the 2x2 covariance of surface slopes in the tangent plane. Textures of anisotropic materials hold
// covariances, because filters and mixes are linear in them, unlike in angles and axes. Filter first and decompose
// afterwards, in float32: half floats lose the smaller deviation at strong anisotropy. alpha = sqrt(2) sigma is the GGX
// width along an axis; roughness = sqrt(alpha).
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
    real2 u;               // unit, u.x >= 0: direction of sigma_u, (tangent, bitangent); sigma_v lies along (-u.y, u.x)
};

// Returns the covariance by KHR_materials_anisotropy of glTF 2.0 (section "Anisotropy"). alpha: roughness^2, [0,1];
// strength: [0,1]; rotation: (cos, sin) of the angle counter-clockwise from the tangent. power2, power4: xx, yy, xy of the
// texture's filtered strength^2 d d^T and strength^4 d d^T, where d is a texel's direction. Texels without a direction are
// isotropic (shading/bake/mip/anisotropy.h); without a texture, pass (1, 0, 0). The width is mix(alpha, 1, s^2) along d and
// alpha across it, where s is the product of both strengths. The result is linear in both tensors, so filtered tensors give
// the filtered covariance exactly.
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

// Returns the covariance of slopes from their mean and second moments xx, yy, xy.
BN_FN slope_covariance covariance_of_moments(real2 mean, real3 second)
{
    slope_covariance r;
    r.xx = second.x - mean.x * mean.x;
    r.yy = second.y - mean.y * mean.y;
    r.xy = second.z - mean.x * mean.y;
    return r;
}

// Returns the covariance for roughness in [0,1] and degree of anisotropy eta in [-1,1]. The width is roughness^2 (1 + eta)
// along the main direction of a filtered tensor and roughness^2 (1 - eta) across it. Without a direction the surface is
// isotropic.
BN_FN slope_covariance covariance_from_eta_tensor(real roughness, real eta, real2 rotation, real3 power2)
{
    real trace = power2.x + power2.y;
    real3 m = power2 * (lit(1.0) / max(trace, lit(1e-6))); // trace 1 where a direction exists
    real sigma = roughness * roughness * lit(0.70710678118654752);
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

// Returns eigenvalues and the first eigenvector of a symmetric matrix with xx + yy >= 0. Uses no angles, scales freely, and
// does not cancel in the axis. With h = (xx - yy) / 2 and d = |(h, xy)|, u is along (d + h, xy) or, where h < 0, along
// (|xy|, +-(d - h)). Without an axis, u = (1, 0). The smaller eigenvalue stays above 0.001^2 / 2 (alpha = 0.001), or above
// the mean of both where the mean is less. So a round lobe keeps its width, however narrow.
BN_FN slope_axes axes_of_covariance(slope_covariance s)
{
    // Normalize the matrix's deviator
    real m = lit(0.5) * (s.xx + s.yy);
    real least = max(min(m, lit(5e-7)), lit(0.0));
    real h = lit(0.5) * (s.xx - s.yy);
    real scale = max(abs(h), abs(s.xy));
    mask circular = scale < lit(1e-20);
    real safe = select(circular, lit(1.0), scale);
    real hs = h / safe;
    real cs = s.xy / safe;
    // Find the eigenvalues; the smaller from the determinant
    real ds = sqrt(hs * hs + cs * cs);
    real d = ds * scale;
    real l1 = max(m + d, least);
    real product = s.xx * s.yy - s.xy * s.xy;
    real l2 = min(max(product / max(l1, lit(1e-30)), least), l1);
    // Find the eigenvector
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
