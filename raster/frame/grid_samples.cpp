#include "raster/frame/grid_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/scalar_math.h"
#include "shading/kernels/math_special.k.h"

namespace burnish {

namespace {

GridSample ggx_sample(double azimuth, double v) // v: cumulative share of the slope distribution, the distribution of D h.z
{
    const double r2 = v / (1.0 - v), r = std::sqrt(r2);
    const double density = 1.0 / (kPi * (1.0 + r2) * (1.0 + r2));
    return {static_cast<float>(r * det_cos(azimuth)), static_cast<float>(r * det_sin(azimuth)), static_cast<float>(density)};
}

// Returns rings with equally many samples, in opposite pairs. An axis field on a closed surface flips somewhere to the opposite axis; with
// such pairs the flip changes nothing. An odd n gives one central sample and n - 1 rings of n + 1 samples.
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

// Appends kPhongBlock samples, which are 16 floats: value c of set k lies at 4 c + k.
template <class Values> void add_block(Values of_set, std::vector<GridSample>& to)
{
    float values[3 * kPhongBlock] = {};
    for (int k = 0; k < kPhongSets; ++k) {
        const std::array<double, 4> v = of_set(k);
        for (std::size_t c = 0; c < 4; ++c)
            values[4 * c + static_cast<std::size_t>(k)] = static_cast<float>(v[c]);
    }
    for (int i = 0; i < kPhongBlock; ++i)
        to.push_back({values[3 * i], values[3 * i + 1], values[3 * i + 2]});
}

std::vector<GridSample> phong_set(int samples)
{
    std::vector<GridSample> set;
    for (int i = 0; i < samples; ++i)
        add_block(
            [&](int k) {
                const PhongPoint xi = phong_point(i, samples, k);
                const double azimuth = 2.0 * kPi * xi.x;
                return std::array<double, 4>{det_cos(azimuth), det_sin(azimuth), det_log(1.0 - xi.y), 0.0};
            },
            set);
    return set;
}

} // namespace

void add_half_vectors(const std::vector<PhongHalfVector>& half_vectors, std::vector<GridSample>& to)
{
    const int samples = static_cast<int>(half_vectors.size()) / kPhongSets;
    for (int i = 0; i < samples; ++i)
        add_block(
            [&](int k) {
                const PhongHalfVector& h = half_vectors[static_cast<std::size_t>(k * samples + i)];
                const double bits = det_log(std::max(h.density, 1e-30)) / det_log(2.0);
                return std::array<double, 4>{h.x, h.y, h.z, 0.5 * bits};
            },
            to);
}

int grid_count(const std::vector<GridSample>& grid, int traits)
{
    return static_cast<int>(grid.size()) / ((traits & kPhongGrid) ? kPhongBlock : 1);
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
