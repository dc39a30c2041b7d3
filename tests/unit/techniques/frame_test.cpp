// Shading frames.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/techniques/kernels.h"

namespace burnish::test {
namespace {

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::vector<TechniqueKernels> all_kernels()
{
    std::vector<TechniqueKernels> all = float_kernels();
    all.push_back(oracle_kernels());
    return all;
}

// A normal map may turn the normal into the tangent; meshes hold tangents that are none.
TEST(frame, is_orthonormal_whatever_the_tangent)
{
    const double normals[][3] = {{0, 0, 1}, {0, -3, 0}, {1, 0, 0}, {0.6, 0.48, -0.64}, {0.3, -0.6, 0.7}, {-0.7, 0.1, 0.72}, {1e-3, 0, 1}};
    const auto check = [](const TechniqueKernels& kernels, const double* n, double tx, double ty, double tz) {
        for (double handedness : {1.0, -1.0}) {
            const double in[7] = {n[0], n[1], n[2], tx, ty, tz, handedness};
            double f[9];
            kernels.geometric_frame(in, f);
            for (int i = 0; i < 3; ++i)
                for (int j = i; j < 3; ++j)
                    EXPECT_NEAR(dot(f + 3 * i, f + 3 * j), i == j ? 1.0 : 0.0, 1e-5)
                        << kernels.name << ", normal " << n[0] << " " << n[1] << " " << n[2] << ", tangent " << tx << " " << ty << " " << tz;
            const double c[3] = {f[1] * f[5] - f[2] * f[4], f[2] * f[3] - f[0] * f[5], f[0] * f[4] - f[1] * f[3]};
            EXPECT_NEAR(dot(c, f + 6), handedness, 1e-5);
        }
    };
    for (const TechniqueKernels& kernels : all_kernels())
        for (const auto& n : normals) {
            for (double along : {1.0, -1.0, 0.3, 0.0})
                check(kernels, n, along * n[0], along * n[1], along * n[2]);
            check(kernels, n, 0.36, 0.48, 0.8);
        }
}

// What a tangent says is kept, also where it is nearly the normal.
TEST(frame, keeps_its_tangent)
{
    for (const TechniqueKernels& kernels : all_kernels())
        for (double off : {1.0, 0.1, 1e-4}) {
            const double in[7] = {0, 0, 1, 0.6 * off, 0.8 * off, 1, 1};
            double f[9];
            kernels.geometric_frame(in, f);
            EXPECT_NEAR(f[3], 0.6, 1e-4) << kernels.name << " " << off;
            EXPECT_NEAR(f[4], 0.8, 1e-4) << kernels.name << " " << off;
        }
}

} // namespace
} // namespace burnish::test
