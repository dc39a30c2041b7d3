#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "core/scene/builtin/builtin.h"
#include "core/simd/dispatch.h"
#include "shading/bake/environment/equirect.h"
#include "shading/bake/environment/light_tree.h"
#include "shading/bake/environment/prefilter.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

constexpr double kTwoPi = 6.283185307179586;

// Returns an environment with detail: bands of a few degrees over smooth colours.
double radiance(double x, double y, double z)
{
    return 1.0 + 0.8 * x + 0.3 * y * z + 0.6 * std::sin(9.0 * x + 4.0 * z) * std::cos(7.0 * y);
}

// Integrates radiance * D(h) n.l over the hemisphere around n, divided by the integral of D(h) n.l. Uses half-vector angles.
double brute_force(const double n[3], double alpha)
{
    const double t[3] = {n[1], n[2], n[0]}; // not parallel to n for the directions used
    double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    const double length = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    for (double& c : b)
        c /= length;
    const double a[3] = {b[1] * n[2] - b[2] * n[1], b[2] * n[0] - b[0] * n[2], b[0] * n[1] - b[1] * n[0]};
    double sum = 0.0, weights = 0.0;
    const int steps = 600;
    for (int j = 0; j < steps; ++j) {
        const double tan_h = std::tan((j + 0.5) / steps * kTwoPi / 8.0 * 0.999999); // up to 45 degrees: l at the horizon
        const double c2 = 1.0 / (1.0 + tan_h * tan_h), cos_l = 2.0 * c2 - 1.0, sin_l = 2.0 * c2 * tan_h;
        const double q = c2 * (alpha * alpha - 1.0) + 1.0, d = 1.0 / (q * q);
        const double weight = d * cos_l * sin_l; // dl = sin_l dtheta dphi, theta_l = 2 theta_h
        for (int i = 0; i < 256; ++i) {
            const double phi = (i + 0.5) / 256 * kTwoPi, x = sin_l * std::cos(phi), y = sin_l * std::sin(phi);
            double l[3];
            for (int c = 0; c < 3; ++c)
                l[c] = x * a[c] + y * b[c] + cos_l * n[c];
            sum += weight * radiance(l[0], l[1], l[2]);
            weights += weight;
        }
    }
    return sum / weights;
}

TEST(prefilter, levels_equal_the_integral_over_the_hemisphere)
{
    const Image image = equirect_of(
        512, [](double x, double y, double z, float* rgb) { rgb[0] = rgb[1] = rgb[2] = static_cast<float>(radiance(x, y, z)); });
    EnvironmentOptions o = small_bake();
    o.cube_size = 128;
    o.samples = 1024;
    const Result<Environment> e = bake_environment(image, "test", o, Jobs(2));
    ASSERT_TRUE(e);
    for (const int level : {1, 2, 3, 4}) {
        const double roughness = static_cast<double>(level) / (e->specular.levels - 1);
        const int n = 128 >> level;
        for (int face = 0; face < 6; ++face) {
            const int x = n / 3, y = n / 5;
            Direction d = cube_direction(face, (x + 0.5) * 2.0 / n - 1.0, (y + 0.5) * 2.0 / n - 1.0);
            const double r = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), v[3] = {d.x / r, d.y / r, d.z / r};
            const double expected = brute_force(v, roughness * roughness);
            EXPECT_NEAR(static_cast<double>(cube_texel(e->specular, level, face, x, y, 0)), expected, 0.015)
                << "level " << level << " face " << face;
        }
    }
}

// Evaluates this integral for a cube with constant texels, with 2x2 Gauss-Legendre points a texel and 6x6 near n.
std::array<double, 3> quadrature(const CubeLevel& cube, const Direction& n, double alpha)
{
    const double a2 = alpha * alpha, step = 2.0 / cube.size, near = 4.0 * step;
    std::array<double, 3> sum{};
    double weights = 0.0;
    for (std::size_t i = 0; i < cube_texels(cube.size); ++i) {
        const std::size_t size = static_cast<std::size_t>(cube.size), texel = i % (size * size);
        const int face = static_cast<int>(i / (size * size));
        const double u = (static_cast<double>(texel % size) + 0.5) * step - 1.0, v = (static_cast<double>(texel / size) + 0.5) * step - 1.0;
        const auto weight_at = [&](double du, double dv, double area) {
            const Direction d = cube_direction(face, u + du, v + dv);
            const double r2 = 1.0 + (u + du) * (u + du) + (v + dv) * (v + dv), r = std::sqrt(r2);
            const double cos_l = (d.x * n.x + d.y * n.y + d.z * n.z) / r, q = 1.0 - (1.0 - a2) * 0.5 * (1.0 + cos_l);
            return std::max(cos_l, 0.0) / (q * q) * area / (r2 * r);
        };
        const Direction c = cube_direction(face, u, v);
        const double r = std::sqrt(1.0 + u * u + v * v);
        const bool fine = std::hypot(c.x / r - n.x, c.y / r - n.y, c.z / r - n.z) < near;
        const int pieces = fine ? 3 : 1;
        const double piece = step / pieces, node = 0.5 * piece / std::sqrt(3.0);
        double w = 0.0;
        for (int k = 0; k < 4 * pieces * pieces; ++k) {
            const double at_u = (k / 4 % pieces - 0.5 * (pieces - 1)) * piece, at_v = (k / 4 / pieces - 0.5 * (pieces - 1)) * piece;
            w += weight_at(at_u + (k % 2 ? node : -node), at_v + (k / 2 % 2 ? node : -node), 0.25 * piece * piece);
        }
        for (std::size_t c3 = 0; c3 < 3; ++c3)
            sum[c3] += w * static_cast<double>(cube.rgb[3 * i + c3]);
        weights += w;
    }
    for (double& s : sum)
        s /= weights;
    return sum;
}

// Returns the root mean square of a level's relative error, over texels all over the cube.
double relative_error(const CubeLevel& level0, const CubeMap& baked, int level, int texels)
{
    Random random(static_cast<std::uint64_t>(level));
    const int n = baked.size >> level;
    const double roughness = static_cast<double>(level) / (baked.levels - 1);
    double sum = 0.0;
    for (int i = 0; i < texels; ++i) {
        const int face = i % 6, x = static_cast<int>(random() * n), y = static_cast<int>(random() * n);
        Direction d = cube_direction(face, (x + 0.5) * 2.0 / n - 1.0, (y + 0.5) * 2.0 / n - 1.0);
        const double r = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        const std::array<double, 3> expected = quadrature(level0, {d.x / r, d.y / r, d.z / r}, roughness * roughness);
        for (int c = 0; c < 3; ++c) {
            const double e = static_cast<double>(cube_texel(baked, level, face, x, y, c)) / expected[static_cast<std::size_t>(c)] - 1.0;
            sum += e * e / 3.0;
        }
    }
    return std::sqrt(sum / texels);
}

// A sun with radiance 9000 in a sky with radiance 1, and lamps and windows: no level has noise or mottles.
TEST(prefilter, every_level_is_within_one_percent_of_quadrature)
{
    for (const char* name : {"sky", "studio"}) {
        const Result<Image> image = make_builtin_environment(name);
        ASSERT_TRUE(image);
        EnvironmentOptions o = small_bake();
        o.cube_size = 128;
        o.samples = EnvironmentOptions{}.samples;
        o.extracted_lights = 0; // keep the sun
        const Result<Environment> e = bake_environment(*image, name, o, Jobs(2));
        ASSERT_TRUE(e);
        const CubeLevel level0 = equirect_to_cube(make_equirect(*image), o.cube_size, Jobs(2));
        for (int level = 1; level < e->specular.levels; ++level) {
            const double error = relative_error(level0, e->specular, level, 24);
            EXPECT_LT(error, 0.01) << name << " level " << level;
        }
    }
}

// Returns the levels of a small smooth environment, down to one texel a face.
std::vector<CubeLevel> smooth_boxes(const Jobs& jobs)
{
    std::vector<CubeLevel> boxes;
    boxes.push_back(equirect_to_cube(make_equirect(smooth_equirect(64)), 32, jobs));
    while (boxes.back().size > 1)
        boxes.push_back(half_cube_level(boxes.back(), jobs));
    return boxes;
}

// Returns the bits of the terms by block.
std::vector<std::vector<std::uint32_t>> terms_by_block(const LightTree& tree, const BlockSquare& square, double alpha, double opening,
                                                       const LightTreeFns& fns = pick<LightTreeFns>())
{
    std::vector<std::vector<std::uint32_t>> found(static_cast<std::size_t>(square.along * square.along));
    GatherScratch scratch;
    const auto keep = [&](int x, int y, std::span<const PrefilterTerm> terms) {
        std::vector<std::uint32_t>& bits = found[static_cast<std::size_t>(y * square.along + x)];
        bits.resize(terms.size() * sizeof(PrefilterTerm) / sizeof(std::uint32_t));
        std::memcpy(bits.data(), terms.data(), terms.size_bytes());
    };
    gather_terms(tree.levels(), square, alpha, opening, scratch, keep, fns);
    return found;
}

TEST(prefilter, blocks_that_share_a_walk_have_the_terms_of_blocks_alone)
{
    const Jobs jobs(2);
    const std::vector<CubeLevel> boxes = smooth_boxes(jobs);
    const LightTree tree = make_light_tree(boxes, jobs), unplaced = make_light_tree(boxes, jobs, 0);
    std::size_t fewest = 1u << 20, most = 0;
    for (const double alpha : {0.02, 0.1, 0.4, 1.0})
        for (const double opening : {0.02, 0.2, 1.0}) // all finest texels to whole faces
            for (const int face : {0, 3, 4}) {
                const BlockSquare square = {face, 4, -1.0, 0.0, 0.25};
                const auto together = terms_by_block(tree, square, alpha, opening);
                ASSERT_EQ(terms_by_block(unplaced, square, alpha, opening), together) << "centres of texels, found anew";
                for (const Isa isa : isas_with<LightTreeFns>())
                    ASSERT_EQ(terms_by_block(tree, square, alpha, opening, pick<LightTreeFns>(isa)), together) << isa_name(isa);
                for (int k = 0; k < 16; ++k) {
                    const BlockSquare one = {face, 1, square.u0 + k % 4 * square.side, square.v0 + k / 4 * square.side, square.side};
                    const auto alone = terms_by_block(tree, one, alpha, opening)[0];
                    ASSERT_EQ(together[static_cast<std::size_t>(k)], alone) << "width " << alpha << ", opening " << opening;
                    fewest = std::min(fewest, alone.size() / 7), most = std::max(most, alone.size() / 7);
                }
            }
    EXPECT_LE(fewest, 12u);
    EXPECT_GT(most, 2000u);
}

TEST(prefilter, every_instruction_set_and_split_gives_the_same_bits)
{
    const Jobs jobs(1);
    const std::vector<CubeLevel> boxes = smooth_boxes(jobs);
    const LightTree tree = make_light_tree(boxes, jobs);
    std::vector<PrefilterTerm> terms;
    GatherScratch scratch;
    gather_terms(tree.levels(), {2, 1, -1.0, -1.0, 1.0}, 0.36, 0.3, scratch,
                 [&](int, int, std::span<const PrefilterTerm> found) { terms.assign(found.begin(), found.end()); });
    const IrradianceSource source = make_irradiance_source(boxes[0]);
    const auto run = [&](const BakeFns& fns, int piece) {
        std::vector<float> out(2 * 6 * 64 * 3);
        for (int face = 0; face < 6; ++face) {
            for (int block = 0; block < 4; ++block)
                fns.prefilter({terms.data(), static_cast<int>(terms.size()), 0.36f}, face, 8, block % 2 * 4, block / 2 * 4,
                              out.data() + (face * 4 + block) * 16 * 3);
            for (int first = 0; first < 64; first += piece)
                fns.irradiance(source.input(), face, 8, first, piece, out.data() + (6 * 64 + face * 64 + first) * 3);
        }
        return out;
    };
    const std::vector<float> expected = run(pick<BakeFns>(Isa::scalar), 64);
    for (const int piece : {4, 16, 64}) {
        for (const Isa isa : isas_with<BakeFns>())
            EXPECT_EQ(run(pick<BakeFns>(isa), piece), expected) << isa_name(isa);
    }
}

} // namespace
} // namespace burnish
