#include "shading/bake/mipnet/classical.h"

#include <algorithm>
#include <cmath>

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

struct Axes { // T, B, n: see frame_of() in tensor.h
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

// Returns the texel with this normal and M^2 in its frame.
State state_of(double nx, double ny, const Symmetric2& m2)
{
    const double d = std::sqrt(std::max(m2.xx * m2.yy - m2.xy * m2.xy, 0.0));
    const double root = 1.0 / std::sqrt(std::max(m2.xx + m2.yy + 2.0 * d, 1e-30));
    return {nx, ny, root * (m2.yy + d), root * (m2.xx + d), -root * m2.xy};
}

// Returns J S J^T with J = [[j0, j1], [j2, j3]].
Symmetric2 carried(const double j[4], const Symmetric2& s)
{
    const double t0 = j[0] * s.xx + j[1] * s.xy, t1 = j[0] * s.xy + j[1] * s.yy, b0 = j[2] * s.xx + j[3] * s.xy,
                 b1 = j[2] * s.xy + j[3] * s.yy;
    return {t0 * j[0] + t1 * j[1], t0 * j[2] + t1 * j[3], b0 * j[2] + b1 * j[3]};
}

struct Part { // a texel in a footprint
    std::size_t at;
    double weight; // weights sum to 1
};

// Returns the `from` texels under `to`'s texel `at` along an axis, with their shares.
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
    // Average normals and widths
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
    // Average squared widths in the mean frame, with the covariance of normals
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

void put_state(Texels& to, std::size_t at, const State& s)
{
    const double v[kChannels] = {s.nx, s.ny, s.a, s.b, s.c};
    for (std::size_t c = 0; c < kChannels; ++c)
        to.channel[c][at] = static_cast<float>(v[c]);
}

} // namespace

int side_of_level(int side, int level)
{
    return std::max(1, side >> level);
}

Texels shrunk(const Texels& from, int width, int height, Method method, double kappa)
{
    Texels to = make_texels(width, height);
    for (int y = 0; y < height; ++y) {
        const std::vector<Part> rows = parts_of(from.height, height, y);
        for (int x = 0; x < width; ++x) {
            std::vector<Part> parts;
            for (const Part& column : parts_of(from.width, width, x))
                for (const Part& row : rows)
                    parts.push_back({row.at * static_cast<std::size_t>(from.width) + column.at, row.weight * column.weight});
            put_state(to, static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
                      mean_of(from, parts, method, kappa));
        }
    }
    make_valid(to);
    return to;
}

std::vector<Texels> classical_pyramid(const Texels& level0, Method method, double kappa)
{
    std::vector<Texels> levels = {level0};
    while (levels.back().width > 1 || levels.back().height > 1) {
        const int level = static_cast<int>(levels.size());
        levels.push_back(shrunk(levels.back(), side_of_level(level0.width, level), side_of_level(level0.height, level), method, kappa));
    }
    return levels;
}

} // namespace burnish::mipnet
