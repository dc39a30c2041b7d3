#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/techniques/kernels.h"

namespace burnish::test {
namespace {

struct Vector { // view (not unit), alpha_lin, eta; direction and level
    double v[3], alpha_lin, eta, direction[3], lod;
};

TEST(bent_normal, equals_the_printed_test_vectors)
{
    const Vector vectors[] = {
        {{.5, .3, .8}, .4, .8, {.26782916, -.30304576, .91456591}, .16},
        {{-.2, .9, .3}, .2, .5, {.14768823, -.92827912, .34130054}, .2 * .7},
    };
    std::vector<TechniqueKernels> all = float_kernels();
    all.push_back(oracle_kernels());
    for (const Vector& t : vectors)
        for (const TechniqueKernels& kernels : all) {
            const double l = std::sqrt(t.v[0] * t.v[0] + t.v[1] * t.v[1] + t.v[2] * t.v[2]), s = t.alpha_lin * t.alpha_lin / std::sqrt(2.0);
            const double in[5] = {t.v[0] / l, t.v[1] / l, t.v[2] / l, s * (1 + t.eta), s * (1 - t.eta)};
            double out[4];
            kernels.bent_normal(in, out);
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(out[i], t.direction[i], 2e-6) << kernels.name;
            EXPECT_NEAR(out[3], t.lod, 2e-6) << kernels.name;
        }
}

} // namespace
} // namespace burnish::test
