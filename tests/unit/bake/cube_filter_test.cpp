#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "shading/bake/environment/cube_map.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

constexpr int kSize = 16, kLevels = 5;

CubeMap noise_cube(int size = kSize, int levels = kLevels)
{
    const Jobs jobs(1);
    CubeMap cube = make_cube_map(size, levels, 1.0f);
    Random random(3);
    for (int l = 0; l < levels; ++l) {
        std::vector<float> rgb(cube_texels(size >> l) * 3);
        for (float& v : rgb)
            v = random.in(0.0, 1.0);
        store_cube_level(cube, l, rgb.data(), jobs);
    }
    return cube;
}

struct Directions {
    std::vector<float> x, y, z, lod;
    void add(double dx, double dy, double dz, double l)
    {
        x.push_back(static_cast<float>(dx)), y.push_back(static_cast<float>(dy)), z.push_back(static_cast<float>(dz));
        lod.push_back(static_cast<float>(l));
    }
    std::vector<float> arguments(bool level) const
    {
        std::vector<float> all = x;
        for (const std::vector<float>* column : {&y, &z, &lod})
            if (column != &lod || level)
                all.insert(all.end(), column->begin(), column->end());
        return all;
    }
};

Directions random_directions(int n, int levels)
{
    Random random(11);
    Directions d;
    for (int i = 0; i < n; ++i) {
        const double length = std::exp2(random() * 20.0 - 10.0);
        const double x = random() * 2.0 - 1.0, y = random() * 2.0 - 1.0, z = random() * 2.0 - 1.0;
        d.add(x * length, y * length, z * length, random() * (levels + 1.0) - 1.0);
    }
    return d;
}

std::vector<float> fetch(const IsaFns& isa, const CubeMap& cube, const Directions& d)
{
    return results(isa, "cube", d.arguments(true), view_of(cube));
}

// ---- naive reference in double ----

double naive_bilinear(const CubeMap& cube, int level, double x, double y, double z, int c)
{
    const double ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
    int face;
    double u, v;
    if (ax >= ay && ax >= az) {
        face = x < 0.0, u = (x < 0.0 ? z : -z) / ax, v = -y / ax;
    } else if (ay >= az) {
        face = 2 + (y < 0.0), u = x / ay, v = (y < 0.0 ? -z : z) / ay;
    } else {
        face = 4 + (z < 0.0), u = (z < 0.0 ? -x : x) / az, v = -y / az;
    }
    const int t = cube.size >> level;
    const double px = (u + 1.0) * 0.5 * t - 0.5, py = (v + 1.0) * 0.5 * t - 0.5;
    const int ix = static_cast<int>(std::floor(px)), iy = static_cast<int>(std::floor(py));
    const double fx = px - ix, fy = py - iy;
    const auto at = [&](int i, int j) { return static_cast<double>(cube_texel(cube, level, face, std::min(i, t), std::min(j, t), c)); };
    return (at(ix, iy) * (1 - fx) + at(ix + 1, iy) * fx) * (1 - fy) + (at(ix, iy + 1) * (1 - fx) + at(ix + 1, iy + 1) * fx) * fy;
}

double naive_trilinear(const CubeMap& cube, double x, double y, double z, double lod, int c)
{
    const double l = std::clamp(lod, 0.0, cube.levels - 1.0);
    const int fine = static_cast<int>(l), coarse = std::min(fine + 1, cube.levels - 1);
    const double f = l - fine;
    return naive_bilinear(cube, fine, x, y, z, c) * (1 - f) + naive_bilinear(cube, coarse, x, y, z, c) * f;
}

TEST(cube_filter, equals_the_naive_reference)
{
    for (const int levels : {kLevels, 2, 1}) {
        const CubeMap cube = noise_cube(kSize, levels);
        const Directions d = random_directions(2000, levels);
        const std::vector<float> rgb = fetch(float_fns()[0], cube, d), exact = fetch(oracle_fns(), cube, d);
        for (std::size_t i = 0; i < d.x.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const double x = static_cast<double>(d.x[i]), y = static_cast<double>(d.y[i]), z = static_cast<double>(d.z[i]);
                const double naive = naive_trilinear(cube, x, y, z, static_cast<double>(d.lod[i]), static_cast<int>(c));
                ASSERT_NEAR(static_cast<double>(rgb[3 * i + c]), naive, 2e-5) << i << " of " << levels << " levels";
                ASSERT_NEAR(static_cast<double>(exact[3 * i + c]), naive, 1e-7) << i << " of " << levels << " levels";
            }
    }
}

TEST(cube_filter, addresses_large_cubes_exactly)
{
    const CubeMap cube = noise_cube(1024, 11);
    const Directions d = random_directions(500, 11);
    const std::vector<float> rgb = fetch(float_fns()[0], cube, d);
    for (std::size_t i = 0; i < d.x.size(); ++i)
        ASSERT_NEAR(static_cast<double>(rgb[3 * i]),
                    naive_trilinear(cube, static_cast<double>(d.x[i]), static_cast<double>(d.y[i]), static_cast<double>(d.z[i]),
                                    static_cast<double>(d.lod[i]), 0),
                    1e-3); // float coordinates resolve 2^-14 texels here
}

TEST(cube_filter, faces_follow_their_definition)
{
    struct {
        float x, y, z, face, u, v;
    } const cases[] = {
        {1, 0, 0, 0, .5f, .5f},
        {-2, 0, 0, 1, .5f, .5f},
        {0, 3, 0, 2, .5f, .5f},
        {0, -1, 0, 3, .5f, .5f},
        {0, 0, 1, 4, .5f, .5f},
        {0, 0, -4, 5, .5f, .5f},
        {1, -.5f, -.25f, 0, .625f, .75f},
        {-1, -.5f, .25f, 1, .625f, .75f},
        {.25f, 1, .5f, 2, .625f, .75f},
        {.25f, -1, -.5f, 3, .625f, .75f},
        {.25f, -.5f, 1, 4, .625f, .75f},
        {-.25f, -.5f, -1, 5, .625f, .75f},
        // ties: x before y before z; the zero vector
        {1, 1, 1, 0, 0, 0},
        {-1, 1, 0, 1, .5f, 0},
        {0, -1, -1, 3, .5f, 1},
        {0, 0, 0, 4, .5f, .5f},
    };
    Directions d;
    for (const auto& c : cases)
        d.add(static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z), 0.0);
    for (const IsaFns& isa : float_fns()) {
        const std::vector<float> out = results(isa, "cube_place", d.arguments(false));
        for (std::size_t i = 0; i < 16; ++i) {
            EXPECT_EQ(out[3 * i], cases[i].face) << i;
            EXPECT_EQ(out[3 * i + 1], cases[i].u) << i;
            EXPECT_EQ(out[3 * i + 2], cases[i].v) << i;
        }
    }
}

TEST(cube_filter, any_direction_and_level_stays_inside)
{
    const CubeMap cube = noise_cube();
    const float odd[] = {0.0f, -0.0f, 1.0f, -1.0f, NAN, INFINITY, -INFINITY, 1e-38f, 1e-45f, 3e38f, 0x1.fffffep-1f};
    const float lods[] = {NAN, INFINITY, -INFINITY, 0.0f, 3.999f, 4.0f, 1e9f};
    Directions d;
    std::size_t k = 0;
    for (const float x : odd)
        for (const float y : odd)
            for (const float z : odd)
                d.add(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z),
                      static_cast<double>(lods[k++ % std::size(lods)]));
    for (const IsaFns& isa : float_fns())
        for (const float v : fetch(isa, cube, d))
            ASSERT_TRUE(v >= 0.0f && v <= 1.00001f);
}

// Directions just beside each edge of the cube, and around each corner, give nearly equal colours.
TEST(cube_filter, has_no_seam_at_any_edge_or_corner_of_any_level)
{
    const CubeMap cube = noise_cube();
    const double e = 1e-6;
    for (int level = 0; level < kLevels; ++level) {
        Directions a, b;
        for (int axis = 0; axis < 3; ++axis)
            for (int sign = 0; sign < 4; ++sign)
                for (int i = 0; i <= 200; ++i) {
                    const double s = sign % 2 ? -1.0 : 1.0, t = sign / 2 ? -1.0 : 1.0;
                    const double along = i / 100.0 - 1.0;
                    double p[2][3];
                    for (int side = 0; side < 2; ++side) {
                        p[side][axis] = along;
                        p[side][(axis + 1) % 3] = s * (side ? 1.0 + e : 1.0 - e);
                        p[side][(axis + 2) % 3] = t * (side ? 1.0 - e : 1.0 + e);
                    }
                    a.add(p[0][0], p[0][1], p[0][2], level);
                    b.add(p[1][0], p[1][1], p[1][2], level);
                }
        const std::vector<float> ca = fetch(float_fns()[0], cube, a), cb = fetch(float_fns()[0], cube, b);
        float jump = 0.0f;
        for (std::size_t i = 0; i < ca.size(); ++i)
            jump = std::max(jump, std::fabs(ca[i] - cb[i]));
        // Texels differ by up to 1. 2e-6 of the edge's length is 3e-5 texels at level 0, and the corner's mean is rounded to half.
        EXPECT_LT(jump, 3e-4f) << "level " << level;
    }
}

TEST(cube_filter, uniform_level_equals_the_trilinear_fetch_there)
{
    const CubeMap cube = noise_cube();
    Directions d = random_directions(512, kLevels);
    for (int level = 0; level < kLevels; ++level) {
        std::fill(d.lod.begin(), d.lod.end(), static_cast<float>(level));
        const std::vector<float> expected = fetch(float_fns()[0], cube, d);
        TexelView view = view_of(cube);
        view.level = level;
        EXPECT_EQ(results(float_fns()[0], "cube_level", d.arguments(false), view), expected) << level;
    }
}

TEST(cube_filter, every_instruction_set_gives_the_same_bits)
{
    const CubeMap cube = noise_cube();
    const Directions d = random_directions(4096, kLevels);
    const std::vector<float> expected = fetch(float_fns()[0], cube, d);
    for (const IsaFns& isa : float_fns()) {
        const std::vector<float> got = fetch(isa, cube, d);
        EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(float)), 0) << isa.name;
    }
}

} // namespace
} // namespace burnish
