#include "raster/reference/environment_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "core/simd/half.h"

namespace burnish {
namespace {

constexpr int kFaces = 6;

double luminance(const std::uint16_t* texel)
{
    return 0.2126 * static_cast<double>(half_to_float(texel[0])) + 0.7152 * static_cast<double>(half_to_float(texel[1])) +
           0.0722 * static_cast<double>(half_to_float(texel[2]));
}

// Returns the bilinear interpolant's mean luminance over the cell of texel x. The mean is positive wherever the interpolant is positive,
// so sampling misses no light. rows: luminances of three bordered rows, w texels each.
double cell_luminance(const double* rows, std::size_t w, std::size_t x)
{
    constexpr double kWeight[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i)
            sum += kWeight[i] * kWeight[j] * rows[j * w + x + i];
    return std::max(sum, 0.0);
}

// Returns solid angle over area at (u, v) on a face, [-1,1]^2.
double solid_angle_density(double u, double v)
{
    const double r2 = 1.0 + u * u + v * v;
    return 1.0 / (r2 * std::sqrt(r2));
}

// Probability masses by level, the finest last.
using MassLevels = std::vector<std::vector<double>>;

constexpr int kRows = 16; // at once: each needs the luminances of its neighbours

// Fills the masses of a group, which is kRows rows of one face; the last group of a face may have fewer.
void fill_masses(const CubeMap& cube, std::size_t group, std::vector<double>& mass)
{
    const int size = cube.size, w = size + 2, groups = (size + kRows - 1) / kRows;
    const int face = static_cast<int>(group) / groups, begin = static_cast<int>(group) % groups * kRows,
              end = std::min(begin + kRows, size);
    const std::size_t wide = static_cast<std::size_t>(w), side = static_cast<std::size_t>(size);
    const std::uint16_t* const first =
        cube.texels.data() + 4 * (std::size_t{cube.offset[0]} + static_cast<std::size_t>(face * w + begin) * wide);
    std::vector<double> lit(static_cast<std::size_t>(end - begin + 2) * wide);
    for (std::size_t i = 0; i < lit.size(); ++i)
        lit[i] = luminance(first + 4 * i);
    for (int y = begin; y < end; ++y) {
        const double v = (y + 0.5) / size * 2.0 - 1.0;
        double* const to = &mass[static_cast<std::size_t>(face * size + y) * side];
        for (std::size_t x = 0; x < side; ++x) {
            const double u = (static_cast<double>(x) + 0.5) / size * 2.0 - 1.0;
            to[x] = cell_luminance(&lit[static_cast<std::size_t>(y - begin) * wide], wide, x) * solid_angle_density(u, v);
        }
    }
}

MassLevels sum_masses(const CubeMap& cube, int levels, const Jobs& jobs)
{
    const int size = cube.size;
    MassLevels mass(static_cast<std::size_t>(levels) + 1);
    mass.back().resize(std::size_t{kFaces} * static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    const int groups = (size + kRows - 1) / kRows;
    jobs.parallel_for(static_cast<std::size_t>(kFaces * groups), [&](std::size_t group, int) { fill_masses(cube, group, mass.back()); });
    for (int l = levels - 1; l >= 0; --l) {
        const std::size_t side = std::size_t{1} << l;
        const std::vector<double>& fine = mass[static_cast<std::size_t>(l) + 1];
        std::vector<double>& to = mass[static_cast<std::size_t>(l)];
        to.resize(kFaces * side * side);
        for (std::size_t row = 0; row < kFaces * side; ++row) // rows of all faces are consecutive on both levels
            for (std::size_t x = 0; x < side; ++x) {
                const double* upper = &fine[(2 * row) * 2 * side + 2 * x];
                const double* lower = upper + 2 * side;
                to[row * side + x] = (upper[0] + lower[0]) + (upper[1] + lower[1]);
            }
    }
    return mass;
}

// Accumulates the faces' shares. Returns the sum of their masses.
double accumulate_faces(const std::vector<double>& faces, EnvironmentSamplerView& view)
{
    double total = 0.0;
    for (int f = 0; f < kFaces; ++f)
        total += faces[static_cast<std::size_t>(f)];
    double sum = 0.0;
    for (int f = 0; f < kFaces; ++f) {
        sum += faces[static_cast<std::size_t>(f)];
        view.face_end[f] = total > 0.0 ? static_cast<float>(sum / total) : static_cast<float>(f + 1) / 6.0f;
    }
    view.face_end[5] = 1.0f;
    return total;
}

// Stores the shares of all nodes.
void store_nodes(const MassLevels& mass, const Jobs& jobs, EnvironmentSampler& s)
{
    const int levels = s.view.levels;
    std::size_t nodes = 0;
    for (int l = 0; l < levels; ++l) {
        s.view.offset[l] = static_cast<std::int32_t>(nodes);
        nodes += std::size_t{kFaces} << (2 * l);
    }
    s.left.resize(nodes), s.upper.resize(2 * nodes);
    const auto share = [](double part, double whole) { return whole > 0.0 ? static_cast<float>(part / whole) : 0.5f; };
    for (int l = 0; l < levels; ++l) {
        const std::size_t side = std::size_t{1} << l, at = static_cast<std::size_t>(s.view.offset[l]);
        const std::vector<double>& fine = mass[static_cast<std::size_t>(l) + 1];
        jobs.parallel_for(kFaces * side, [&](std::size_t row, int) {
            for (std::size_t x = 0; x < side; ++x) {
                const double* upper = &fine[(2 * row) * 2 * side + 2 * x];
                const double* lower = upper + 2 * side;
                const double left = upper[0] + lower[0], right = upper[1] + lower[1];
                const std::size_t node = at + row * side + x;
                s.left[node] = share(left, left + right);
                s.upper[2 * node] = share(upper[0], left);
                s.upper[2 * node + 1] = share(upper[1], right);
            }
        });
    }
}

} // namespace

EnvironmentSampler make_environment_sampler(const CubeMap& cube, const Jobs& jobs)
{
    EnvironmentSampler s;
    const int size = cube.size;
    int levels = 0;
    while (1 << levels < size)
        ++levels;
    BN_CHECK_OP(levels, <, kMaxSamplerLevels);
    const MassLevels mass = sum_masses(cube, levels, jobs);
    const std::vector<double>& finest = mass.back();
    EnvironmentSamplerView& view = s.view = {};
    view.levels = levels, view.size = size;
    const double total = accumulate_faces(mass[0], view);
    store_nodes(mass, jobs, s);

    // Store the texels' densities
    s.density.resize(finest.size());
    const double cells_of_area = static_cast<double>(size) * size / 4.0; // cells per unit area
    jobs.parallel_for(kFaces * static_cast<std::size_t>(size), [&](std::size_t row, int) {
        for (std::size_t i = row * static_cast<std::size_t>(size); i < (row + 1) * static_cast<std::size_t>(size); ++i)
            s.density[i] = total > 0.0 ? static_cast<float>(finest[i] / total * cells_of_area)
                                       : static_cast<float>(cells_of_area / static_cast<double>(finest.size()));
    });
    view.left = s.left.data(), view.upper = s.upper.data(), view.density = s.density.data();
    s.mean_luminance = total / cells_of_area / (4.0 * kPi) * static_cast<double>(cube.scale);
    return s;
}

} // namespace burnish
