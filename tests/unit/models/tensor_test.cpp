// Lobes as tensors: all conversions between forms and back, in doubles and floats; frames of normals, and SGGX.
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <initializer_list>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

using Numbers = std::vector<double>;

Numbers exact(const char* name, const Numbers& in)
{
    return call(oracle_fns(), name, in);
}
Numbers in_floats(const char* name, const Numbers& in)
{
    const Numbers scalar = call(float_fns()[0], name, in);
    for (const IsaFns& isa : float_fns())
        EXPECT_EQ(call(isa, name, in), scalar) << name;
    return scalar;
}

struct Lobe {
    double u, v, angle; // widths along the axis and across it
};
const Lobe kLobes[] = {{0.5, 0.2, 0.3}, {0.9, 0.01, 1.2}, {0.25, 0.25, 0.0}, {0.002, 0.002, 0.0}, {1.0, 0.002, -0.7}, {0.03, 0.02, 1.5}};

Numbers tensor_of(const Lobe& l)
{
    return exact("tensor_axes_in", {l.u, l.v, std::cos(l.angle), std::sin(l.angle)});
}

// Converts both ways, by each form's definition: M = R diag(u, v) R^T, A its adjugate, Sigma = M^2 / 2.
TEST(tensor, forms_go_to_each_other_and_back)
{
    for (const Lobe& l : kLobes) {
        SCOPED_TRACE(testing::Message() << l.u << " " << l.v << " " << l.angle);
        const double c = std::cos(l.angle), s = std::sin(l.angle);
        const double xx = l.u * c * c + l.v * s * s, yy = l.u * s * s + l.v * c * c, xy = (l.u - l.v) * c * s;
        const Numbers t = tensor_of(l);
        EXPECT_NEAR(t[0], yy, 1e-15);
        EXPECT_NEAR(t[1], xx, 1e-15);
        EXPECT_NEAR(t[2], -xy, 1e-15);
        const Numbers sigma = exact("tensor_covariance", t);
        EXPECT_NEAR(sigma[0], 0.5 * (xx * xx + xy * xy), 1e-15);
        EXPECT_NEAR(sigma[1], 0.5 * (yy * yy + xy * xy), 1e-15);
        EXPECT_NEAR(sigma[2], 0.5 * xy * (xx + yy), 1e-15);
        const Numbers back = exact("covariance_tensor", sigma), rough = in_floats("covariance_tensor", sigma);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(back[i], t[i], 1e-12);
            EXPECT_NEAR(rough[i], t[i], 2e-4 * l.u); // thin lobes: a difference of squares
        }
        for (const bool floats : {false, true}) {
            const Numbers axes = floats ? in_floats("tensor_axes_out", t) : exact("tensor_axes_out", t);
            EXPECT_NEAR(axes[0], l.u, floats ? 1e-6 : 1e-12);
            EXPECT_NEAR(axes[1], l.v, floats ? 1e-6 : 1e-12);
            if (l.u > 1.2 * l.v) {
                EXPECT_NEAR(std::abs(axes[2] * c + axes[3] * s), 1.0, floats ? 1e-6 : 1e-12);
            }
        }
    }
}

TEST(tensor, roughness_and_direction_come_back)
{
    for (const double roughness : {0.05, 0.3, 0.7})
        for (const double eta : {0.0, 0.4, 0.95}) {
            const Numbers t = exact("tensor_roughness_in", {roughness, eta, 1.5, -2.0});
            const Numbers r = exact("tensor_roughness_out", t), rough = in_floats("tensor_roughness_out", t);
            EXPECT_NEAR(r[0], roughness, 1e-12);
            EXPECT_NEAR(r[1], eta, 1e-9);
            EXPECT_NEAR(rough[0], roughness, 1e-6);
            EXPECT_NEAR(rough[1], eta, 2e-4);
            if (eta > 0.0) {
                EXPECT_NEAR(r[2], 0.6, 1e-9);
                EXPECT_NEAR(r[3], -0.8, 1e-9);
            }
        }
}

TEST(tensor, projection_keeps_widths_in_their_range_and_what_is_there)
{
    for (const Lobe& l : kLobes) {
        const Numbers t = tensor_of(l), kept = exact("tensor_projected", t);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(kept[i], t[i], 1e-9) << l.u << " " << l.v;
    }
    for (const std::array<double, 3>& t :
         {std::array{2.0, 0.5, 0.9}, {0.0, 0.0, 1.0}, {0.3, 0.3, -5.0}, {-1.0, 3.0, 0.2}, {1.0, 1.0, 0.1}}) {
        const Numbers axes = exact("tensor_axes_out", exact("tensor_projected", {t[0], t[1], t[2]}));
        EXPECT_LE(axes[0], 1.0 + 1e-9);
        EXPECT_GE(axes[1], 0.002 - 1e-9);
    }
}

const std::array<double, 3> kNormals[] = {{0, 0, 1}, {0.3, -0.2, 0}, {-0.6, 0.5, 0}, {0.9, 0.1, 0}};

Numbers unit(const std::array<double, 3>& n)
{
    return {n[0], n[1], std::sqrt(1.0 - n[0] * n[0] - n[1] * n[1])};
}

// Converts to a normal's frame and back. The expected values turn normals about n numerically in its frame as their slopes change.
TEST(tensor, frames_are_reached_and_left_as_normals_turn)
{
    for (const auto& of : kNormals) {
        const Numbers n = unit(of);
        const Numbers own = exact("tensor_covariance", tensor_of(kLobes[0]));
        const Numbers flat = exact("covariance_out_of_frame", {n[0], n[1], n[2], own[0], own[1], own[2]});
        const Numbers back = exact("covariance_into_frame", {n[0], n[1], n[2], flat[0], flat[1], flat[2]});
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(back[i], own[i], 1e-12);
        const double k = 1.0 / (1.0 + n[2]), step = 1e-6;
        const double t[3] = {1 - n[0] * n[0] * k, -n[0] * n[1] * k, -n[0]}, b[3] = {-n[0] * n[1] * k, 1 - n[1] * n[1] * k, -n[1]};
        double turn[2][2]; // d(turn in the frame) / d(slope)
        for (int axis = 0; axis < 2; ++axis) {
            double m[3] = {n[0] / n[2] + (axis == 0 ? step : 0.0), n[1] / n[2] + (axis == 1 ? step : 0.0), 1.0};
            double along[3] = {};
            for (int i = 0; i < 3; ++i)
                along[0] += m[i] * t[i], along[1] += m[i] * b[i], along[2] += m[i] * n[static_cast<std::size_t>(i)];
            turn[0][axis] = along[0] / along[2] / step, turn[1][axis] = along[1] / along[2] / step;
        }
        const auto turned = [&](int i, int j) {
            return turn[i][0] * turn[j][0] * flat[0] + turn[i][1] * turn[j][1] * flat[1] +
                   (turn[i][0] * turn[j][1] + turn[i][1] * turn[j][0]) * flat[2];
        };
        EXPECT_NEAR(turned(0, 0), own[0], 1e-6);
        EXPECT_NEAR(turned(1, 1), own[1], 1e-6);
        EXPECT_NEAR(turned(0, 1), own[2], 1e-6);
        // the same frame in space, by the shortest turn
        const Numbers space = exact("covariance_into_space", {n[0], n[1], n[2], own[0], own[1], own[2]});
        const Numbers seen =
            exact("covariance_out_of_space", {n[0], n[1], n[2], space[0], space[1], space[2], space[3], space[4], space[5]});
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(seen[i], own[i], 1e-12);
        EXPECT_NEAR(space[0], own[0] * t[0] * t[0] + own[1] * b[0] * b[0] + 2 * own[2] * t[0] * b[0], 1e-12);
        EXPECT_NEAR(space[5], own[0] * t[1] * t[2] + own[1] * b[1] * b[2] + own[2] * (t[1] * b[2] + t[2] * b[1]), 1e-12);
    }
    const Numbers n = unit(kNormals[2]), axes = exact("quaternion_axes", n);
    const double k = 1.0 / (1.0 + n[2]);
    const double t[6] = {1 - n[0] * n[0] * k, -n[0] * n[1] * k, -n[0], -n[0] * n[1] * k, 1 - n[1] * n[1] * k, -n[1]};
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(axes[i], t[i], 1e-12);
}

Numbers joined(std::initializer_list<Numbers> parts)
{
    Numbers all;
    for (const Numbers& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

// The SGGX matrix of one normal is the lobe about it. For any matrix in any frame, the slopes are S_tt / S_nn - (S_tn / S_nn)^2.
TEST(tensor, slopes_of_an_sggx_matrix_are_its_schur_complement)
{
    for (const auto& of : kNormals) {
        const Numbers n = unit(of), sigma = exact("tensor_covariance", tensor_of(kLobes[0]));
        const Numbers s = exact("covariance_into_space", joined({n, {2 * sigma[0], 2 * sigma[1], 2 * sigma[2]}}));
        const Numbers about = exact("sggx_slopes", joined({n, n, s}));
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_NEAR(about[i], 0.0, 1e-12);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(about[2 + i], 2 * sigma[i], 1e-12);
        const Numbers flat = exact("sggx_slopes", joined({{0, 0, 1}, n, s}));
        const double nn = s[2] + n[2] * n[2];
        const double mean[2] = {(s[4] + n[0] * n[2]) / nn, (s[5] + n[1] * n[2]) / nn};
        EXPECT_NEAR(flat[0], mean[0], 1e-12);
        EXPECT_NEAR(flat[1], mean[1], 1e-12);
        EXPECT_NEAR(flat[2], (s[0] + n[0] * n[0]) / nn - mean[0] * mean[0], 1e-12);
        EXPECT_NEAR(flat[3], (s[1] + n[1] * n[1]) / nn - mean[1] * mean[1], 1e-12);
        EXPECT_NEAR(flat[4], (s[3] + n[0] * n[1]) / nn - mean[0] * mean[1], 1e-12);
        const Numbers along = exact("sggx_product", joined({n, s, n})); // n is an axis of the matrix with eigenvalue 1
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(along[i], n[i], 1e-12);
    }
    // narrow lobes keep their digits in floats, although the matrix has lost them
    const Numbers n = unit(kNormals[1]), small = exact("tensor_covariance", {0.002, 0.002, 0.0});
    const Numbers s = exact("covariance_into_space", joined({n, {2 * small[0], 2 * small[1], 2 * small[2]}}));
    const Numbers in = joined({{0, 0, 1}, n, s});
    const Numbers good = exact("sggx_slopes", in), rough = in_floats("sggx_slopes", in);
    EXPECT_NEAR(rough[2], good[2], 1e-5 * good[2]);
    EXPECT_NEAR(rough[3], good[3], 1e-5 * good[3]);
}

} // namespace
} // namespace burnish::test
