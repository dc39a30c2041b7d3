// Shading frames.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/lanes/kernels.h"

namespace burnish::test {
namespace {

double dot(const double* a, const double* b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Also where a normal map turns the normal into the tangent.
TEST(frame, of_a_mapped_normal_is_orthonormal)
{
    const double normals[][3] = {{0, 0, 1}, {0, -3, 0}, {1, 0, 0}, {0.6, 0.48, -0.64}, {0.3, -0.6, 0.7}};
    const double maps[][3] = {{0, 0, 1},    {0.5, -0.2, 0.8}, {1, 0, 0},    {-1, 0, 0},  {0.4, 0, 0},
                              {1, 0, 1e-9}, {0, 1, 0},        {1, 1e-5, 0}, {1, 3e-4, 0}};
    for (const IsaFns& kernels : all_fns())
        for (const auto& n : normals)
            for (const auto& map : maps)
                for (double handedness : {1.0, -1.0}) {
                    const std::vector<double> in = {n[0], n[1], n[2], 0.7, 0.2, 0.9, handedness, map[0], map[1], map[2]};
                    const std::vector<double> f = call(kernels, "mapped_frame", in);
                    for (std::size_t i = 0; i < 3; ++i)
                        for (std::size_t j = i; j < 3; ++j)
                            EXPECT_NEAR(dot(&f[3 * i], &f[3 * j]), i == j ? 1.0 : 0.0, i == j ? 1e-5 : 2e-3)
                                << kernels.name << ", normal " << n[0] << " " << n[1] << " " << n[2] << ", map " << map[0] << " " << map[1]
                                << " " << map[2];
                    const double c[3] = {f[1] * f[5] - f[2] * f[4], f[2] * f[3] - f[0] * f[5], f[0] * f[4] - f[1] * f[3]};
                    EXPECT_NEAR(dot(c, &f[6]), handedness, 1e-3);
                }
}

// What is left of the tangent is kept, also where it is little.
TEST(frame, of_a_mapped_normal_keeps_its_tangent)
{
    for (const IsaFns& kernels : all_fns())
        for (double up : {1.0, 0.1, 1e-3}) {
            const std::vector<double> in = {0, 0, 1, 1, 0, 0, 1, 1, 0, up};
            const std::vector<double> f = call(kernels, "mapped_frame", in);
            const double length = std::sqrt(1.0 + up * up);
            EXPECT_NEAR(f[3], up / length, 1e-3) << kernels.name << " " << up; // away from the normal
            EXPECT_NEAR(f[5], -1.0 / length, 1e-3) << kernels.name << " " << up;
        }
}

} // namespace
} // namespace burnish::test
