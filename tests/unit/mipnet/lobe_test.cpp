// Lobes from tensors: their normals equal the models' normals and conserve energy.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/scalar_math.h"
#include "shading/bake/mipnet/net.h"
#include "shading/bake/mipnet/texels.h"
#include "tests/unit/lanes/kernels.h"

namespace burnish::mipnet {
namespace {

std::vector<double> direction(double z, double turn)
{
    const double r = std::sqrt(std::max(1.0 - z * z, 0.0));
    return {r * det_cos(turn), r * det_sin(turn), z};
}

TEST(tensor, widths_come_back)
{
    Random random(5);
    for (int k = 0; k < 200; ++k) {
        const double along = random.between(0.05, 1.0), across = random.between(0.002, 0.9) * along, angle = random.between(-1.5, 1.5);
        const Tensor t = tensor_of(along, across, angle);
        const Widths w = widths_of(t);
        EXPECT_NEAR(w.alpha_along, along, 1e-12 + 1e-9 * along);
        EXPECT_NEAR(w.alpha_across, across, 1e-9);
        EXPECT_NEAR(w.angle, angle, 1e-6);
        EXPECT_NEAR(t.a * t.b - t.c * t.c, along * across, 1e-12);
    }
}

TEST(lobe, normals_are_those_of_the_models_in_their_own_axes)
{
    Random random(6);
    for (int k = 0; k < 500; ++k) {
        const double along = random.between(0.05, 0.9), across = random.between(0.05, 0.9), angle = random.between(-3.0, 3.0);
        const Tensor t = tensor_of(along, across, angle);
        const std::vector<double> own = direction(random.between(0.3, 0.999), random.between(0.0, 6.2));
        const double c = det_cos(angle), s = det_sin(angle);
        const std::vector<double> found =
            test::call(test::oracle_fns(), "normals", {0.0, 0.0, t.a, t.b, t.c, c * own[0] - s * own[1], s * own[0] + c * own[1], own[2]});
        const std::vector<double> wanted = test::call(test::oracle_fns(), "model_normals", {along, across, own[0], own[1], own[2]});
        for (std::size_t m = 0; m < 3; ++m)
            EXPECT_NEAR(found[m], wanted[m], 1e-6 * std::max(wanted[m], 1e-3)) << m;
    }
}

// Heitz 2014, "weak white furnace": visible normals integrate to one, for all widths and orientations.
TEST(lobe, normals_that_are_seen_are_one_whole)
{
    const double kCases[][3] = {{0.5, 0.2, 0.2}, {0.2, 0.5, -0.2}, {0.3, 0.3, 0.15}, {0.5, 0.2, 0.0}};
    for (const auto& t : kCases)
        for (double turn = 0.3; turn < 3.0; turn += 0.8) {
            const std::vector<double> eye = direction(0.45, turn);
            const int rows = 400, columns = 400;
            std::vector<double> in(11u * rows * columns);
            const std::size_t n = static_cast<std::size_t>(rows) * columns;
            for (std::size_t k = 0; k < n; ++k) {
                // Includes directions below the horizon, where masked normals reflect.
                const double z = (static_cast<double>(k / columns) + 0.5) / rows * 2.0 - 1.0;
                const std::vector<double> light = direction(z, (static_cast<double>(k % columns) + 0.5) / columns * 2.0 * kPi);
                const double values[] = {0.0, 0.0, t[0], t[1], t[2], eye[0], eye[1], eye[2], light[0], light[1], light[2]};
                for (std::size_t i = 0; i < 11; ++i)
                    in[i * n + k] = values[i];
            }
            const std::vector<double> out = test::call(test::oracle_fns(), "seen", in);
            double ggx = 0.0, beckmann = 0.0;
            for (std::size_t k = 0; k < n; ++k)
                ggx += out[k] * 4.0 * kPi / static_cast<double>(n), beckmann += out[n + k] * 4.0 * kPi / static_cast<double>(n);
            EXPECT_NEAR(ggx, 1.0, 0.005) << t[0] << " " << t[1] << " " << t[2] << " at " << turn;
            EXPECT_NEAR(beckmann, 1.0, 0.01) << t[0] << " " << t[1] << " " << t[2] << " at " << turn;
        }
}

TEST(lobe, half_vectors_of_the_phong_lobe_are_one_whole)
{
    const int rows = 600, columns = 200;
    const std::size_t n = static_cast<std::size_t>(rows) * columns;
    std::vector<double> in(8 * n);
    for (std::size_t k = 0; k < n; ++k) {
        const std::vector<double> h =
            direction((static_cast<double>(k / columns) + 0.5) / rows, (static_cast<double>(k % columns) + 0.5) / columns * 2.0 * kPi);
        const double values[] = {0.0, 0.0, 0.5, 0.2, 0.2, h[0], h[1], h[2]};
        for (std::size_t i = 0; i < 8; ++i)
            in[i * n + k] = values[i];
    }
    const std::vector<double> out = test::call(test::oracle_fns(), "normals", in);
    double sum = 0.0;
    for (std::size_t k = 0; k < n; ++k)
        sum += out[2 * n + k] * 2.0 * kPi / static_cast<double>(n);
    EXPECT_NEAR(sum, 1.0, 0.01);
}

} // namespace
} // namespace burnish::mipnet
