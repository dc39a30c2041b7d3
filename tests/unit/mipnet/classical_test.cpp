// Mip levels by closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "shading/bake/mipnet/classical.h"

namespace burnish::mipnet {
namespace {

Texels constant(int width, int height, double nx, double ny, const Tensor& t)
{
    Texels texels = make_texels(width, height);
    const double v[kChannels] = {nx, ny, t.a, t.b, t.c};
    for (std::size_t c = 0; c < kChannels; ++c)
        texels.channel[c].assign(texels.count(), static_cast<float>(v[c]));
    return texels;
}

TEST(classical, what_is_the_same_everywhere_stays)
{
    for (const auto& [nx, ny] : {std::pair{0.0, 0.0}, {0.4, -0.3}})
        for (const Method method : {Method::baseline, Method::kappa}) {
            const Texels t = constant(17, 9, nx, ny, tensor_of(0.4, 0.05, 0.7));
            const std::vector<Texels> levels = classical_pyramid(t, method, 1.0);
            EXPECT_EQ(levels.size(), 5u);
            for (const Texels& level : levels)
                for (std::size_t c = 0; c < kChannels; ++c)
                    for (const float v : level.channel[c])
                        EXPECT_NEAR(v, t.channel[c][0], 2e-6) << static_cast<int>(method) << " channel " << c;
        }
}

TEST(classical, two_slopes_become_their_covariance)
{
    // Texels lean by +-s along x. The single level texel's covariance along x grows by s^2.
    const double s = 0.1, nz = 1.0 / std::sqrt(1.0 + s * s), alpha = 0.2;
    Texels t = constant(2, 2, s * nz, 0.0, tensor_of(alpha, alpha, 0.0));
    t.channel[0][1] = t.channel[0][3] = -t.channel[0][0];
    const Texels kappa = classical_pyramid(t, Method::kappa, 2.0).back();
    EXPECT_NEAR(kappa.channel[0][0], 0.0, 1e-7);
    EXPECT_NEAR(kappa.channel[3][0], std::sqrt(alpha * alpha * nz * nz + 2.0 * s * s * nz * nz), 1e-5);
    EXPECT_NEAR(kappa.channel[2][0], alpha, 1e-5);
}

TEST(classical, odd_sides_are_shared_out_by_area)
{
    Texels t = constant(3, 1, 0.0, 0.0, tensor_of(0.3, 0.3, 0.0));
    t.channel[2] = {0.1f, 0.4f, 0.7f};
    const Texels two = shrunk(t, 2, 1, Method::baseline, 0.0);
    EXPECT_NEAR(two.channel[2][0], (0.1 + 0.5 * 0.4) / 1.5, 1e-6);
    EXPECT_NEAR(two.channel[2][1], (0.7 + 0.5 * 0.4) / 1.5, 1e-6);
    const Texels six = shrunk(t, 6, 2, Method::baseline, 0.0);
    EXPECT_EQ(six.channel[2][0], t.channel[2][0]);
    EXPECT_EQ(six.channel[2][11], t.channel[2][2]);
}

} // namespace
} // namespace burnish::mipnet
