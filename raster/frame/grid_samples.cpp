#include "raster/frame/grid_samples.h"

#include <algorithm>
#include <cmath>

#include "core/math/scalar_math.h"
#include "shading/kernels/math_special.k.h"

namespace burnish {

namespace {

GridSample ggx_sample(double azimuth, double v) // v: of the distribution of slopes, which is that of D h.z
{
    const double r2 = v / (1.0 - v), r = std::sqrt(r2);
    const double density = 1.0 / (kPi * (1.0 + r2) * (1.0 + r2));
    return {static_cast<float>(r * det_cos(azimuth)), static_cast<float>(r * det_sin(azimuth)), static_cast<float>(density)};
}

// Rings of equally many samples, in opposite pairs: an axis that turns to its opposite, as one does somewhere on every round thing, changes
// nothing. So an odd number is one in the middle and n - 1 rings of n + 1.
std::vector<GridSample> ggx_grid(int n)
{
    const bool middle = n % 2 == 1;
    const int rings = middle ? n - 1 : n, around = middle ? n + 1 : n;
    std::vector<GridSample> grid;
    if (middle)
        grid.push_back(ggx_sample(0.0, 0.0));
    const double first = middle ? 1.0 / (n * n) : 0.0;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < rings; ++j)
            grid.push_back(ggx_sample(2.0 * kPi * ((i + 0.5) / around), first + (1.0 - first) * ((j + 0.5) / rings)));
    return grid;
}

std::vector<GridSample> phong_set(int samples)
{
    std::vector<GridSample> set;
    for (int i = 0; i < kPhongSets * samples; ++i) {
        const PhongPoint xi = phong_point(i % samples, samples, i / samples);
        const double azimuth = 2.0 * kPi * xi.x;
        set.push_back(
            {static_cast<float>(det_cos(azimuth)), static_cast<float>(det_sin(azimuth)), static_cast<float>(det_log(1.0 - xi.y))});
    }
    return set;
}

} // namespace

void add_half_vectors(const std::vector<PhongHalfVector>& half_vectors, std::vector<GridSample>& to)
{
    for (const PhongHalfVector& h : half_vectors) {
        to.push_back({static_cast<float>(h.x), static_cast<float>(h.y), static_cast<float>(h.z)});
        const double bits = det_log(std::max(h.density, 1e-30)) / det_log(2.0);
        to.push_back({static_cast<float>(0.5 * bits), 0.0f, 0.0f});
    }
}

int grid_count(const std::vector<GridSample>& grid, int traits)
{
    return static_cast<int>(grid.size()) / ((traits & kPhongGrid) ? kPhongSets : 1);
}

std::vector<GridSample> grid_samples(int samples, Sampling sampling, int traits)
{
    if (traits & kPhongGrid)
        return phong_set(samples);
    if (sampling != Sampling::grid)
        return {};
    int n = 1;
    while ((n + 1) * (n + 1) <= samples)
        ++n;
    if (traits & kGgxGrid)
        return ggx_grid(n);
    std::vector<GridSample> grid;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = (i + 0.5) / n, v = (j + 0.5) / n;
            const double x = static_cast<double>(k_erfinv(static_cast<float>(2.0 * u - 1.0)));
            const double y = static_cast<double>(k_erfinv(static_cast<float>(2.0 * v - 1.0)));
            grid.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(det_exp(-x * x - y * y) / kPi)});
        }
    return grid;
}

} // namespace burnish
