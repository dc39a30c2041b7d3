#include "shading/bake/mipnet/classical.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace burnish::mipnet {
namespace {

struct Symmetric2 {
    double xx = 0.0, xy = 0.0, yy = 0.0;
};

struct State { // of a texel
    double nx, ny, a, b, c;
};

State state_at(const Texels& t, std::size_t i)
{
    return {static_cast<double>(t.channel[0][i]), static_cast<double>(t.channel[1][i]), static_cast<double>(t.channel[2][i]),
            static_cast<double>(t.channel[3][i]), static_cast<double>(t.channel[4][i])};
}

struct Axes { // T, B, n: see frame_of() of tensor.h
    double t[3], b[3], n[3];
};
Axes axes_of(double nx, double ny)
{
    const double nz = std::sqrt(std::max(1.0 - nx * nx - ny * ny, 1e-3)), s = 1.0 / (1.0 + nz);
    return {{1.0 - nx * nx * s, -nx * ny * s, -nx}, {-nx * ny * s, 1.0 - ny * ny * s, -ny}, {nx, ny, nz}};
}
double dot3(const double* a, const double* b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Symmetric2 squared(const State& s) // M^2
{
    return {s.b * s.b + s.c * s.c, -(s.a + s.b) * s.c, s.a * s.a + s.c * s.c};
}

// The texel of a normal and of M^2 in its frame.
State state_of(double nx, double ny, const Symmetric2& m2)
{
    const double d = std::sqrt(std::max(m2.xx * m2.yy - m2.xy * m2.xy, 0.0));
    const double root = 1.0 / std::sqrt(std::max(m2.xx + m2.yy + 2.0 * d, 1e-30));
    return {nx, ny, root * (m2.yy + d), root * (m2.xx + d), -root * m2.xy};
}

// J S J^T of J = [[j0, j1], [j2, j3]]
Symmetric2 carried(const double j[4], const Symmetric2& s)
{
    const double t0 = j[0] * s.xx + j[1] * s.xy, t1 = j[0] * s.xy + j[1] * s.yy, b0 = j[2] * s.xx + j[3] * s.xy,
                 b1 = j[2] * s.xy + j[3] * s.yy;
    return {t0 * j[0] + t1 * j[1], t0 * j[2] + t1 * j[3], b0 * j[2] + b1 * j[3]};
}

struct Part { // of what lies below a texel
    std::size_t at;
    double weight; // all of them: 1
};

// Texels of `from` below texel `at` of `to` along an axis, with their shares.
std::vector<Part> parts_of(int from, int to, int at)
{
    const double scale = static_cast<double>(from) / to, begin = at * scale, end = begin + scale;
    std::vector<Part> parts;
    const int last = std::min(from - 1, static_cast<int>(std::ceil(end)) - 1);
    for (int i = static_cast<int>(begin); i <= last; ++i) {
        const double share = (std::min(end, i + 1.0) - std::max(begin, static_cast<double>(i))) / scale;
        if (share > 1e-9)
            parts.push_back({static_cast<std::size_t>(i), share});
    }
    return parts;
}

State mean_of(const Texels& from, const std::vector<Part>& parts, Method method, double kappa)
{
    double n[3] = {}, sum[3] = {};
    for (const Part& p : parts) {
        const State s = state_at(from, p.at);
        const Axes axes = axes_of(s.nx, s.ny);
        for (int k = 0; k < 3; ++k)
            n[k] += p.weight * axes.n[k];
        sum[0] += p.weight * s.a, sum[1] += p.weight * s.b, sum[2] += p.weight * s.c;
    }
    const double length = std::sqrt(dot3(n, n)), nx = n[0] / length, ny = n[1] / length;
    if (method == Method::baseline)
        return {nx, ny, sum[0], sum[1], sum[2]};
    const Axes mean = axes_of(nx, ny);
    Symmetric2 m2;
    for (const Part& p : parts) {
        const State s = state_at(from, p.at);
        const Axes axes = axes_of(s.nx, s.ny);
        const double j[4] = {dot3(mean.t, axes.t), dot3(mean.t, axes.b), dot3(mean.b, axes.t), dot3(mean.b, axes.b)};
        const Symmetric2 own = carried(j, squared(s));
        const double t = dot3(mean.t, axes.n), b = dot3(mean.b, axes.n);
        m2.xx += p.weight * (own.xx + kappa * t * t), m2.xy += p.weight * (own.xy + kappa * t * b);
        m2.yy += p.weight * (own.yy + kappa * b * b);
    }
    return state_of(nx, ny, m2);
}

// Mean slope u and covariance C of slopes about it, as a texel: M^2 = scale K C K^T, where K takes slopes to the frame of the mean normal.
State state_of_slopes(double ux, double uy, const Symmetric2& c, double scale)
{
    const double nz = 1.0 / std::sqrt(1.0 + ux * ux + uy * uy), nx = ux * nz, ny = uy * nz, s = 1.0 / (1.0 + nz);
    const double k[4] = {nz * (1.0 - nx * nx * s), -nz * nx * ny * s, -nz * nx * ny * s, nz * (1.0 - ny * ny * s)};
    Symmetric2 m2 = carried(k, c);
    m2.xx *= scale, m2.xy *= scale, m2.yy *= scale;
    return state_of(nx, ny, m2);
}

// Moments that average linearly: of ssgt the SGGX matrix xx, xy, yy, xn, yn, nn in the flat frame; of leadr mean slopes, second moments, 0.
struct Moments {
    double m[6] = {};
};

Moments moments_of(const State& s, Method method)
{
    const Axes f = axes_of(s.nx, s.ny);
    const Symmetric2 m2 = squared(s);
    if (method == Method::leadr) {
        // Covariance in the flat frame: half of M^2, by the inverse of K.
        const double nz = f.n[2], k = 1.0 / (nz * (1.0 + nz));
        const double back[4] = {(1.0 + s.nx * s.nx * k) / nz, s.nx * s.ny * k / nz, s.nx * s.ny * k / nz, (1.0 + s.ny * s.ny * k) / nz};
        const Symmetric2 c = carried(back, {0.5 * m2.xx, 0.5 * m2.xy, 0.5 * m2.yy});
        const double ux = s.nx / nz, uy = s.ny / nz;
        return {{ux, uy, c.xx + ux * ux, c.xy + ux * uy, c.yy + uy * uy, 0.0}};
    }
    const auto entry = [&](int i, int j) {
        return m2.xx * f.t[i] * f.t[j] + m2.xy * (f.t[i] * f.b[j] + f.b[i] * f.t[j]) + m2.yy * f.b[i] * f.b[j] + f.n[i] * f.n[j];
    };
    return {{entry(0, 0), entry(0, 1), entry(1, 1), entry(0, 2), entry(1, 2), entry(2, 2)}};
}

State state_of_moments(const Moments& x, Method method)
{
    const double* m = x.m;
    if (method == Method::leadr)
        return state_of_slopes(m[0], m[1], {std::max(m[2] - m[0] * m[0], 0.0), m[3] - m[0] * m[1], std::max(m[4] - m[1] * m[1], 0.0)}, 2.0);
    const double ux = m[3] / m[5], uy = m[4] / m[5];
    return state_of_slopes(ux, uy, {m[0] / m[5] - ux * ux, m[1] / m[5] - ux * uy, m[2] / m[5] - uy * uy}, 1.0);
}

void put_state(Texels& to, std::size_t at, const State& s)
{
    const double v[kChannels] = {s.nx, s.ny, s.a, s.b, s.c};
    for (std::size_t c = 0; c < kChannels; ++c)
        to.channel[c][at] = static_cast<float>(v[c]);
}

template <class Each> void each_texel(const Texels& from, Texels& to, const Each& each)
{
    for (int y = 0; y < to.height; ++y) {
        const std::vector<Part> rows = parts_of(from.height, to.height, y);
        for (int x = 0; x < to.width; ++x) {
            std::vector<Part> parts;
            for (const Part& column : parts_of(from.width, to.width, x))
                for (const Part& row : rows)
                    parts.push_back({row.at * static_cast<std::size_t>(from.width) + column.at, row.weight * column.weight});
            each(static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x), parts);
        }
    }
}

} // namespace

int side_of_level(int side, int level)
{
    return std::max(1, side >> level);
}

Texels shrunk(const Texels& from, int width, int height, Method method, double kappa)
{
    BN_CHECK(method == Method::baseline || method == Method::kappa);
    Texels to = make_texels(width, height);
    each_texel(from, to, [&](std::size_t at, const std::vector<Part>& parts) { put_state(to, at, mean_of(from, parts, method, kappa)); });
    make_valid(to);
    return to;
}

std::vector<Texels> classical_pyramid(const Texels& level0, Method method, double kappa)
{
    std::vector<Texels> levels = {level0};
    std::vector<Moments> moments, above;
    if (method == Method::ssgt || method == Method::leadr)
        for (std::size_t i = 0; i < level0.count(); ++i)
            moments.push_back(moments_of(state_at(level0, i), method));
    while (levels.back().width > 1 || levels.back().height > 1) {
        const int level = static_cast<int>(levels.size());
        const int width = side_of_level(level0.width, level), height = side_of_level(level0.height, level);
        if (moments.empty()) {
            levels.push_back(shrunk(levels.back(), width, height, method, kappa));
            continue;
        }
        Texels to = make_texels(width, height);
        above.assign(to.count(), {});
        each_texel(levels.back(), to, [&](std::size_t at, const std::vector<Part>& parts) {
            for (const Part& p : parts)
                for (int k = 0; k < 6; ++k)
                    above[at].m[k] += p.weight * moments[p.at].m[k];
            put_state(to, at, state_of_moments(above[at], method));
        });
        make_valid(to);
        moments.swap(above);
        levels.push_back(std::move(to));
    }
    return levels;
}

} // namespace burnish::mipnet
