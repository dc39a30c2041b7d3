// Computes one texel of a level from finer texels: the closed form that a net starts from, the net's input, and the use of its output.
//
// Layout `cov`. The closed form combines widths and normals of four texels in the frame of their mean normal: M^2 = mean of the texels'
// projected M^2 + kappa times the covariance of their normals. Here kappa = k0 + k1 v / (v + m), where v and m are the two traces. The net
// sees normals and widths relative to the closed form, in units of its width s. So only one input, log s, depends on the lobe's width. The
// five outputs o, times .25 g, shift the normal by s (o0 T + o1 B) and turn M into (I + O) M (I + O), O = [[o2, o4], [o4, o3]].
// g = u / (u + .01), where u is the mean square of the texels' inputs. Where texels agree, the closed form stays.
// Layout `paper`: inputs are the raw channels, and outputs are added to their mean.
#pragma once
#include "shading/bake/mipnet/tensor.h"

BN_KERNELS_BEGIN
namespace mipnet_lanes {

inline constexpr int kFeaturesOfFour = 26, kFeaturesOfAll = kFeaturesOfFour + 16 * 5 + 5; // for layout cov
inline constexpr int kRawOfFour = 20, kRawOfAll = kRawOfFour + 16 * 5 + 5;                // for layout paper
inline constexpr int kMostFeatures = kFeaturesOfAll + 64 * 5; // for nets that see sixty-four texels, after the others

template <class V> struct seen_texels {
    texel<V> four[4], sixteen[16], first; // `first`: net `a`'s result for the four
    texel<V> sixtyfour[64];
    bool all, far; // sixteen and first are valid; so are sixty-four
    V kappa0, kappa1;
};

template <class V> struct closed_form { // in layout paper, the mean
    frame<V> f;
    V xx, xy, yy;                   // M in the frame f
    V scale, inverse_scale, spread; // s; spread: v / s^2
    V gate;
    texel<V> mean;
};

template <class V> struct symmetric {
    V xx, xy, yy;
};
template <class V> BN_FN symmetric<V> squared_widths(const texel<V>& x) // M^2
{
    return {x.b * x.b + x.c * x.c, -((x.a + x.b) * x.c), x.a * x.a + x.c * x.c};
}

template <class V> BN_FN V tangent_part(const frame<V>& f, const frame<V>& n)
{
    return f.tx * n.nx + f.m * n.ny - f.nx * n.nz;
}
template <class V> BN_FN V bitangent_part(const frame<V>& f, const frame<V>& n)
{
    return f.m * n.nx + f.by * n.ny - f.ny * n.nz;
}

// Transforms a texel's M^2 from frame g to frame f.
template <class V> BN_FN symmetric<V> carried(const frame<V>& f, const frame<V>& g, const symmetric<V>& s)
{
    const V tt = f.tx * g.tx + f.m * g.m + f.nx * g.nx, tb = f.tx * g.m + f.m * g.by + f.nx * g.ny;
    const V bt = f.m * g.tx + f.by * g.m + f.ny * g.nx, bb = f.m * g.m + f.by * g.by + f.ny * g.ny;
    const V t0 = tt * s.xx + tb * s.xy, t1 = tt * s.xy + tb * s.yy, b0 = bt * s.xx + bb * s.xy, b1 = bt * s.xy + bb * s.yy;
    return {t0 * tt + t1 * tb, t0 * bt + t1 * bb, b0 * bt + b1 * bb};
}

template <class V> BN_FN closed_form<V> closed_form_of(const seen_texels<V>& x)
{
    frame<V> f[4];
    for (int j = 0; j < 4; ++j)
        f[j] = frame_of(x.four[j].nx, x.four[j].ny);
    const V sx = f[0].nx + f[1].nx + f[2].nx + f[3].nx, sy = f[0].ny + f[1].ny + f[2].ny + f[3].ny,
            sz = f[0].nz + f[1].nz + f[2].nz + f[3].nz;
    // Find the mean normal's frame
    const V over = lit(1.0) / sqrt(sx * sx + sy * sy + sz * sz);
    closed_form<V> r = {};
    r.f = frame_of(sx * over, sy * over);
    // Sum squared widths and the normals' covariance in it
    symmetric<V> m = {}, v = {};
    for (int j = 0; j < 4; ++j) {
        const symmetric<V> p = carried(r.f, f[j], squared_widths(x.four[j]));
        const V t = tangent_part(r.f, f[j]), b = bitangent_part(r.f, f[j]);
        if (j == 0)
            m = p, v = {t * t, t * b, b * b};
        else
            m = {m.xx + p.xx, m.xy + p.xy, m.yy + p.yy}, v = {v.xx + t * t, v.xy + t * b, v.yy + b * b};
    }
    const V trace_m = m.xx + m.yy, trace_v = v.xx + v.yy;
    const V kappa = x.kappa0 + x.kappa1 * (trace_v / (trace_v + trace_m));
    const V p = (m.xx + kappa * v.xx) * lit(0.25), q = (m.yy + kappa * v.yy) * lit(0.25), s = (m.xy + kappa * v.xy) * lit(0.25);
    // Take the root of a symmetric positive matrix without eigenvectors: (S + d I) / sqrt(trace S + 2 d), d = sqrt(det S).
    const V d = sqrt(max(p * q - s * s, lit(1e-12)));
    const V root = lit(1.0) / sqrt(p + q + d * lit(2.0));
    r.xx = root * (p + d), r.xy = root * s, r.yy = root * (q + d);
    const V scale2 = (p + q) * lit(0.5);
    r.scale = sqrt(scale2);
    r.inverse_scale = lit(1.0) / r.scale;
    r.spread = trace_v * lit(0.25) / scale2;
    return r;
}

// Writes five features of a texel relative to the closed form. They need the normal, not its frame.
template <class V> BN_FN void against(const closed_form<V>& c, const texel<V>& x, V* to)
{
    const V nz = sqrt(max(lit(1.0) - (x.nx * x.nx + x.ny * x.ny), lit(1e-3)));
    to[0] = (c.f.tx * x.nx + c.f.m * x.ny - c.f.nx * nz) * c.inverse_scale;
    to[1] = (c.f.m * x.nx + c.f.by * x.ny - c.f.ny * nz) * c.inverse_scale;
    to[2] = (x.b - c.xx) * c.inverse_scale;
    to[3] = (-x.c - c.xy) * c.inverse_scale;
    to[4] = (x.a - c.yy) * c.inverse_scale;
}
template <class V> BN_FN void channels_of(const texel<V>& x, V* to)
{
    to[0] = x.nx, to[1] = x.ny, to[2] = x.a, to[3] = x.b, to[4] = x.c;
}

// Writes a texel's features, in the order four, features of all, sixteen, first. Returns the closed form that outputs modify.
template <class V> BN_FN closed_form<V> look_cov(const seen_texels<V>& x, V* to)
{
    closed_form<V> c = closed_form_of(x);
    for (int j = 0; j < 4; ++j)
        against(c, x.four[j], to + 5 * j);
    to[20] = (c.xx - c.yy) * c.inverse_scale;
    to[21] = c.xy * c.inverse_scale;
    to[22] = log_of(c.scale) * lit(0.25);
    to[23] = c.f.nx, to[24] = c.f.ny;
    to[25] = c.spread;
    const V* of = to;
    int count = 20;
    if (x.all) {
        for (int j = 0; j < 16; ++j)
            against(c, x.sixteen[j], to + kFeaturesOfFour + 5 * j);
        against(c, x.first, to + kFeaturesOfFour + 80);
        for (int j = 0; x.far && j < 64; ++j)
            against(c, x.sixtyfour[j], to + kFeaturesOfAll + 5 * j);
        of = to + kFeaturesOfFour, count = 80;
    }
    V sum = of[0] * of[0];
    for (int k = 1; k < count; ++k)
        sum = sum + of[k] * of[k];
    const V u = sum * lit(4.0 / 80.0) * lit(x.all ? 0.25 : 1.0);
    c.gate = u / (u + lit(0.01));
    return c;
}

template <class V> BN_FN closed_form<V> look_paper(const seen_texels<V>& x, V* to)
{
    closed_form<V> c = {};
    for (int j = 0; j < 4; ++j)
        channels_of(x.four[j], to + 5 * j);
    V sum[5];
    for (int k = 0; k < 5; ++k)
        sum[k] = (to[k] + to[5 + k] + to[10 + k] + to[15 + k]) * lit(0.25);
    c.mean = {sum[0], sum[1], sum[2], sum[3], sum[4]};
    if (x.all) {
        for (int j = 0; j < 16; ++j)
            channels_of(x.sixteen[j], to + kRawOfFour + 5 * j);
        channels_of(x.first, to + kRawOfFour + 80);
        for (int j = 0; x.far && j < 64; ++j)
            channels_of(x.sixtyfour[j], to + kRawOfAll + 5 * j);
    }
    return c;
}

// Applies a net's outputs to the closed form.
template <class V, class W> BN_FN auto settle_cov(const closed_form<V>& c, const W* o)
{
    const V strength = c.gate * lit(0.25), shift = strength * c.scale;
    const auto dx = shift * o[0], dy = shift * o[1];
    const auto oxx = strength * o[2] + lit(1.0), oyy = strength * o[3] + lit(1.0), oxy = strength * o[4];
    const auto r00 = oxx * c.xx + oxy * c.xy, r01 = oxx * c.xy + oxy * c.yy, r10 = oxy * c.xx + oyy * c.xy, r11 = oxy * c.xy + oyy * c.yy;
    const auto xx = r00 * oxx + r01 * oxy, xy = r00 * oxy + r01 * oyy, yy = r10 * oxy + r11 * oyy;
    using T = texel<decltype(dx + c.f.nx)>;
    return proj(T{dx * c.f.tx + dy * c.f.m + c.f.nx, dx * c.f.m + dy * c.f.by + c.f.ny, yy, xx, -xy});
}
template <class V, class W> BN_FN auto settle_paper(const closed_form<V>& c, const W* o)
{
    using T = texel<decltype(c.mean.nx + o[0])>;
    return proj(T{c.mean.nx + o[0], c.mean.ny + o[1], c.mean.a + o[2], c.mean.b + o[3], c.mean.c + o[4]});
}

} // namespace mipnet_lanes
BN_KERNELS_END
