// Where methods fail, pixels still have equal bits for all thread counts, instruction sets and tile sizes.
#include <gtest/gtest.h>

#include "apps/lab/atlas/picture_cache.h"
#include "core/lab/failure_scenes.h"

namespace burnish {
namespace {

const bool kScenesAdded = (add_parametric_scenes(failure_scenes()), true);

struct Road {
    int threads;
    Isa isa;
    int tile_size;
};

std::vector<Road> roads()
{
    std::vector<Road> out = {{1, Isa::scalar, 32}};
    for (const Isa isa : program_isas())
        if (isa_available(isa))
            out.push_back({3, isa, 64});
    return out;
}

// Compares pixels at places of every path. At the last place the technique fails.
void check_roads(const std::vector<double>& places, int side)
{
    ASSERT_TRUE(kScenesAdded);
    Report report(true, 0);
    std::vector<PictureCache> rooms;
    const std::vector<Road> all = roads();
    for (const Road& road : all)
        rooms.emplace_back(PictureCache::Machine{std::make_shared<const Jobs>(road.threads), road.isa, {false, ""}, nullptr}, report);
    for (const AtlasEntry& entry : atlas_entries())
        for (const double s : places) {
            Result<AtlasSetting> setting = setting_of(entry, AtlasRole::test, s, side, 0);
            ASSERT_TRUE(setting) << setting.error().line();
            setting->options.environment.cube_size = std::min(setting->options.environment.cube_size, 32);
            setting->options.environment.samples = 32, setting->options.environment.use_cache = false;
            std::optional<std::uint64_t> first;
            for (std::size_t r = 0; r < all.size(); ++r) {
                setting->options.frame.tile_size = all[r].tile_size;
                const Result<Frame> frame = rooms[r].draw(*setting);
                ASSERT_TRUE(frame) << entry.id << ": " << frame.error().line();
                const std::uint64_t hash = pixel_hash(frame->color);
                EXPECT_EQ(hash, first.value_or(hash)) << entry.id << " at " << s << " by " << isa_name(all[r].isa);
                first = first.value_or(hash);
            }
        }
}

TEST(atlas_roads, broken_pictures_are_the_same_words_on_every_road)
{
    check_roads({1.0}, 40); // more than one tile of 32
}

TEST(atlas_roads, all_pictures_are_the_same_words_on_every_road)
{
    check_roads({0.0, 0.2, 0.4, 0.6, 0.8, 1.0}, 72);
}

} // namespace
} // namespace burnish
