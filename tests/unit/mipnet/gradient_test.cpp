// Gradients against central differences, in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/image/image.h"
#include "core/math/scalar_math.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mipnet/net.h"
#include "shading/bake/mipnet/texels.h"
#include "tests/unit/lanes/kernels.h"

namespace burnish::mipnet {
namespace {

// Compares partial derivatives with central differences. After every result a kernel returns its partials by the first five (or fewer)
// arguments.
void check_kernel(const char* kernel, const std::function<std::vector<double>(Random&)>& arguments, int points, int partials)
{
    Random random(11);
    for (int k = 0; k < points; ++k) {
        const std::vector<double> at = arguments(random);
        const std::vector<double> found = test::call(test::oracle_fns(), kernel, at);
        for (int p = 0; p < partials; ++p) {
            const double step = 1e-6;
            std::vector<double> more = at, less = at;
            more[static_cast<std::size_t>(p)] += step, less[static_cast<std::size_t>(p)] -= step;
            const std::vector<double> high = test::call(test::oracle_fns(), kernel, more),
                                      low = test::call(test::oracle_fns(), kernel, less);
            for (std::size_t r = 0; r < found.size(); r += 6) {
                const double wanted = (high[r] - low[r]) / (2.0 * step), own = found[r + 1 + static_cast<std::size_t>(p)];
                EXPECT_NEAR(own, wanted, 1e-5 * std::max(1.0, std::fabs(wanted))) << kernel << " result " << r / 6 << " by " << p;
            }
        }
    }
}

std::vector<double> some_texel(Random& random)
{
    const Tensor t = tensor_of(random.between(0.1, 0.8), random.between(0.1, 0.8), random.between(-3.0, 3.0));
    return {random.between(-0.5, 0.5), random.between(-0.5, 0.5), t.a, t.b, t.c};
}

std::vector<double> up(Random& random, double least = 0.75)
{
    const double z = random.between(least, 0.98), turn = random.between(0.0, 6.2), r = std::sqrt(1.0 - z * z);
    return {r * det_cos(turn), r * det_sin(turn), z};
}

std::vector<double> some_light(Random& random)
{
    std::vector<double> all = some_texel(random);
    for (int k = 0; k < 2; ++k) {
        const std::vector<double> d = up(random);
        all.insert(all.end(), d.begin(), d.end());
    }
    all.insert(all.end(), {random.between(0.04, 0.9), random.between(0.0, 0.8)});
    return all;
}

TEST(gradient, of_projection_and_frame)
{
    check_kernel("projected", some_texel, 50, 5);
    // Outside the domain, where values are clamped.
    check_kernel(
        "projected",
        [](Random& r) {
            return std::vector<double>{r.between(0.9, 1.4), r.between(0.9, 1.4), r.between(0.3, 0.5), 1.3, 2.0};
        },
        20, 5);
    check_kernel(
        "projected",
        [](Random& r) {
            return std::vector<double>{0.1, 0.2, r.between(0.3, 0.5), r.between(0.2, 0.6), r.between(0.9, 1.2)};
        },
        20, 5);
    check_kernel(
        "frame",
        [](Random& r) {
            return std::vector<double>{r.between(-0.6, 0.6), r.between(-0.6, 0.6)};
        },
        50, 2);
}

TEST(gradient, of_three_lobes)
{
    for (const char* lobe : {"radiance_ggx", "radiance_beckmann", "radiance_phong"})
        check_kernel(lobe, some_light, 200, 5);
}

} // namespace
} // namespace burnish::mipnet
