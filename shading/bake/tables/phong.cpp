#include "shading/bake/tables/phong.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

double rounded_exponent(double exponent)
{
    if (!(exponent > 0.0))
        return 0.0;
    double unit = 1e-12; // of the fifth digit
    while (unit * 99999.5 <= exponent)
        unit *= 10.0;
    return std::round(exponent / unit) * unit;
}

double phong_exponent(double alpha)
{
    return rounded_exponent(std::min(1.0 / std::max(alpha * alpha, 1e-6), kMostPhongExponent));
}

PhongHalfVector phong_half_vector(double nu, double nv, double xi_x, double xi_y)
{
    if (nu > nv) {
        const double turned = 1.25 - xi_x;
        const PhongHalfVector h = phong_half_vector(nv, nu, turned < 1.0 ? turned : turned - 1.0, xi_y);
        return {h.y, h.x, h.z, h.density};
    }
    const double azimuth = 2.0 * kPi * xi_x;
    const double x = std::sqrt(nv + 1.0) * det_cos(azimuth), y = std::sqrt(nu + 1.0) * det_sin(azimuth), length = std::sqrt(x * x + y * y);
    const double c = x / length, s = y / length, e = nu * c * c + nv * s * s, lg = det_log(1.0 - xi_y) / (e + 1.0);
    const double z = det_exp(lg), q = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {c * q, s * q, z, std::sqrt((nu + 1.0) * (nv + 1.0)) / (2.0 * kPi) * det_exp(e * lg)};
}

int phong_grid(int n)
{
    int grid = 256;
    while (grid < kPhongSets * n)
        grid *= 2;
    return grid;
}

PhongPoint phong_point(int i, int n, int set)
{
    if (n == 1)
        return {0.0, 0.0};
    constexpr double kTurn = 0.3819660112501051; // 2 - golden ratio
    const int at = kPhongSets * i + set;
    const double area = kPi * (at + 0.5) / (kPhongSets * n), row = 0.5 + at * kTurn;
    double low = 0.0, high = kPi; // half the angle of the disc's part before the row
    // Solve for that angle by bisection
    for (int step = 0; step < 24; ++step) {
        const double angle = 0.5 * (low + high);
        (angle - 0.5 * det_sin(2.0 * angle) < area ? low : high) = angle;
    }
    // Snap the point to the table's texels
    const double x = -det_cos(low), y = (2.0 * (row - std::floor(row)) - 1.0) * det_sin(low);
    const double turn = det_atan2(y, x) / (2.0 * kPi), grid = phong_grid(n);
    const auto held = [&](double xi) { return std::floor(xi * grid + 0.5); };
    const double column = held(turn < 0.0 ? turn + 1.0 : turn);
    return {column < grid ? column / grid : 0.0, std::min(held(x * x + y * y), grid - 1.0) / grid};
}

std::vector<PhongHalfVector> phong_half_vectors(double nu, double nv, int samples)
{
    const auto held = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    std::vector<PhongHalfVector> all;
    for (int i = 0; i < kPhongSets * samples; ++i) {
        const PhongPoint xi = phong_point(i % samples, samples, i / samples);
        const PhongHalfVector h = phong_half_vector(nu, nv, xi.x, xi.y);
        all.push_back({held(h.x), held(h.y), held(h.z), held(h.density)});
    }
    return all;
}

PhongAlbedo phong_albedo(const double (&v)[3], double nu, double nv, int points, int before)
{
    PhongAlbedo sum = {0.0, 0.0};
    for (int i = 0; i < points; ++i) {
        const double turn = static_cast<double>(static_cast<std::int64_t>(i) * before % points) + 0.5;
        const PhongHalfVector h = phong_half_vector(nu, nv, turn / points, (i + 0.5) / points);
        const double v_dot_h = v[0] * h.x + v[1] * h.y + v[2] * h.z, out = 2.0 * v_dot_h * h.z - v[2];
        if (!(out > 0.0))
            continue;
        const double weight = out / std::max(v[2], out), m = 1.0 - std::min(v_dot_h, 1.0), fresnel = m * m * m * m * m;
        sum.s += weight * (1.0 - fresnel), sum.b += weight * fresnel;
    }
    return {sum.s / points, sum.b / points};
}

void fill_phong_slice(int size, const std::function<PhongAlbedo(double, double)>& at, float* pairs)
{
    BN_CHECK(size >= 4 && size % 2 == 0);
    for (int j = 0; j < size / 2; ++j)
        for (int i = 0; i < size; ++i, pairs += 2) { // axes as in phong_slice_lookup()
            const PhongAlbedo a = at(static_cast<double>(i) / (size - 1), static_cast<double>(j) / (size / 2 - 1));
            pairs[0] = static_cast<float>(a.s), pairs[1] = static_cast<float>(a.b);
        }
}

PhongAlbedo phong_albedo_at(double nu, double nv, double root_n_dot_v, double root_along)
{
    const double n_dot_v = std::max(root_n_dot_v * root_n_dot_v, 1e-4), sine = std::sqrt(1.0 - n_dot_v * n_dot_v);
    const double along = root_along * root_along;
    return phong_albedo({sine * along, sine * std::sqrt(1.0 - along * along), n_dot_v}, std::min(nu, nv), std::max(nu, nv));
}

void bake_phong_slice(int size, double alpha_x, double alpha_y, float* pairs)
{
    const double nu = phong_exponent(alpha_x), nv = phong_exponent(alpha_y);
    fill_phong_slice(
        size, [&](double eye, double root) { return phong_albedo_at(nu, nv, eye, root); }, pairs);
}

} // namespace burnish
