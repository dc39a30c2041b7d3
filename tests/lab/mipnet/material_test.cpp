// Procedural materials, and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "shading/bake/mipnet/classical.h"
#include "shading/bake/mipnet/net.h"
#include "shading/lab/mipnet/families.h"
#include "shading/lab/mipnet/training_batch.h"

namespace burnish::mipnet {
namespace {

TEST(material, nothing_that_is_tested_is_trained_on_not_even_mirrored)
{
    const Jobs jobs(2);
    std::set<std::uint64_t> trained;
    for (const Material& m : make_training_set(24, 128, jobs).materials)
        trained.insert(source_hash(m.texels));
    EXPECT_EQ(trained.size(), 8u * 24u);
    for (const Family& f : families())
        if (f.held_out) {
            EXPECT_EQ(trained_families().find(f.name), std::string::npos) << f.name;
        }
    const auto all = {make_test_set(jobs), make_validation_set(jobs)};
    for (const std::vector<TestMaterial>& set : all)
        for (const TestMaterial& m : set) {
            EXPECT_EQ(trained.count(source_hash(m.material.texels)), 0u) << m.material.name;
            Material as_trained = make_material({m.material.name.substr(0, m.material.name.find(' ')).c_str(), false},
                                                std::stoull(m.material.name.substr(m.material.name.find(' ') + 1)), 128);
            EXPECT_EQ(trained.count(source_hash(as_trained.texels)), 0u) << m.material.name;
        }
    // A known material would be recognised.
    const Material known = make_material(families()[3], 7, 128);
    for (int symmetry = 0; symmetry < 8; ++symmetry)
        EXPECT_EQ(trained.count(source_hash(mirrored(known.texels, symmetry))), 1u) << symmetry;
}

TEST(material, is_the_same_for_the_same_seed_and_tiles)
{
    for (const Family& f : families()) {
        const Material a = make_material(f, 3, 64), b = make_material(f, 3, 64), c = make_material(f, 4, 64);
        EXPECT_EQ(a.texels.channel[0], b.texels.channel[0]) << f.name;
        EXPECT_NE(source_hash(a.texels), source_hash(c.texels)) << f.name;
        double most = 0.0, border = 0.0; // mean difference of normals between two columns, and across the border
        for (std::size_t x = 0; x < 64; ++x) {
            double sum = 0.0;
            for (std::size_t y = 0; y < 64; ++y)
                sum += std::fabs(static_cast<double>(a.texels.channel[0][64 * y + x]) -
                                 static_cast<double>(a.texels.channel[0][64 * y + (x + 1) % 64])) /
                       64.0;
            (x == 63 ? border : most) = x == 63 ? sum : std::max(most, sum);
        }
        EXPECT_LT(border, 1.6 * most + 0.02) << f.name;
    }
}

TEST(batch, tiles_lie_as_levels_gather_them)
{
    // With n texels a level, texel i covers texels j n + i one level below.
    std::set<std::size_t> places;
    for (int y = 0; y < kTileSide; ++y)
        for (int x = 0; x < kTileSide; ++x)
            for (int tile = 0; tile < kTiles; ++tile) {
                std::size_t at = place_in_shard(x, y, tile);
                places.insert(at);
                int px = x, py = y;
                for (std::size_t n = 16u * 256u; n >= 16u; n /= 4, px /= 2, py /= 2) {
                    EXPECT_EQ(at / n, static_cast<std::size_t>((px & 1) | (py & 1) << 1));
                    at %= n;
                }
                EXPECT_EQ(at, static_cast<std::size_t>(tile));
            }
    EXPECT_EQ(places.size(), 16u * 1024u);
}

} // namespace
} // namespace burnish::mipnet
