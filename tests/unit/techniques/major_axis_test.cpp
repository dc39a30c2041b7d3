// The BRDF major axis against printed test vectors, brute force, and across instruction sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "raster/tile/tile_renderer.h"
#include "tests/unit/lanes/kernels.h"
#include "tests/unit/raster/fixture.h"

namespace burnish {
namespace test {

namespace {

struct Vec {
    double x, y, z;
};
Vec unit(double x, double y, double z)
{
    const double l = std::sqrt(x * x + y * y + z * z);
    return {x / l, y / l, z / l};
}

struct Vector { // test vectors A to F: view, roughness, eta, samples; expected values
    Vec o;
    double roughness, eta, count;
    double t_near, t_far, width, length, radius;
    Vec e0, e1; // an unordered pair
};
const Vector kVectors[] = {
    {unit(.5, .3, .8),
     .5,
     .8,
     16,
     -1.55186854,
     .02081768,
     .11974987,
     1.10165788,
     .07918166,
     {-.27144524, -.00062796, .96245368},
     {.27144524, .00062796, .96245368}},
    {unit(.6, -.2, .1),
     .4,
     .5,
     16,
     1.46274492,
     -.11078647,
     .04737105,
     .47323574,
     .03401382,
     {-.06910485, .00256245, .99760611},
     {.15405067, -.00571230, .98804644}},
    {unit(.6, .2, .3),
     .5,
     0,
     16,
     -1.24904577,
     .32175055,
     .29386256,
     .68567930,
     .14693128,
     {-.09472317, -.03157439, .99500280},
     {.09472317, .03157439, .99500280}},
    {{0, 0, 1}, .6, -.7, 8, 0, 1.57079633, .30369896, 1.45796195, .20958203, {0, -.31878070, .94782850}, {0, .31878070, .94782850}},
    {unit(.7, 0, .4), .5, .6, 16, 1.57079633, 0, .14275683, 1.02005344, .07331634, {-.22056970, 0, .97537121}, {.23621451, 0, .97170093}},
    {unit(-.3, .9, .05),
     .9,
     -.9,
     4,
     .01748846,
     -1.53273639,
     .08568375,
     1.43286671,
     .41194918,
     {-.00144094, .71898728, .69502174},
     {.00000563, -.00280945, .99999605}},
};

std::vector<double> input(const Vector& v)
{
    const double s = v.roughness * v.roughness / std::sqrt(2.0);
    return {v.o.x, v.o.y, v.o.z, s * (1 + v.eta), s * (1 - v.eta), 1.0, 2.3, v.count};
}

double distance(const double* a, const Vec& b)
{
    return std::hypot(a[0] - b.x, std::hypot(a[1] - b.y, a[2] - b.z));
}

void expect_vector(const IsaFns& kernels, const Vector& v, double tolerance, int index)
{
    const std::vector<double> out = call(kernels, "major_axis", input(v));
    EXPECT_NEAR(out[0], v.t_near, 40 * tolerance) << kernels.name << " vector " << index;
    EXPECT_NEAR(out[1], v.t_far, 40 * tolerance) << kernels.name << " vector " << index;
    EXPECT_NEAR(out[8], v.radius, tolerance) << kernels.name << " vector " << index;
    EXPECT_NEAR(out[9], v.length, tolerance) << kernels.name << " vector " << index;
    EXPECT_NEAR(out[10], v.width, tolerance) << kernels.name << " vector " << index;
    const double straight = std::max(distance(&out[2], v.e0), distance(&out[5], v.e1));
    const double swapped = std::max(distance(&out[2], v.e1), distance(&out[5], v.e0));
    EXPECT_LT(std::min(straight, swapped), tolerance) << kernels.name << " vector " << index;
}

// Further printed values: the extrema's f1 and f2, the ends' clamps (tau 0 to 1), the closest points' shift delta, the kept part zeta of
// the axis, and directions of the first and last sample.
struct Steps {
    int vector;
    double f1, f2, tau0, tau1, delta, zeta; // 0: not printed
    Vec centre, refl0, refl1;
};
const Steps kSteps[] = {
    {0, .09104107, -.00344818, 0, 1, 0, .89130031, {0, 0, 1}, {-.85279175, -.30385017, .42476029}, {-.00829300, -.30189650, .95330464}},
    {1,
     .02567193,
     .00563749,
     .25761214,
     1,
     .40536079,
     .89989968,
     {.04274066, -.00158485, .99908494},
     {-.94951535, .31281002, .02388485},
     {-.84447562, .30891508, .43752988}},
    {2, 0, 0, 0, 1, 0, .57142857, {0, 0, 1}, {}, {}},
    {3, 0, 0, 0, 1, 0, .79169624, {0, 0, 1}, {}, {}},
    {4, 0, 0, .03054396, 1, .04797835, .86004966, {}, {}, {}},
    {5, 0, 0, 0, .51275364, -.75534141, .94020117, {}, {}, {}},
};

Vec ellipse_point(const Vector& v, double t, double scale)
{
    const double s = v.roughness * v.roughness / std::sqrt(2.0);
    return unit(scale * s * (1 + v.eta) * std::cos(t), scale * s * (1 - v.eta) * std::sin(t), 1);
}
Vec mirrored(const Vec& w, const Vec& o)
{
    const double d = 2 * (w.x * o.x + w.y * o.y + w.z * o.z);
    return {d * w.x - o.x, d * w.y - o.y, d * w.z - o.z};
}
double apart(const Vec& a, const Vec& b)
{
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

// The kernel's results follow from the printed steps.
TEST(major_axis, equals_the_printed_steps)
{
    for (const Steps& step : kSteps) {
        const Vector& v = kVectors[step.vector];
        const std::vector<double> out = call(oracle_fns(), "major_axis", input(v));
        if (step.f2 != 0) { // appendix A as printed
            const double s = v.roughness * v.roughness / std::sqrt(2.0), rx = s * (1 + v.eta), ry = s * (1 - v.eta);
            const double f3 = -step.f2 * step.f2 * (1 + rx * rx) / (1 + ry * ry), root = std::sqrt(step.f1 * step.f1 - f3);
            EXPECT_NEAR(out[0], std::atan((step.f1 + root) / step.f2), 1e-5) << step.vector;
            EXPECT_NEAR(out[1], std::atan((step.f1 - root) / step.f2), 1e-5) << step.vector;
        }
        EXPECT_NEAR(1 - out[10] / out[9], step.zeta, 1e-7) << step.vector;
        // appendix C: the width lies between the closest points, shifted by delta
        const Vec m0 = ellipse_point(v, out[0] + step.delta, -1), m1 = ellipse_point(v, out[0] - step.delta, 1);
        EXPECT_NEAR(apart(mirrored(m0, v.o), mirrored(m1, v.o)), out[10], 1e-7) << step.vector;
        // appendix B and D: the ends at tau, drawn towards their middle
        const Vec far0 = ellipse_point(v, out[1], 2 * step.tau0 - 1), far1 = ellipse_point(v, out[1], 2 * step.tau1 - 1);
        EXPECT_NEAR(apart(mirrored(far0, v.o), mirrored(far1, v.o)), out[9], 1e-7) << step.vector;
        const Vec c = unit(far0.x + far1.x, far0.y + far1.y, far0.z + far1.z);
        if (step.centre.z != 0) {
            EXPECT_LT(apart(c, step.centre), 1e-7) << step.vector;
        }
        const auto drawn = [&](const Vec& e) {
            return unit(c.x + step.zeta * (e.x - c.x), c.y + step.zeta * (e.y - c.y), c.z + step.zeta * (e.z - c.z));
        };
        EXPECT_LT(distance(&out[2], drawn(far0)), 1e-7) << step.vector;
        EXPECT_LT(distance(&out[5], drawn(far1)), 1e-7) << step.vector;
        if (step.refl0.z != 0)
            for (const IsaFns& kernels : float_fns())
                for (double s : {0.0, 1.0}) {
                    const std::vector<double> at = {out[2], out[3], out[4], out[5], out[6], out[7], v.o.x, v.o.y, v.o.z, s};
                    const std::vector<double> dir = call(kernels, "major_axis_direction", at);
                    EXPECT_LT(distance(dir.data(), s == 0 ? step.refl0 : step.refl1), 1e-6) << step.vector << " " << kernels.name;
                }
    }
}

TEST(major_axis, equals_the_printed_test_vectors)
{
    int index = 0;
    for (const Vector& v : kVectors) {
        expect_vector(oracle_fns(), v, 1e-6, index);
        for (const IsaFns& kernels : float_fns())
            expect_vector(kernels, v, 1e-5, index);
        ++index;
    }
}

// Scans d(t), the squared closeness of the reflected ellipse point to the mirror direction. Cocco et al. 2024, appendix A.
TEST(major_axis, extrema_equal_a_brute_force_scan)
{
    Random random{17};
    for (int trial = 0; trial < 300; ++trial) {
        const Vec o = unit(2.0 * static_cast<double>(random.unit()) - 1.0, 2.0 * static_cast<double>(random.unit()) - 1.0,
                           0.05 + static_cast<double>(random.unit()));
        const double al = 0.1 + 0.9 * static_cast<double>(random.unit()), eta = 1.9 * static_cast<double>(random.unit()) - 0.95;
        const double s = al * al / std::sqrt(2.0), rx = s * (1 + eta), ry = s * (1 - eta);
        const auto d = [&](double t) {
            const double sx = rx * std::cos(t), sy = ry * std::sin(t), so = sx * o.x + sy * o.y;
            return 2.0 * (o.z * o.z - so * so) / (1.0 + sx * sx + sy * sy);
        };
        double lowest = 1e9, highest = -1e9;
        for (int i = 0; i < 20000; ++i) {
            const double value = d(M_PI * i / 20000.0);
            lowest = std::min(lowest, value), highest = std::max(highest, value);
        }
        const std::vector<double> in = {o.x, o.y, o.z, rx, ry, 1.0, 2.3, 16.0};
        const std::vector<double> out = call(oracle_fns(), "major_axis", in);
        EXPECT_GE(d(out[0]), highest - 1e-6) << trial;
        EXPECT_LE(d(out[1]), lowest + 1e-6) << trial;
    }
}

float exact_root(float x)
{
    return std::sqrt(x);
}

// Returns a square root within the error allowed by Vulkan 1.3 ("Precision and Operation of SPIR-V Instructions": Sqrt is 1.0 /
// InverseSqrt).
float device_root(float x)
{
    return 1.0f / (1.0f / std::sqrt(x));
}

// Evaluates appendix A as printed, in floats: t1, the direction of the farthest point.
float printed_t1(float ox, float oy, float rx, float ry, float root(float))
{
    const float f0 = 2.0f * ox * oy * rx * ry;
    const float f1 = ox * ox * ry * ry * (1.0f + rx * rx) - oy * oy * rx * rx * (1.0f + ry * ry) + rx * rx - ry * ry;
    const float f2 = -f0 * (1.0f + ry * ry), f3 = f0 * f2 * (1.0f + rx * rx);
    if (f2 == 0.0f)
        return f1 >= 0.0f ? 0.0f : static_cast<float>(M_PI / 2.0);
    return std::atan((f1 - root(f1 * f1 - f3)) / f2);
}

// Returns the angle between axes, which is at most a quarter turn.
double turn_between(double a, double b)
{
    const double apart = std::fmod(std::fabs(a - b), M_PI);
    return std::min(apart, M_PI - apart);
}

// Beside the lobe's symmetry planes the printed quotient divides differences of nearly equal numbers. Images then show a line of speckles,
// unless the square root of a square is exact. The device's square root is inexact, as Vulkan allows. The kernel's form avoids the
// cancellation.
TEST(major_axis, extrema_as_printed_speckle_in_floats_beside_symmetry_planes_and_the_kernel_does_not)
{
    Random random{41};
    constexpr int kViews = 20000;
    constexpr double kSeen = 0.02; // radians
    int printed_off = 0, printed_far = 0;
    double worst = 0.0, by_exact_root = 0.0;
    for (int trial = 0; trial < kViews; ++trial) {
        const auto unit = [&] { return static_cast<double>(random.unit()); };
        const float ox = static_cast<float>(0.1 + 0.8 * unit()), oy = static_cast<float>(std::pow(10.0, -8.0 + 2.0 * unit()));
        const float oz = std::sqrt(1.0f - ox * ox);
        const double al = 0.1 + 0.9 * unit(), eta = 0.2 + 0.7 * unit(), s = al * al / std::sqrt(2.0);
        const float rx = static_cast<float>(s * (1 + eta)), ry = static_cast<float>(s * (1 - eta));
        const std::vector<double> in = {static_cast<double>(ox),
                                        static_cast<double>(oy),
                                        static_cast<double>(oz),
                                        static_cast<double>(rx),
                                        static_cast<double>(ry),
                                        1.0,
                                        2.3,
                                        16.0};
        const double reference = call(oracle_fns(), "major_axis", in)[1];
        const double off = turn_between(static_cast<double>(printed_t1(ox, oy, rx, ry, device_root)), reference);
        by_exact_root = std::max(by_exact_root, turn_between(static_cast<double>(printed_t1(ox, oy, rx, ry, exact_root)), reference));
        printed_off += off > kSeen, printed_far += off > M_PI / 6.0;
        worst = std::max(worst, turn_between(call(float_fns()[0], "major_axis", in)[1], reference));
    }
    std::printf(
        "as printed %.1f %% are off by more than %.2f radians, %.1f %% by more than 30 degrees (by an exact root %.1e at most), the "
        "kernel by %.1e at most\n",
        100.0 * printed_off / kViews, kSeen, 100.0 * printed_far / kViews, by_exact_root, worst);
    EXPECT_GT(printed_off, kViews / 10);
    EXPECT_LT(by_exact_root, 1e-3);
    EXPECT_LT(worst, 1e-5);
}

// Views that break the printed forms in float32: on and beside symmetry planes, mirrors, grazing, isotropic, extreme anisotropy.
TEST(major_axis, degenerate_inputs_stay_finite_and_near_the_oracle_in_every_isa)
{
    const double tiny[] = {0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3, 0.5};
    double worst = 0.0;
    for (double ox : tiny)
        for (double oy : tiny)
            for (double oz : {0.0, -0.1, 1e-4, 0.5})
                for (double al : {0.0, 0.001, 0.03, 0.1, 0.5, 1.0})
                    for (double eta : {-1.0, -0.5, 0.0, 1e-6, 0.95, 1.0})
                        for (double count : {1.0, 2.0, 16.0}) {
                            const double s = al * al / std::sqrt(2.0), l = std::sqrt(ox * ox + oy * oy + oz * oz);
                            const double inv = l > 0 ? 1.0 / l : 1.0;
                            const std::vector<double> in = {ox * inv, oy * inv, oz * inv, s * (1 + eta), s * (1 - eta), 1.0, 2.3, count};
                            const std::vector<double> want = call(oracle_fns(), "major_axis", in);
                            const std::vector<double> first = call(float_fns()[0], "major_axis", in);
                            for (const IsaFns& kernels : float_fns()) {
                                const std::vector<double> out = call(kernels, "major_axis", in);
                                for (double value : out)
                                    ASSERT_TRUE(std::isfinite(value))
                                        << kernels.name << " " << ox << " " << oy << " " << oz << " " << al << " " << eta;
                                ASSERT_EQ(std::memcmp(first.data(), out.data(), 11 * sizeof out[0]), 0) << kernels.name;
                                worst = std::max(worst, std::fabs(out[8] - want[8]));
                                EXPECT_GE(out[4], 0.0) << "a normal below the surface";
                            }
                        }
    std::printf("largest difference of the sample radius from the double oracle: %.2e\n", worst);
    EXPECT_LT(worst, 2e-3);
}

TEST(major_axis, samples_never_leave_below_the_surface)
{
    Random random{23};
    double lowest = 1.0;
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec o = unit(2.0 * static_cast<double>(random.unit()) - 1.0, 2.0 * static_cast<double>(random.unit()) - 1.0,
                           1e-3 + static_cast<double>(random.unit()));
        const double al = 0.05 + 0.95 * static_cast<double>(random.unit()), eta = 1.9 * static_cast<double>(random.unit()) - 0.95;
        const double s = al * al / std::sqrt(2.0);
        const std::vector<double> in = {o.x, o.y, o.z, s * (1 + eta), s * (1 - eta), 1.0, 2.3, 16.0};
        const std::vector<double> out = call(float_fns()[0], "major_axis", in);
        for (int j = 0; j < 16; ++j) {
            const std::vector<double> at = {out[2], out[3], out[4], out[5], out[6], out[7], o.x, o.y, o.z, j / 15.0};
            const std::vector<double> dir = call(float_fns()[0], "major_axis_direction", at);
            lowest = std::min(lowest, dir[2]);
        }
    }
    EXPECT_GT(lowest, -1e-3);
}

// Sample counts are odd, at most the requested count, and at most beta L / Delta' of the line. The constants of major_axis_grain_count()
// follow from this limit: the factor 0.43 leaves room for fading cells.
TEST(major_axis, adaptive_takes_no_more_samples_than_asked_for_nor_than_the_line_needs)
{
    Random random{29};
    const auto in_range = [&](double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random.unit()); };
    double most = 0.0, largest = 0.0;
    for (int trial = 0; trial < 5000; ++trial) {
        const Vec o = unit(in_range(-1.0, 1.0), in_range(-1.0, 1.0), in_range(0.1, 1.5));
        const double al = in_range(0.05, 0.5), eta = in_range(0.0, 0.99), s = al * al / std::sqrt(2.0);
        const std::vector<double> in = {o.x, o.y, o.z, s * (1 + eta), s * (1 - eta), 1.0, 2.3, 15.0};
        const std::vector<double> line = call(float_fns()[0], "major_axis", in), taken = call(float_fns()[0], "grain_count", in);
        ASSERT_LE(taken[1], 15.0);
        ASSERT_GE(taken[0], 1.0);
        const double needed = std::max(1.0, 2.3 * line[9] / std::max(line[10], 1e-9));
        most = std::max(most, taken[1]), largest = std::max(largest, taken[1] / needed);
    }
    std::printf("at most %g samples, %.2f of what the line needs\n", most, largest);
    EXPECT_EQ(most, 15.0);
    EXPECT_LE(largest, 1.0);
}

// Wide lobes, grazing views and other k. The sum of cells counts; the outermost two may be partial.
TEST(major_axis, adaptive_samples_of_any_lobe_add_up_to_no_more_than_the_line_needs)
{
    Random random{31};
    const auto in_range = [&](double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random.unit()); };
    double largest = 0.0;
    for (int trial = 0; trial < 8000; ++trial) {
        const Vec o = unit(in_range(-1.0, 1.0), in_range(-1.0, 1.0), trial % 2 ? in_range(0.001, 0.1) : in_range(0.1, 1.5));
        const double al = in_range(0.05, 1.0), eta = in_range(0.0, 0.99), s = al * al / std::sqrt(2.0),
                     k = trial % 3 ? 1.0 : in_range(0.5, 3.0);
        const std::vector<double> in = {o.x, o.y, o.z, s * (1 + eta), s * (1 - eta), k, 2.3, 63.0};
        const std::vector<double> line = call(float_fns()[0], "major_axis", in), taken = call(float_fns()[0], "grain_count", in);
        const double needed = std::max(1.0, 2.3 * line[9] / std::max(line[10], 1e-9));
        largest = std::max(largest, taken[0] / needed);
        ASSERT_LT(taken[1], taken[0] + 2.0);
    }
    std::printf("%.4f of what the line needs\n", largest);
    EXPECT_LE(largest, 1.00001);
    EXPECT_GT(largest, 0.9);
}

TEST(major_axis, a_mirror_is_a_mirror)
{
    for (const IsaFns& kernels : float_fns()) {
        const Vec o = unit(.3, -.4, .6);
        const std::vector<double> in = {o.x, o.y, o.z, 0, 0, 1.0, 2.3, 16.0};
        const std::vector<double> out = call(kernels, "major_axis", in);
        EXPECT_EQ(out[8], 0.0);
        const std::vector<double> at = {out[2], out[3], out[4], out[5], out[6], out[7], o.x, o.y, o.z, 0.4};
        const std::vector<double> dir = call(kernels, "major_axis_direction", at);
        EXPECT_NEAR(dir[0], -o.x, 1e-6);
        EXPECT_NEAR(dir[1], -o.y, 1e-6);
        EXPECT_NEAR(dir[2], o.z, 1e-6);
    }
}

} // namespace
} // namespace test
} // namespace burnish
