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
    real2 u; // unit, u.x >= 0: the direction of sigma_u, (tangent, bitangent); that of sigma_v is (-u.y, u.x)
};

// u: unit. From the deviations along u and across it.
BN_FN slope_covariance covariance_of_axes(real sigma_u, real sigma_v, real2 u)
{
    real vu = sigma_u * sigma_u;
    real vv = sigma_v * sigma_v;
    slope_covariance s;
    s.xx = vu * u.x * u.x + vv * u.y * u.y;
    s.yy = vu * u.y * u.y + vv * u.x * u.x;
    s.xy = (sigma_u - sigma_v) * (sigma_u + sigma_v) * (u.x * u.y);
    return s;
}

struct tangent_direction {
    real2 d;    // unit, (tangent, bitangent)
    mask known; // false where a texel holds none
};

// raw: components in [-1,1], of any length. Below 1/100 it holds no direction: (128, 128) in 8 bits, which
// stands for zero, has length 0.0055. The length is looked at before it is divided by.
BN_FN tangent_direction direction_from_texel(real2 raw)
{
    tangent_direction r;
    real length2 = k_dot2(raw, raw);
    r.known = length2 >= lit(1e-4);
    r.d = select(r.known, raw * (lit(1.0) / sqrt(max(length2, lit(1e-4)))), vec2_of(lit(1.0), lit(0.0)));
    return r;
}

// alpha_lin in [0,1]; eta in [-1,1], the degree of anisotropy: alpha = alpha_lin^2 (1 + eta) along the
// direction and alpha_lin^2 (1 - eta) across it. raw: as above; without a direction the surface is isotropic.
BN_FN slope_covariance covariance_from_eta(real alpha_lin, real eta, real2 raw)
{
    tangent_direction along = direction_from_texel(raw);
    real e = select(along.known, clamp(eta, lit(-1.0), lit(1.0)), lit(0.0));
    real sigma = alpha_lin * alpha_lin * lit(0.70710678118654752);
    real sigma_u = sigma * (lit(1.0) + e);
    real sigma_v = sigma * (lit(1.0) - e);
    return covariance_of_axes(sigma_u, sigma_v, along.d);
}

// KHR_materials_anisotropy. alpha: roughness^2, [0,1]; strength: [0,1]; rotation: (cos, sin) of the angle
// counter-clockwise from the tangent; texel: red and green a direction in [0,1]^2, blue a factor of the
// strength; (1, 0.5, 1) where there is no texture. alpha is mix(alpha, 1, strength^2) along the direction and
// alpha across it.
BN_FN slope_covariance covariance_from_khr(real alpha, real strength, real2 rotation, real3 texel)
{
    real2 raw = vec2_of(texel.x * lit(2.0) - lit(1.0), texel.y * lit(2.0) - lit(1.0));
    tangent_direction along = direction_from_texel(raw);
    real2 d = vec2_of(rotation.x * along.d.x - rotation.y * along.d.y,
                      rotation.y * along.d.x + rotation.x * along.d.y);
    real s = select(along.known, k_saturate(strength * texel.z), lit(0.0));
    real alpha_t = k_mix(alpha, lit(1.0), s * s);
    real sigma_t = alpha_t * lit(0.70710678118654752);
    real sigma_b = alpha * lit(0.70710678118654752);
    return covariance_of_axes(sigma_t, sigma_b, d);
}

// The same from filtered tensors of an anisotropy texture (shading/bake/anisotropy.h): power2, power4 hold xx, yy, xy of the texels'
// strength^2 d d^T and strength^4 d d^T; (1, 0, 0) where there is no texture. Linear in both, so filtering them is exact.
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

// alpha_lin and eta as in covariance_from_eta, along the main direction of a filtered tensor.
BN_FN slope_covariance covariance_from_eta_tensor(real alpha_lin, real eta, real2 rotation, real3 power2)
{
    real trace = power2.x + power2.y;
    real3 m = power2 * (lit(1.0) / max(trace, lit(1e-6))); // trace 1 where there is a direction
    real sigma = alpha_lin * alpha_lin * lit(0.70710678118654752);
    real e = select(trace > lit(1e-6), eta, lit(0.0)); // without a direction the surface is isotropic
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

BN_FN slope_covariance covariance_mix(slope_covariance a, slope_covariance b, real t)
{
    slope_covariance s;
    s.xx = k_mix(a.xx, b.xx, t);
    s.yy = k_mix(a.yy, b.yy, t);
    s.xy = k_mix(a.xy, b.xy, t);
    return s;
}

// Eigenvalues and the first eigenvector, for any symmetric matrix with xx + yy >= 0. Free of angles, of scale
// and of cancellation in the axis: with h = (xx - yy) / 2 and d = |(h, xy)|, u is along (d + h, xy) or, where
// h < 0, along (|xy|, +-(d - h)). What has no axis has u = (1, 0). The smaller eigenvalue is kept above
// 0.001^2 / 2, alpha = 0.001.
BN_FN slope_axes axes_of_covariance(slope_covariance s)
{
    real least = lit(5e-7);
    real m = lit(0.5) * (s.xx + s.yy);
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
    real l2 = min(max(product / l1, least), l1);
    real steep = ds - hs;
    real2 u =
        select(hs >= lit(0.0), vec2_of(ds + hs, cs), vec2_of(abs(cs), select(cs < lit(0.0), -steep, steep)));
    slope_axes axes;
    axes.sigma_u = sqrt(l1);
    axes.sigma_v = sqrt(l2);
    axes.u = select(circular, vec2_of(lit(1.0), lit(0.0)), k_normalize2(u));
    return axes;
}

// Perceptual roughness and degree of anisotropy, [0,1], of a decomposed covariance.
BN_FN real axes_alpha_lin(slope_axes axes)
{
    return sqrt((axes.sigma_u + axes.sigma_v) * lit(0.70710678118654752));
}
BN_FN real axes_eta(slope_axes axes)
{
    return (axes.sigma_u - axes.sigma_v) / (axes.sigma_u + axes.sigma_v);
}

BN_KERNELS_END

#endif
