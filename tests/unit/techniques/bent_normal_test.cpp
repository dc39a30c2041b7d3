#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/lanes/kernels.h"

namespace burnish::test {
namespace {

struct Vector { // view (not unit), roughness, eta; bending factor; the bent normal, direction and level
    double v[3], roughness, eta, stretch, projected[3], normal[3], direction[3], lod;
};

TEST(bent_normal, equals_the_printed_test_vectors)
{
    const double x = .50507627, y = .30304576, z = .80812204; // the first view, unit
    const Vector vectors[] = {
        {{.5, .3, .8}, .4, .8, .75894664, {x, 0, z}, {.40934960, 0, .91237761}, {.26782916, -.30304576, .91456591}, .16},
        // the first view with eta = -0.8: the grain is x, the lobe's axes are y and x
        {{.3, .5, .8}, .4, .8, .75894664, {y, 0, z}, {.25994350, 0, .96562383}, {.14359783, -.50507627, .85104502}, .16},
        {{-.2, .9, .3}, .2, .5, .33541020, {-.20628425, 0, .30942637}, {-.08968415, 0, .99597026}, {.14768823, -.92827912, .34130054}, .14},
    };
    for (const Vector& t : vectors)
        for (const IsaFns& kernels : all_fns()) {
            const double l = std::sqrt(t.v[0] * t.v[0] + t.v[1] * t.v[1] + t.v[2] * t.v[2]), s = t.roughness * t.roughness / std::sqrt(2.0);
            const std::vector<double> in = {t.v[0] / l, t.v[1] / l, t.v[2] / l, s * (1 + t.eta), s * (1 - t.eta)};
            const std::vector<double> out = call(kernels, "bent_normal", in);
            double bent[3], mixed[3]; // the normal between direction and view; (1 - stretch) n + stretch projected
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_NEAR(out[i], t.direction[i], 2e-6) << kernels.name;
                bent[i] = out[i] + in[i];
                mixed[i] = t.stretch * t.projected[i] + (i == 2 ? 1 - t.stretch : 0);
            }
            const double length = std::hypot(bent[0], bent[1], bent[2]), mixed_length = std::hypot(mixed[0], mixed[1], mixed[2]);
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_NEAR(bent[i] / length, t.normal[i], 2e-6) << kernels.name;
                EXPECT_NEAR(mixed[i] / mixed_length, t.normal[i], 2e-6) << kernels.name;
            }
            EXPECT_NEAR(out[3], t.lod, 2e-6) << kernels.name;
        }
}

} // namespace
} // namespace burnish::test
