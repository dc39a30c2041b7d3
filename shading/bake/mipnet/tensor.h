// A texel's state and its reflected light. Anisotropic width is a tensor, after the appendix of the MIPNet paper (Gauthier, Faury,
// Levallois, Thonat, Thiery, Boubekeur 2022, "MIPNet: Neural Normal-to-Anisotropic-Roughness MIP Mapping"), with corrected masking: the
// projected area rotates the tensor by 90 degrees, so its mixed term has a minus.
//
// A = [[a, c], [c, b]] over the axes T, B of the shortest rotation from +z to the normal. Its widths are alpha_b along the grain and
// alpha_t across it. So M = [[b, -c], [-c, a]] holds each width along its axis; det A = det M = alpha_t alpha_b. With u the tangential part
// of a vector, the density needs |A u|^2 / det^2 = |M^-1 u|^2 of a half vector, and masking needs |M u|^2.
#pragma once
#include "shading/bake/mipnet/autodiff.h"

BN_KERNELS_BEGIN
namespace mipnet_lanes {

#define BN_LEAST_ALPHA lit(0.002)
#define BN_MOST_TILT lit(0.999)

template <class V> struct texel {
    V nx, ny, a, b, c;
};

// Clamps a texel to a valid state, channel by channel: widths in [0.002, 1], normals within 87.4 degrees of +z. The projection is not
// orthogonal. The floor under the root keeps the slope of c's bound finite if a or b lies on its own bound.
template <class V> BN_FN texel<V> proj(const texel<V>& x)
{
    const V length = sqrt(max(x.nx * x.nx + x.ny * x.ny, lit(1e-12)));
    const V shrink = BN_MOST_TILT / max(length, BN_MOST_TILT);
    const V a = min(max(x.a, BN_LEAST_ALPHA), lit(1.0)), b = min(max(x.b, BN_LEAST_ALPHA), lit(1.0));
    const V widest = (lit(1.0) - a) * (lit(1.0) - b), narrowest = (a - BN_LEAST_ALPHA) * (b - BN_LEAST_ALPHA);
    const V most = sqrt(max(min(widest, narrowest), lit(1e-12)));
    return {x.nx * shrink, x.ny * shrink, a, b, max(min(x.c, most), -most)};
}

// Axes of a texel: n = (nx, ny, nz), T = (tx, m, -nx), B = (m, by, -ny).
template <class V> struct frame {
    V nx, ny, nz, tx, m, by;
};
template <class V> BN_FN frame<V> frame_of(const V& nx, const V& ny)
{
    const V nz = sqrt(max(lit(1.0) - (nx * nx + ny * ny), lit(1e-3)));
    const V s = lit(1.0) / (nz + lit(1.0)), xs = nx * s, ys = ny * s;
    return {nx, ny, nz, lit(1.0) - nx * xs, -(ny * xs), lit(1.0) - ny * ys};
}
template <class V> struct local {
    V t, b, n;
};
template <class V> BN_FN local<V> local_of(const frame<V>& f, const real3& w)
{
    return {f.tx * w.x + f.m * w.y - f.nx * w.z, f.m * w.x + f.by * w.y - f.ny * w.z, f.nx * w.x + f.ny * w.y + f.nz * w.z};
}

template <class V> struct lobe_place { // a texel, prepared for many directions
    frame<V> f;
    V a, b, c, det, inverse_det;
};
template <class V> BN_FN lobe_place<V> lobe_place_of(const texel<V>& x)
{
    const V det = x.a * x.b - x.c * x.c;
    return {frame_of(x.nx, x.ny), x.a, x.b, x.c, det, lit(1.0) / det};
}

struct light {
    real3 i, o, h;         // unit: to the light, to the eye, half vector
    real lh;               // cosine between light and half vector
    real fresnel, diffuse; // reflectances; diffuse over pi, or times 28 / 23 pi
    real intensity;
};
template <int lobe> BN_FN light light_of(const real3& i, const real3& o, real f0, real diffuse, real intensity)
{
    light l;
    l.i = i, l.o = o, l.h = k_normalize3(i + o);
    l.lh = max(k_dot3(i, l.h), lit(1e-4));
    const real g = lit(1.0) - min(l.lh, lit(1.0)), g2 = g * g;
    l.fresnel = f0 + (lit(1.0) - f0) * (g2 * g2 * g);
    l.diffuse = lobe == 2 ? diffuse * (lit(1.0) - f0) * lit(0.38750494) : diffuse * lit(0.31830988618379067);
    l.intensity = intensity;
    return l;
}

template <class V> BN_FN V projected2(const lobe_place<V>& x, const local<V>& w) // |M w|^2
{
    const V u = x.b * w.t - x.c * w.b, v = x.a * w.b - x.c * w.t;
    return u * u + v * v;
}
// Returns |M^-1 h|^2.
template <class V> BN_FN V stretched2(const lobe_place<V>& x, const local<V>& h)
{
    const V u = (x.a * h.t + x.c * h.b) * x.inverse_det, v = (x.c * h.t + x.b * h.b) * x.inverse_det;
    return u * u + v * v;
}
template <class V> BN_FN V ggx_normals(const lobe_place<V>& x, const local<V>& h) // 1/sr
{
    const V k = stretched2(x, h) + h.n * h.n;
    return x.inverse_det * lit(0.31830988618379067) / (k * k);
}
template <class V> BN_FN V beckmann_normals(const lobe_place<V>& x, const local<V>& h) // h.n > 0
{
    const V over = lit(1.0) / (h.n * h.n);
    return exp_of(-(stretched2(x, h) * over)) * x.inverse_det * (over * over) * lit(0.31830988618379067);
}
template <class V> BN_FN V beckmann_shadow(const lobe_place<V>& x, const local<V>& w) // Smith's Lambda, Walter et al. 2007's fit
{
    const V xi = w.n / sqrt(max(projected2(x, w), lit(1e-12))), k = min(xi, lit(1.6));
    const V fit = (lit(1.0) - k * lit(1.259) + k * k * lit(0.396)) / (k * lit(3.535) + k * k * lit(2.181));
    return fit * select(value(xi) < lit(1.6), lit(1.0), lit(0.0));
}
// Returns Ashikhmin-Shirley normals with exponents 1 / alpha^2, normalised, over 8 pi: (n.h)^e with e = stretched2 / sin^2. The
// exponential form stays accurate near n = h.
template <class V> BN_FN V phong_normals(const lobe_place<V>& x, const local<V>& h)
{
    const V sine2 = min(max(h.t * h.t + h.b * h.b, lit(1e-6)), lit(0.999));
    const V power = exp_of(stretched2(x, h) * (log1p_of(-sine2) / sine2) * lit(0.5));
    const V norm = sqrt(x.det * x.det + (x.a * x.a + x.b * x.b + x.c * x.c * lit(2.0)) + lit(1.0)) * x.inverse_det;
    return norm * power * lit(0.039788735772973836);
}

// Returns reflected radiance. lobe: number in Lobe of mipnet_fns.h. A texel that turns away from the light is dark. So is one that turns
// away from the eye, unless `seen_anyhow`: then it counts as at grazing angles, as in frames.
template <int lobe, bool seen_anyhow = false, class V> BN_FN V radiance(const lobe_place<V>& x, const light& l)
{
    local<V> h = local_of(x.f, l.h), i = local_of(x.f, l.i), o = local_of(x.f, l.o);
    const mask lit_side = value(i.n) > lit(1e-4), front = seen_anyhow ? lit_side : both(lit_side, value(o.n) > lit(1e-4));
    h.n = max(h.n, lit(1e-3)), i.n = max(i.n, lit(1e-4)), o.n = max(o.n, lit(1e-4));
    const real shown = select(front, l.intensity, lit(0.0));
    if constexpr (lobe == 0) {
        const V shadow_i = sqrt(projected2(x, i) + i.n * i.n), shadow_o = sqrt(projected2(x, o) + o.n * o.n);
        const V both_ways = lit(0.5) / (i.n * shadow_o + o.n * shadow_i);
        return (ggx_normals(x, h) * both_ways * l.fresnel + l.diffuse) * i.n * shown;
    } else if constexpr (lobe == 1) {
        const V seen = o.n * (beckmann_shadow(x, i) + beckmann_shadow(x, o) + lit(1.0));
        return (beckmann_normals(x, h) / seen * (l.fresnel * lit(0.25)) + i.n * l.diffuse) * shown;
    } else {
        const V gi = lit(1.0) - i.n * lit(0.5), go = lit(1.0) - o.n * lit(0.5);
        const V gi2 = gi * gi, go2 = go * go;
        const V diffuse = (lit(1.0) - gi2 * gi2 * gi) * (lit(1.0) - go2 * go2 * go);
        const V specular = phong_normals(x, h) / max(i.n, o.n);
        return (specular * (l.fresnel / l.lh) + diffuse * l.diffuse) * i.n * shown;
    }
}

// A tonemapped radiance, x / (1 + x) encoded as sRGB, and its derivative.
struct tone_pair {
    real shown, slope;
};
BN_FN tone_pair tone(real x)
{
    const real inverse = lit(1.0) / (x + lit(1.0)), y = x * inverse;
    const real safe = max(y, lit(0.0031308));
    const real bent = lit(1.055) * exp_of(log_of(safe) * lit(1.0 / 2.4));
    const mask straight = y <= lit(0.0031308);
    const real shown = select(straight, y * lit(12.92), bent - lit(0.055));
    const real slope = select(straight, lit(12.92), bent / (safe * lit(2.4)));
    return {shown, slope * (inverse * inverse)};
}

} // namespace mipnet_lanes
BN_KERNELS_END
