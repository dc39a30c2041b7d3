// The line of isotropic lobes: sums over its parts, and images whose pixels share samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/unit/lanes/kernels.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

struct Line {
    double x, y, width, count, cells;
    double direction[3], weight, radius, v_dot_h;
};

Line line_of(const IsaFns& k, const double o[3], double alpha_x, double alpha_y, double limit = 15.0, double c = 0.0)
{
    const std::vector<double> in = {o[0], o[1], o[2], alpha_x * std::sqrt(0.5), alpha_y * std::sqrt(0.5), limit, c};
    const std::vector<double> out = call(k, "lobe_line", in);
    return {out[0], out[1], out[2], out[3], out[4], {out[5], out[6], out[7]}, out[8], out[9], out[10]};
}

struct View {
    double o[3];
};
View view(double cosine, double azimuth)
{
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return {{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}};
}

// In slopes the eye's metric is G = o.z^2 + o o^T (x and y of o). Round lobes of width w have the matrix w^2 G^-1, and a line along s adds
// s s^T. Their sum is the lobe.
TEST(lobe_line, and_its_round_lobes_are_the_lobe)
{
    for (const View& v : {view(1.0, 0.0), view(0.8, 0.4), view(0.3, 1.5), view(0.1, -0.8), view(0.6, 3.0)})
        for (double alpha_x : {0.5, 0.2, 0.05})
            for (double alpha_y : {1.0, 0.5, 0.1}) {
                const double ax = alpha_x, ay = alpha_x * alpha_y;
                const Line l = line_of(oracle_fns(), v.o, ax, ay);
                const double x = v.o[0], y = v.o[1], z2 = v.o[2] * v.o[2], w2 = l.width * l.width * z2; // width is sqrt(l2) / o.z
                const double g11 = z2 + x * x, g22 = z2 + y * y, g12 = x * y, det = g11 * g22 - g12 * g12;
                EXPECT_NEAR(l.x * l.x + w2 * g22 / det, ax * ax, 1e-9 * ax * ax);
                EXPECT_NEAR(l.y * l.y + w2 * g11 / det, ay * ay, 1e-9 * ax * ax);
                EXPECT_NEAR(l.x * l.y - w2 * g12 / det, 0.0, 1e-9 * ax * ax);
                for (const IsaFns& k : float_fns()) {
                    const Line f = line_of(k, v.o, ax, ay), first = line_of(float_fns()[0], v.o, ax, ay);
                    EXPECT_EQ(f.x, first.x) << k.name;
                    EXPECT_EQ(f.radius, first.radius) << k.name;
                    EXPECT_NEAR(f.width, l.width, 1e-4 * l.width + 1e-6) << k.name;
                }
            }
}

// The GGX slope density is the line's marginal times a round lobe's density. The round lobe has width sqrt(1 + z^2) and density 3 / (2 pi)
// (1 + r^2)^(-5/2).
TEST(lobe_line, sums_to_the_density_of_slopes)
{
    const double pi = std::numbers::pi, up[3] = {0, 0, 1};
    const double ax = 0.4, ay = 0.1;
    const Line l = line_of(oracle_fns(), up, ax, ay);
    for (double x : {0.0, 0.1, 0.5, 1.2})
        for (double y : {0.0, 0.05, 0.3}) {
            const double m = 1.0 + x * x / (ax * ax) + y * y / (ay * ay), reference = 1.0 / (pi * ax * ay * m * m);
            double sum = 0.0;
            constexpr int kCount = 20000;
            for (int i = 0; i < kCount; ++i) {
                const double c = 2.0 * (i + 0.5) / kCount - 1.0, z = c / std::sqrt(1.0 - c * c), w2 = l.width * l.width * (1.0 + z * z);
                const double dx = x - l.x * z, dy = y - l.y * z, r2 = (dx * dx + dy * dy) / w2;
                sum += 3.0 / (2.0 * pi * w2) * std::pow(1.0 + r2, -2.5) / kCount;
            }
            EXPECT_NEAR(sum, reference, 1e-3 * reference) << x << " " << y;
        }
}

// For any line length the samples' weighted means equal the marginal's, with c = z / sqrt(1 + z^2) evenly spaced. The lobes are narrow,
// since samples of wide lobes are moved (the next test).
TEST(lobe_line, samples_weigh_what_they_stand_for)
{
    constexpr int kCount = 4000;
    for (const View& v : {view(1.0, 0.0), view(0.6, 0.5), view(0.25, -0.7)})
        for (double thin : {0.6, 0.2, 0.03}) {
            const double ax = 0.04, ay = ax * thin;
            const Line middle = line_of(oracle_fns(), v.o, ax, ay);
            const auto smith = [&](const double d[3]) { return std::hypot(ax * d[0], ay * d[1], d[2]); };
            double sum = 0.0, weights = 0.0, expected = 0.0, expected_weights = 0.0;
            for (int i = 0; i < kCount; ++i) {
                const double t = 2.0 * (i + 0.5) / kCount - 1.0;
                const Line l = line_of(oracle_fns(), v.o, ax, ay, 15.0, t);
                const double length = std::hypot(l.direction[0], l.direction[1], l.direction[2]), lies = l.direction[0] / length;
                sum += l.weight * (lies + 2.0), weights += l.weight;
                const double z = t / std::sqrt(1.0 - t * t), w[3] = {-middle.x * z, -middle.y * z, 1.0};
                const double w2 = w[0] * w[0] + w[1] * w[1] + 1.0, seen = w[0] * v.o[0] + w[1] * v.o[1] + v.o[2];
                double d[3];
                for (int k = 0; k < 3; ++k)
                    d[k] = 2.0 * seen / w2 * w[k] - v.o[k];
                if (seen <= 0.0 || d[2] <= 0.0)
                    continue;
                const double weight = seen * d[2] / (d[2] * smith(v.o) + v.o[2] * smith(d));
                expected += weight * (d[0] + 2.0), expected_weights += weight;
            }
            EXPECT_NEAR(sum / weights, expected / expected_weights, 2e-3) << v.o[2] << ' ' << thin;
        }
}

struct Sum {
    double x = 0.0, y = 0.0, z = 0.0, weights = 0.0;

    void add(const double d[3], double length, double weight)
    {
        const double scaled = weight * length / std::hypot(d[0], d[1], d[2]);
        x += d[0] * scaled, y += d[1] * scaled, z += d[2] * scaled, weights += weight;
    }
};

// Returns the mean direction of the light that a lobe reflects, by quadrature over slopes with visible area and masking.
Sum mean_direction_of_lobe(const double o[3], double ax, double ay)
{
    constexpr int kRings = 100;
    const auto smith = [&](const double d[3]) { return std::hypot(ax * d[0], ay * d[1], d[2]); };
    Sum r;
    for (int i = 0; i < kRings; ++i)
        for (int k = 0; k < kRings; ++k) {
            const double share = (i + 0.5) / kRings, radius = std::sqrt(share / (1.0 - share));
            const double turn = 2.0 * std::numbers::pi * (k + 0.5) / kRings;
            const double w[3] = {-ax * radius * std::cos(turn), -ay * radius * std::sin(turn), 1.0};
            const double w2 = w[0] * w[0] + w[1] * w[1] + 1.0, cosine = w[0] * o[0] + w[1] * o[1] + o[2];
            double d[3];
            for (int j = 0; j < 3; ++j)
                d[j] = 2.0 * cosine / w2 * w[j] - o[j];
            if (cosine > 0.0 && d[2] > 0.0)
                r.add(d, 1.0, cosine * d[2] / (d[2] * smith(o) + o[2] * smith(d)));
        }
    return r;
}

// Returns the mean cosine between a level of width alpha and its centre: GGX about its normal, times the cosine.
double mean_cosine_of_level(double alpha)
{
    constexpr int kCount = 200;
    double sum = 0.0, weights = 0.0;
    const double a = std::clamp(alpha, 1e-3, 1.0);
    for (int i = 0; i < kCount; ++i) {
        const double share = (i + 0.5) / kCount, cosine = 2.0 * (1.0 - share) / (1.0 + (a * a - 1.0) * share) - 1.0;
        if (cosine > 0.0)
            sum += cosine * cosine, weights += cosine;
    }
    return sum / weights;
}

// Under light that grows linearly along a direction, the mean direction and the lobe's spread about it determine the result. The mean
// direction of a wide lobe rises from the horizon. Samples fixed at each round lobe's mirror direction would miss the bound.
TEST(lobe_line, wide_lobes_see_light_from_their_mean_direction)
{
    double off = 0.0;
    int count = 0;
    for (double cosine : {0.95, 0.6, 0.3})
        for (double azimuth : {0.2, 0.8, 1.4})
            for (const auto& [ax, ay] : {std::pair{0.52, 0.25}, std::pair{0.7, 0.49}, std::pair{0.86, 0.25}, std::pair{0.3, 0.1}}) {
                const View v = view(cosine, azimuth);
                const Sum lobe = mean_direction_of_lobe(v.o, ax, ay);
                Sum line;
                for (int i = 0; i < 100; ++i) {
                    const Line l = line_of(oracle_fns(), v.o, ax, ay, 15.0, (i + 0.5) / 50.0 - 1.0);
                    line.add(l.direction, mean_cosine_of_level(l.radius), l.weight);
                }
                off += std::hypot(line.x / line.weights - lobe.x / lobe.weights, line.y / line.weights - lobe.y / lobe.weights,
                                  line.z / line.weights - lobe.z / lobe.weights);
                ++count;
            }
    std::printf("mean directions are off by %.4f\n", off / count);
    EXPECT_LT(off / count, 0.04);
}

TEST(lobe_line, takes_as_many_samples_as_its_cells_hold_and_never_more_than_the_limit)
{
    for (double cosine : {1.0, 0.5, 0.05})
        for (double thin : {1.0, 0.7, 0.2, 0.02}) {
            double before = 0.0;
            for (double limit : {1.0, 3.0, 7.0, 15.0}) {
                const Line l = line_of(float_fns()[0], view(cosine, 0.3).o, 0.5, 0.5 * thin, limit);
                EXPECT_LE(l.count, limit);
                EXPECT_GE(l.count, std::max(before, 1.0));
                EXPECT_NEAR(l.cells, l.count, 1e-4);
                before = l.count;
            }
        }
    const double up[3] = {0, 0, 1};
    EXPECT_NEAR(line_of(float_fns()[0], up, 0.3, 0.3).count, 1.0, 1e-3) << "a round lobe seen from above has no line";
}

// A narrow lobe's half vector lies half-way between the eye and the sample.
TEST(lobe_line, knows_the_angle_to_its_half_vectors)
{
    for (const View& v : {view(1.0, 0.0), view(0.7, 0.4), view(0.2, 1.5), view(0.05, -0.8)})
        for (double thin : {1.0, 0.3})
            for (double c : {-0.95, 0.0, 0.3, 0.8}) {
                const double alpha = 1e-3;
                const Line l = line_of(oracle_fns(), v.o, alpha, alpha * thin, 15.0, c);
                const double length = std::hypot(l.direction[0], l.direction[1], l.direction[2]);
                const double cosine = (l.direction[0] * v.o[0] + l.direction[1] * v.o[1] + l.direction[2] * v.o[2]) / length;
                EXPECT_NEAR(l.v_dot_h, std::sqrt(0.5 * (1.0 + cosine)), 1e-5) << v.o[2] << ' ' << thin << ' ' << c;
            }
}

// A round lobe seen from straight above has no line: all its samples lie in the mirror direction.
TEST(lobe_line, of_no_length_is_the_mirror_direction)
{
    const double up[3] = {0, 0, 1};
    for (double alpha : {0.04, 0.3, 0.8})
        for (double c : {-0.95, 0.0, 0.3, 0.8}) {
            const Line l = line_of(oracle_fns(), up, alpha, alpha, 15.0, c);
            EXPECT_NEAR(l.direction[0], 0.0, 1e-9);
            EXPECT_NEAR(l.direction[1], 0.0, 1e-9);
            EXPECT_NEAR(l.count, 1.0, 1e-6);
        }
}

// Flipping the lobe's axis gives an equal lobe.
TEST(lobe_line, mirror_images_of_samples_lie_on_both_sides)
{
    const double up[3] = {0, 0, 1};
    for (double c : {0.1, 0.6, 0.99}) {
        const Line a = line_of(float_fns()[0], up, 0.4, 0.1, 15.0, c), b = line_of(float_fns()[0], up, 0.4, 0.1, 15.0, -c);
        EXPECT_EQ(a.direction[0], -b.direction[0]);
        EXPECT_EQ(a.direction[2], b.direction[2]);
        EXPECT_EQ(a.weight, b.weight);
        EXPECT_EQ(a.radius, b.radius);
    }
}

Scene brushed_square(float half, int pieces)
{
    std::vector<Triangle> triangles;
    for (int i = 0; i < pieces; ++i) {
        const float x0 = half * (2.0f * static_cast<float>(i) / static_cast<float>(pieces) - 1.0f),
                    x1 = half * (2.0f * static_cast<float>(i + 1) / static_cast<float>(pieces) - 1.0f);
        triangles.push_back({glm::vec3(x0, -half, 0), glm::vec3(x1, -half, 0), glm::vec3(x1, half, 0)});
        triangles.push_back({glm::vec3(x0, -half, 0), glm::vec3(x1, half, 0), glm::vec3(x0, half, 0)});
    }
    Scene s = scene_of(triangles, false);
    s.materials[0].roughness = 0.5f, s.materials[0].anisotropy_strength = 0.8f;
    return s;
}

FrameDesc line_desc(int side, int msaa)
{
    FrameDesc d;
    d.width = d.height = side, d.msaa = msaa, d.technique = "lobe_line", d.samples = 3, d.background = false;
    d.view = make_view({0.4f, -0.9f, 2.2f}, {0, 0, 0}, 0.5f, side, side);
    return d;
}

Environment studio()
{
    EnvironmentOptions options;
    options.cube_size = 64, options.use_cache = false;
    return *load_environment("builtin:studio", options, Limits{}, Jobs(1));
}

// Neighbours would differ by their own samples. With sharing, a flat surface has nearly one colour around each pixel, and steps from one
// 2x2 quad to the next are no larger than steps within quads.
TEST(lobe_line, fragments_of_a_surface_share_what_their_neighbours_found)
{
    Stage stage(brushed_square(2.0f, 1));
    stage.environment = studio();
    const FrameDesc d = line_desc(32, 1);
    const Frame f = stage.render(d, best_isa());
    const auto green = [&](int x, int y) { return static_cast<double>(f.color.f32()[3 * (y * 32 + x) + 1]); };
    double within = 0.0, between = 0.0, light = 0.0;
    for (int y = 2; y < 30; ++y)
        for (int x = 2; x < 30; ++x) { // second differences: the surface itself is nearly a ramp
            const double along = std::abs(2 * green(x, y) - green(x - 1, y) - green(x + 1, y));
            const double down = std::abs(2 * green(x, y) - green(x, y - 1) - green(x, y + 1));
            within += along + down, light += green(x, y);
        }
    double inside = 0.0;
    for (int y = 2; y < 30; ++y)
        for (int x = 2; x < 30; ++x) {
            const double step = std::abs(green(x + 1, y) - green(x, y)) + std::abs(green(y, x + 1) - green(y, x));
            (x % 2 ? between : inside) += step;
        }
    std::printf("neighbours bend by %.5f of their light; steps between quads over steps within: %.3f\n", within / light, between / inside);
    EXPECT_LT(within / light, 0.02);
    EXPECT_NEAR(between / inside, 1.0, 0.1);
}

// A window reaches into the tiles around it, so neither their size, their parts nor the threads show.
TEST(lobe_line, pixels_do_not_depend_on_tiles)
{
    for (const int pieces : {1, 30000}) { // 30000: a tile has so many triangles that four threads cut it into parts
        Stage one(brushed_square(0.9f, pieces)), four(brushed_square(0.9f, pieces), 1.0f, 4);
        one.environment = four.environment = studio();
        FrameDesc d = line_desc(150, pieces == 1 ? 4 : 1);
        const Frame f = one.render(d, best_isa());
        const auto expect_same = [&](const Frame& other, const char* of) {
            EXPECT_EQ(f.color.bytes, other.color.bytes) << of << ", " << pieces << " pieces";
            EXPECT_EQ(f.stats.visible_fragments, other.stats.visible_fragments) << of << ", " << pieces << " pieces";
            EXPECT_EQ(f.stats.background_pixels, other.stats.background_pixels) << of << ", " << pieces << " pieces";
        };
        expect_same(four.render(d, best_isa()), "threads");
        for (const Isa isa : available_isas())
            expect_same(one.render(d, isa), "instruction sets");
        d.tile_size = 32;
        expect_same(one.render(d, best_isa()), "small tiles");
        expect_same(four.render(d, best_isa()), "threads with small tiles");
    }
}

// The triangulation of a surface does not show: a pixel's parts share as one.
TEST(lobe_line, pieces_of_a_surface_share_as_one)
{
    Stage whole(brushed_square(2.0f, 1)), cut(brushed_square(2.0f, 40));
    whole.environment = cut.environment = studio();
    const FrameDesc d = line_desc(32, 4);
    const Frame a = whole.render(d, best_isa()), b = cut.render(d, best_isa());
    double most = 0.0;
    for (int i = 0; i < 32 * 32 * 3; ++i)
        most = std::max(most, std::abs(static_cast<double>(a.color.f32()[i] - b.color.f32()[i])) /
                                  (static_cast<double>(a.color.f32()[i]) + 0.01));
    std::printf("largest difference %.4f\n", most);
    EXPECT_LT(most, 0.03);
}

} // namespace
} // namespace burnish::test
