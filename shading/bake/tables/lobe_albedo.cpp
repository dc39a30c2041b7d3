// Bakes directional albedo for lobes with two widths, by quadrature over visible normals as in dfg.cpp: anisotropic GGX with
// height-correlated Smith masking-shadowing (Heitz 2014). Fewer symmetries are left, so the points are a Fibonacci lattice.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "shading/bake/environment/environment.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

constexpr int kPoints = 233, kGenerator = 144; // neighbours in the Fibonacci sequence

struct Point { // on the spherical cap behind visible normals: depth from its top over its height, azimuth, weight
    double depth, cosine, sine, weight;
};

std::array<Point, kPoints> lattice()
{
    std::array<Point, kPoints> points;
    for (int i = 0; i < kPoints; ++i) {
        // Grade towards the far end, where a narrow strip holds the widely tilted normals
        const double t = 1.0 - (i + 0.5) / kPoints, azimuth = 2.0 * kPi * (i * kGenerator % kPoints) / kPoints;
        points[static_cast<std::size_t>(i)] = {1.0 - t * t, det_cos(azimuth), det_sin(azimuth), 2.0 * t / kPoints};
    }
    return points;
}

struct Vec {
    double x, y, z;
};
struct ScaleBias {
    double scale, bias;
};

// Integrates one entry. v: to the eye, unit, v.z > 0. Widths at least 1e-3.
ScaleBias integrate(const Vec& v, double alpha_x, double alpha_y, const std::array<Point, kPoints>& points)
{
    const auto stretch = [&](double x, double y, double z) {
        return std::sqrt(alpha_x * x * (alpha_x * x) + alpha_y * y * (alpha_y * y) + z * z);
    };
    const double length = stretch(v.x, v.y, v.z);
    const Vec w = {alpha_x * v.x / length, alpha_y * v.y / length, v.z / length};
    ScaleBias sum = {0.0, 0.0};
    for (const Point& p : points) {
        const double z = 1.0 - p.depth * (1.0 + w.z), rho = std::sqrt(std::max(0.0, 1.0 - z * z));
        const double hx = alpha_x * (rho * p.cosine + w.x), hy = alpha_y * (rho * p.sine + w.y), hz = std::max(z + w.z, 0.0);
        const double h2 = hx * hx + hy * hy + hz * hz, v_dot_h = v.x * hx + v.y * hy + v.z * hz, twice = 2.0 * v_dot_h / h2;
        const double lx = twice * hx - v.x, ly = twice * hy - v.y, lz = twice * hz - v.z;
        if (!(lz > 0.0))
            continue;
        const double g = lz * (v.z + length) / (lz * length + v.z * stretch(lx, ly, lz)) * p.weight; // G2 / G1(v)
        const double m = 1.0 - std::min(v_dot_h / std::sqrt(h2), 1.0), fresnel = m * m * m * m * m;
        sum.scale += (1.0 - fresnel) * g;
        sum.bias += fresnel * g;
    }
    return sum;
}

// Returns the entry for one view. eye, azimuth: [0,1], positions along the table's axes.
ScaleBias entry(double eye, double azimuth, double alpha_x, double alpha_y, const std::array<Point, kPoints>& points)
{
    const double n_dot_v = std::max(eye * eye, 1e-4), sine = std::sqrt(1.0 - n_dot_v * n_dot_v);
    if (alpha_x + alpha_y == 0.0) { // a mirror: plain Schlick Fresnel
        const double m = 1.0 - eye * eye, fresnel = m * m * m * m * m;
        return {1.0 - fresnel, fresnel};
    }
    const double along = azimuth * azimuth, across = std::sqrt(1.0 - along * along);
    return integrate({sine * along, sine * across, n_dot_v}, std::max(alpha_x, 1e-3), std::max(alpha_y, 1e-3), points);
}

void put(float* pair, const ScaleBias& r)
{
    pair[0] = static_cast<float>(r.scale), pair[1] = static_cast<float>(r.bias);
}

double step(std::size_t i, std::size_t count)
{
    return static_cast<double>(i) / static_cast<double>(count - 1);
}

} // namespace

Column<float> bake_lobe_albedo(int size, const Jobs& jobs)
{
    BN_CHECK(size >= 4 && size % 2 == 0);
    const std::size_t n = static_cast<std::size_t>(size), half = n / 2;
    Column<float> pairs;
    pairs.resize(2 * n * n * half * half);
    const std::array<Point, kPoints> points = lattice();
    jobs.parallel_for(n * half * half, [&](std::size_t row, int) {
        const double roughness = step(row % n, n), azimuth = step(row / n % half, half), narrow = 1.0 - step(row / n / half, half);
        const double alpha = roughness * roughness, eta = 1.0 - narrow * narrow;
        for (std::size_t x = 0; x < n; ++x)
            put(pairs.data() + 2 * (row * n + x), entry(step(x, n), azimuth, alpha * (1.0 + eta), alpha * (1.0 - eta), points));
    });
    return pairs;
}

void bake_lobe_slice(double alpha_x, double alpha_y, float* pairs)
{
    const std::size_t n = kLobeSliceSize, half = n / 2;
    const std::array<Point, kPoints> points = lattice();
    for (std::size_t i = 0; i < n * half; ++i) { // where lobe_slice_lookup() finds it
        const double x = step(i % n, n), z = step(i / n, half), along = z / std::sqrt(z * z + 9.0 * (1.0 - z) * (1.0 - z));
        put(pairs + 2 * i, entry(std::sqrt(std::min(0.2 * x / (1.2 - x), 1.0)), std::sqrt(along), alpha_x, alpha_y, points));
    }
}

} // namespace burnish
