// A lobe as a tensor, a form that texels may average, and its transforms between frames. Four forms of the same lobe:
//  widths and axis      alpha_u, alpha_v along and across u, or artists' (roughness, eta, direction)
//  covariance           Sigma = M^2 / 2 of slopes (covariance.k.h), M = R diag(alpha_u, alpha_v) R^T
//  stored tensor        (a, b, c): A = [[a, c], [c, b]] is the adjugate of M, so M = [[b, -c], [-c, a]]; widths are linear in it
//  covariance in space  M^2 in the tangent plane of a normal: lobes of several normals add up
// Frames follow the shortest turn from (0,0,1) to a normal n (turned_frame in surface.k.h): T = (1 - x^2 s, -x y s, -x), B
// = (-x y s, 1 - y^2 s, -y), s = 1 / (1 + z). The order of sums is such that mirroring x or y, or swapping them, gives the
// same bits.
#ifndef BN_TENSOR_K_H
#define BN_TENSOR_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/covariance.k.h"

BN_KERNELS_BEGIN

struct lobe_tensor {
    real a, b, c;
};

struct tensor_axes {
    real alpha_u, alpha_v; // alpha_u >= alpha_v
    real2 u;               // unit, u.x >= 0: the direction of alpha_u
};

struct tensor_roughness {
    real roughness, eta; // [0,1]: widths roughness^2 (1 + eta) along the direction, roughness^2 (1 - eta) across it
    real2 direction;     // unit, x >= 0
};

struct space_covariance {
    real xx, yy, zz, xy, xz, yz;
};

struct slope_lobe {
    real2 mean;
    slope_covariance spread;
};

// Returns a symmetric matrix's square root without eigenvectors: (S + d I) / sqrt(trace S + 2 d), d = sqrt(det S).
BN_FN slope_covariance root_of(slope_covariance s)
{
    real product = s.xx * s.yy - s.xy * s.xy;
    real d = sqrt(max(product, lit(0.0)));
    real sum = (s.xx + s.yy) + lit(2.0) * d;
    real scale = lit(1.0) / sqrt(max(sum, lit(1e-24)));
    slope_covariance r;
    r.xx = (s.xx + d) * scale;
    r.yy = (s.yy + d) * scale;
    r.xy = s.xy * scale;
    return r;
}

BN_FN lobe_tensor tensor_of_covariance(slope_covariance s)
{
    slope_covariance twice;
    twice.xx = lit(2.0) * s.xx;
    twice.yy = lit(2.0) * s.yy;
    twice.xy = lit(2.0) * s.xy;
    slope_covariance m = root_of(twice);
    lobe_tensor t;
    t.a = m.yy;
    t.b = m.xx;
    t.c = -m.xy;
    return t;
}

BN_FN slope_covariance covariance_of_tensor(lobe_tensor t)
{
    slope_covariance s;
    s.xx = lit(0.5) * (t.b * t.b + t.c * t.c);
    s.yy = lit(0.5) * (t.a * t.a + t.c * t.c);
    s.xy = -(lit(0.5) * t.c * (t.a + t.b));
    return s;
}

// Makes a tensor from widths and axis. u: unit.
BN_FN lobe_tensor tensor_of_axes(real alpha_u, real alpha_v, real2 u)
{
    lobe_tensor t;
    t.a = alpha_u * u.y * u.y + alpha_v * u.x * u.x;
    t.b = alpha_u * u.x * u.x + alpha_v * u.y * u.y;
    t.c = (alpha_v - alpha_u) * u.x * u.y;
    return t;
}

// Returns widths and axis. Widths must exceed 1e-6.
BN_FN tensor_axes axes_of_tensor(lobe_tensor t)
{
    slope_covariance m; // M has the axes of its root
    m.xx = t.b;
    m.yy = t.a;
    m.xy = -t.c;
    slope_axes root = axes_of_covariance(m);
    tensor_axes r;
    r.alpha_u = root.sigma_u * root.sigma_u;
    r.alpha_v = root.sigma_v * root.sigma_v;
    r.u = root.u;
    return r;
}

// Makes a tensor from artists' parameters. direction: any length above 0.
BN_FN lobe_tensor tensor_of_roughness(real roughness, real eta, real2 direction)
{
    real alpha = roughness * roughness;
    real along = alpha * (lit(1.0) + eta);
    real across = alpha * (lit(1.0) - eta);
    return tensor_of_axes(along, across, k_normalize2(direction));
}

BN_FN tensor_roughness roughness_of_tensor(lobe_tensor t)
{
    tensor_axes axes = axes_of_tensor(t);
    real sum = axes.alpha_u + axes.alpha_v;
    tensor_roughness r;
    r.roughness = sqrt(lit(0.5) * sum);
    r.eta = (axes.alpha_u - axes.alpha_v) / max(sum, lit(1e-12));
    r.direction = axes.u;
    return r;
}

// Returns a storable tensor near t, with both widths in [0.002, 1]. Not an orthogonal projection: clamps the diagonal
// first, then c to the remaining range.
BN_FN lobe_tensor projected_tensor(lobe_tensor t)
{
    real least = lit(0.002);
    real one = lit(1.0);
    lobe_tensor r;
    r.a = min(max(t.a, least), one);
    r.b = min(max(t.b, least), one);
    real below = (r.a - least) * (r.b - least);
    real above = (one - r.a) * (one - r.b);
    real most = sqrt(max(min(below, above), lit(0.0)));
    r.c = min(max(t.c, -most), most);
    return r;
}

// Returns k s k; both are symmetric.
BN_FN slope_covariance conjugated_by(slope_covariance k, slope_covariance s)
{
    slope_covariance r;
    r.xx = (k.xx * k.xx * s.xx + k.xy * k.xy * s.yy) + lit(2.0) * (k.xx * k.xy) * s.xy;
    r.yy = (k.yy * k.yy * s.yy + k.xy * k.xy * s.xx) + lit(2.0) * (k.yy * k.xy) * s.xy;
    r.xy = (k.xx * k.xy * s.xx + k.yy * k.xy * s.yy) + (k.xx * k.yy + k.xy * k.xy) * s.xy;
    return r;
}

// Transform slope deviations about n's slope between the plane of (0,0,1) and n's own frame, to first order in the turn of
// normals. n: unit, z > 0.
BN_FN slope_covariance covariance_to_frame(real3 n, slope_covariance flat_one)
{
    real part = n.z / (lit(1.0) + n.z);
    slope_covariance k;
    k.xx = n.z - n.x * n.x * part;
    k.yy = n.z - n.y * n.y * part;
    k.xy = -(n.x * n.y * part);
    return conjugated_by(k, flat_one);
}

BN_FN slope_covariance covariance_from_frame(real3 n, slope_covariance own)
{
    real inverse = lit(1.0) / n.z;
    real part = inverse * inverse / (lit(1.0) + n.z);
    slope_covariance k;
    k.xx = inverse + n.x * n.x * part;
    k.yy = inverse + n.y * n.y * part;
    k.xy = n.x * n.y * part;
    return conjugated_by(k, own);
}

// Returns the covariance s, given in n's frame, in space. n: unit, z > -1.
BN_FN space_covariance covariance_in_space(real3 n, slope_covariance s)
{
    real part = lit(1.0) / (lit(1.0) + n.z);
    real skew = -(n.x * n.y * part);
    real3 t = vec3_of(lit(1.0) - n.x * n.x * part, skew, -n.x);
    real3 b = vec3_of(skew, lit(1.0) - n.y * n.y * part, -n.y);
    space_covariance r;
    r.xx = (t.x * t.x * s.xx + b.x * b.x * s.yy) + lit(2.0) * (t.x * b.x) * s.xy;
    r.yy = (b.y * b.y * s.yy + t.y * t.y * s.xx) + lit(2.0) * (t.y * b.y) * s.xy;
    r.zz = (t.z * t.z * s.xx + b.z * b.z * s.yy) + lit(2.0) * (t.z * b.z) * s.xy;
    r.xy = (t.x * t.y * s.xx + b.x * b.y * s.yy) + (t.x * b.y + t.y * b.x) * s.xy;
    r.xz = (t.x * t.z * s.xx + b.x * b.z * s.yy) + (t.x * b.z + t.z * b.x) * s.xy;
    r.yz = (b.y * b.z * s.yy + t.y * t.z * s.xx) + (b.y * t.z + b.z * t.y) * s.xy;
    return r;
}

// Returns a covariance in space as seen in n's frame.
BN_FN slope_covariance covariance_seen_from(real3 n, space_covariance s)
{
    real part = lit(1.0) / (lit(1.0) + n.z);
    real skew = -(n.x * n.y * part);
    real3 t = vec3_of(lit(1.0) - n.x * n.x * part, skew, -n.x);
    real3 b = vec3_of(skew, lit(1.0) - n.y * n.y * part, -n.y);
    slope_covariance r;
    real across_t = t.x * t.y * s.xy + t.z * (t.x * s.xz + t.y * s.yz);
    real across_b = b.x * b.y * s.xy + b.z * (b.y * s.yz + b.x * s.xz);
    r.xx = ((t.x * t.x * s.xx + t.y * t.y * s.yy) + t.z * t.z * s.zz) + lit(2.0) * across_t;
    r.yy = ((b.y * b.y * s.yy + b.x * b.x * s.xx) + b.z * b.z * s.zz) + lit(2.0) * across_b;
    real with_z = s.xz * (t.x * b.z + t.z * b.x) + s.yz * (b.y * t.z + b.z * t.y);
    r.xy = ((t.x * b.x * s.xx + t.y * b.y * s.yy) + t.z * b.z * s.zz) + ((t.x * b.y + t.y * b.x) * s.xy + with_z);
    return r;
}

// Returns S v for S = s + mean mean^T, an SGGX matrix (Heitz, Dupuy, Crassin, Dachsbacher 2015). s: covariance from squared
// widths; mean: mean of unit normals.
BN_FN real3 sggx_product(real3 mean, space_covariance s, real3 v)
{
    real along = (mean.x * v.x + mean.y * v.y) + mean.z * v.z;
    real3 r;
    r.x = ((s.xx * v.x + s.xy * v.y) + s.xz * v.z) + mean.x * along;
    r.y = ((s.yy * v.y + s.xy * v.x) + s.yz * v.z) + mean.y * along;
    r.z = ((s.xz * v.x + s.yz * v.y) + s.zz * v.z) + mean.z * along;
    return r;
}

// Returns the lobe that S stands for, by slopes in n's frame. The mean slope is S_tn / S_nn. The spread is S_tt / S_nn
// minus the squared mean: the Schur complement over S_nn, written without a difference between large numbers. n: unit, z >
// -1, near mean.
BN_FN slope_lobe sggx_lobe(real3 n, real3 mean, space_covariance s)
{
    // Build n's frame and project the mean
    real part = lit(1.0) / (lit(1.0) + n.z);
    real skew = -(n.x * n.y * part);
    real3 t = vec3_of(lit(1.0) - n.x * n.x * part, skew, -n.x);
    real3 b = vec3_of(skew, lit(1.0) - n.y * n.y * part, -n.y);
    real m_t = (t.x * mean.x + t.y * mean.y) + t.z * mean.z;
    real m_b = (b.y * mean.y + b.x * mean.x) + b.z * mean.z;
    real m_n = (n.x * mean.x + n.y * mean.y) + n.z * mean.z;
    // Project s
    real3 across = sggx_product(vec3_all(lit(0.0)), s, n);
    real s_t = (t.x * across.x + t.y * across.y) + t.z * across.z;
    real s_b = (b.y * across.y + b.x * across.x) + b.z * across.z;
    real s_n = (n.x * across.x + n.y * across.y) + n.z * across.z;
    slope_covariance own = covariance_seen_from(n, s);
    // Divide by S_nn
    real whole = s_n + m_n * m_n;
    real inverse = lit(1.0) / max(whole, lit(1e-12));
    slope_lobe r;
    r.mean = vec2_of((s_t + m_t * m_n) * inverse, (s_b + m_b * m_n) * inverse);
    real xx = s_t * s_t + m_n * (lit(2.0) * s_t * m_t) - s_n * (m_t * m_t);
    real yy = s_b * s_b + m_n * (lit(2.0) * s_b * m_b) - s_n * (m_b * m_b);
    real xy = s_t * s_b + m_n * (s_t * m_b + s_b * m_t) - s_n * (m_t * m_b);
    r.spread.xx = (own.xx - xx * inverse) * inverse;
    r.spread.yy = (own.yy - yy * inverse) * inverse;
    r.spread.xy = (own.xy - xy * inverse) * inverse;
    return r;
}

BN_KERNELS_END

#endif
