// Interpolated values at visible points against double precision, and recorded values against numbers in order.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shading/lang/recorded.h"
#include "shading/surface/recorded.t.h"
#include "shading/surface/visible_point.t.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

// Types that assembly requires of recorders and triangles (shading/lang).
struct Words {
    std::vector<float> at;
};
void put_real(Words& w, real x)
{
    w.at.push_back(x);
}

// Fill values with the numbers after `last`.
void number(real& to, float& last)
{
    to = ++last;
}
void number(real2& to, float& last)
{
    to.x = ++last, to.y = ++last;
}
void number(real3& to, float& last)
{
    to.x = ++last, to.y = ++last, to.z = ++last;
}

struct WholeTriangle : triangle_setup {
    double words[3][16], place[3][3]; // numbers of floats
};
void blend_vertices(const ShadingFrame&, const WholeTriangle& t, real3 b, bool all_words, vertex_words& a)
{
    for (int i = 0; i < (all_words ? 16 : 8); ++i)
        a.at[i] =
            b.x * static_cast<float>(t.words[0][i]) + b.y * static_cast<float>(t.words[1][i]) + b.z * static_cast<float>(t.words[2][i]);
}
real4 vertex_coordinates(const ShadingFrame&, const WholeTriangle& t, int k)
{
    const double* const w = t.words[k] + 8;
    return {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2]), static_cast<float>(w[3])};
}
real3 vertex_place(const ShadingFrame&, const WholeTriangle& t, int k)
{
    return {static_cast<float>(t.place[k][0]), static_cast<float>(t.place[k][1]), static_cast<float>(t.place[k][2])};
}

constexpr int kWidth = 256, kHeight = 192, kSamples = 4;

ShadingFrame frame_of_four_samples()
{
    ShadingFrame f = {};
    f.width = kWidth, f.height = kHeight, f.msaa = kSamples;
    f.center_x = kWidth / 2 * kSubpixel, f.center_y = kHeight / 2 * kSubpixel;
    f.half_width = kWidth / 2, f.half_height = kHeight / 2;
    f.view.right[0] = f.view.up[1] = 1.0f, f.view.forward[2] = -1.0f;
    f.view.inv_tan_x = f.view.inv_tan_y = 1.0f, f.view.znear = 0.125f;
    constexpr int kX[] = {96, 224, 32, 160}, kY[] = {32, 96, 160, 224};
    for (int s = 0; s < kSamples; ++s)
        f.pattern.x[s] = kX[s], f.pattern.y[s] = kY[s];
    return f;
}

// The attributes of a triangle in double precision, and whether it covers a point (1/256 pixel from the centre pixel).
struct Exact {
    double b[3];
    bool inside;
};
Exact exact_weights(const WholeTriangle& t, double x, double y)
{
    Exact r = {{0, 0, 0}, true};
    const double inv_w[3] = {t.inv_w.x, t.inv_w.y, t.inv_w.z};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        const int p = (i + 1) % 3, q = (i + 2) % 3;
        const double e = (t.x[p] - x) * (t.y[q] - y) - (t.x[q] - x) * (t.y[p] - y);
        r.inside = r.inside && e >= 0.0;
        r.b[i] = e * inv_w[i];
        sum += r.b[i];
    }
    for (double& b : r.b)
        b /= sum;
    return r;
}
double exact_word(const WholeTriangle& t, const Exact& at, int word)
{
    return at.b[0] * t.words[0][word] + at.b[1] * t.words[1][word] + at.b[2] * t.words[2][word];
}

WholeTriangle random_triangle(Random& random)
{
    WholeTriangle t = {};
    do {
        for (int i = 0; i < 3; ++i)
            t.x[i] = random.below(40 * kSubpixel) - 20 * kSubpixel, t.y[i] = random.below(40 * kSubpixel) - 20 * kSubpixel;
    } while ((t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]) < 60 * kSubpixel * kSubpixel);
    t.inv_w = {0.5f + random.unit(), 0.5f + random.unit(), 0.5f + random.unit()};
    t.info = random.below(2) * kFrontFacing;
    for (int i = 0; i < 3; ++i) {
        for (double& word : t.words[i])
            word = static_cast<double>(2.0f * random.unit() - 1.0f);
        for (double& c : t.place[i])
            c = static_cast<double>(4.0f * random.unit());
    }
    return t;
}

TEST(visible_point, equals_interpolation_in_double_precision)
{
    const ShadingFrame f = frame_of_four_samples();
    const view_params view = view_params_of(f.view);
    Random random{5};
    double worst = 0.0;
    int centroids = 0, points = 0;
    for (int k = 0; k < 60; ++k) {
        const WholeTriangle t = random_triangle(random);
        for (int py = kHeight / 2 - 21; py <= kHeight / 2 + 21; ++py)
            for (int px = kWidth / 2 - 21; px <= kWidth / 2 + 21; ++px) {
                const int corner_x = px * kSubpixel - f.center_x, corner_y = py * kSubpixel - f.center_y;
                int samples = 0, count = 0, sum_x = 0, sum_y = 0;
                for (int s = 0; s < kSamples; ++s)
                    if (exact_weights(t, corner_x + f.pattern.x[s], corner_y + f.pattern.y[s]).inside)
                        samples |= 1 << s, ++count, sum_x += f.pattern.x[s], sum_y += f.pattern.y[s];
                if (!samples)
                    continue;
                const visible_point p = point_of(f, view, t, px, py, samples, true, true, true, false);
                const int middle_x = corner_x + kSubpixel / 2, middle_y = corner_y + kSubpixel / 2;
                const Exact center = exact_weights(t, middle_x, middle_y);
                const int x = center.inside ? middle_x : corner_x + sum_x / count, y = center.inside ? middle_y : corner_y + sum_y / count;
                const Exact at = exact_weights(t, x, y);
                const int step_x = px % 2 ? -1 : 1, step_y = py % 2 ? -1 : 1;
                const Exact right = exact_weights(t, middle_x + step_x * kSubpixel, middle_y);
                const Exact below = exact_weights(t, middle_x, middle_y + step_y * kSubpixel);
                const auto expect = [&](float got, double wanted) {
                    worst = std::fmax(worst, std::fabs(static_cast<double>(got) - wanted));
                };
                expect(p.normal.x, exact_word(t, at, 0)), expect(p.normal.z, exact_word(t, at, 2));
                expect(p.tangent.y, exact_word(t, at, 4));
                expect(p.uv0.x, exact_word(t, at, 8)), expect(p.uv0.y, exact_word(t, at, 9));
                expect(p.uv1.x, exact_word(t, at, 10)), expect(p.uv1.y, exact_word(t, at, 11));
                expect(p.color.x, exact_word(t, at, 12)), expect(p.color.w, exact_word(t, at, 15));
                for (int i = 0; i < 4; ++i) {
                    const float dx[] = {p.uv0_dx.x, p.uv0_dx.y, p.uv1_dx.x, p.uv1_dx.y};
                    const float dy[] = {p.uv0_dy.x, p.uv0_dy.y, p.uv1_dy.x, p.uv1_dy.y};
                    const double here = exact_word(t, center, 8 + i);
                    expect(dx[i], (exact_word(t, right, 8 + i) - here) * step_x);
                    expect(dy[i], (exact_word(t, below, 8 + i) - here) * step_y);
                }
                expect(p.position.y, at.b[0] * t.place[0][1] + at.b[1] * t.place[1][1] + at.b[2] * t.place[2][1]);
                expect(p.ray.x, (x + f.center_x) / 128.0 / kWidth - 1.0);
                expect(p.ray.y, 1.0 - (y + f.center_y) / 128.0 / kHeight);
                EXPECT_EQ(p.tangent_sign, exact_word(t, at, 6) < 0.0 ? -1.0f : 1.0f);
                EXPECT_EQ(p.front, t.info != 0);
                centroids += !center.inside, ++points;
            }
    }
    std::printf("%d points, %d of them not at the pixel's centre; largest difference %.2g\n", points, centroids, worst);
    EXPECT_GT(centroids, 100);
    EXPECT_GT(points, 1000);
    EXPECT_LT(worst, 2e-5);
}

TEST(visible_point, words_are_recorded_in_order_and_what_is_not_asked_for_as_zeros)
{
    visible_point p;
    p.normal = {1, 2, 3}, p.tangent = {4, 5, 6}, p.tangent_sign = -1, p.color = {7, 8, 9, 10};
    p.uv0 = {11, 12}, p.uv0_dx = {13, 14}, p.uv0_dy = {15, 16}, p.uv1 = {17, 18}, p.uv1_dx = {19, 20}, p.uv1_dy = {21, 22};
    p.front = true, p.ray = {23, 24, 25}, p.position = {26, 27, 28};
    Words all, few;
    record_point(all, p, true, true, true);
    record_point(few, p, false, false, false);
    EXPECT_EQ(all.at, (std::vector<float>{1,  2,  3,  4,  5,  6,  -1, 7,  8, 9,  10, 11, 12, 13, 14,
                                          15, 16, 17, 18, 19, 20, 21, 22, 1, 23, 24, 25, 26, 27, 28}));
    EXPECT_EQ(few.at, (std::vector<float>{1, 2, 3, 4, 5, 6, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 23, 24, 25, 0, 0, 0}));
    EXPECT_EQ(static_cast<int>(all.at.size()), kInterpolantWords);
    material_inputs at = {};
    float last = 0.0f;
#define BN_INPUT(type, words, name) number(at.name, last);
#include "shading/material.def"
    Words material;
    record_material(material, at);
    ASSERT_EQ(static_cast<int>(material.at.size()), kMaterialWords);
    for (int i = 0; i < kMaterialWords; ++i)
        EXPECT_EQ(material.at[static_cast<std::size_t>(i)], static_cast<float>(i + 1));
}

} // namespace
} // namespace burnish::test
