// Visibility of renderers against rays.
#include <gtest/gtest.h>

#include <algorithm>

#include "apps/parity/rays.h"

namespace burnish::test {
namespace {

// Draws a scene by the tile renderer, changes triangle ids, and compares them with rays.
template <class Change> RayCounts judged(const std::string& scene, const Change& change)
{
    OpenOptions open;
    open.threads = 1;
    open.environment.cube_size = 16, open.environment.samples = 16, open.environment.use_cache = false;
    Result<Session> tile = Session::open(scene, "", open);
    EXPECT_TRUE(tile);
    Result<Session> rays = ray_session(tile->parts(), best_isa());
    EXPECT_TRUE(rays);
    FrameDesc desc;
    desc.width = 64, desc.height = 48, desc.msaa = 4, desc.triangle_ids = true;
    desc.view = tile->framed(desc.width, desc.height);
    Result<Frame> frame = tile->render(desc);
    EXPECT_TRUE(frame);
    change(frame->triangle_ids);
    Result<RayCounts> counts = compare_with_rays(*frame, desc, *rays);
    EXPECT_TRUE(counts);
    return *counts;
}

TEST(rays, agree_with_the_tile_renderer)
{
    for (const char* scene : {"builtin:teapot", "builtin:spheres", "builtin:lights"}) {
        const RayCounts c = judged(scene, [](Column<std::uint32_t>&) {});
        EXPECT_EQ(c.samples, 64u * 48u * 4u);
        EXPECT_LT(c.differ, c.samples / 50);
        EXPECT_EQ(c.wrong, 0u) << scene << ", pixel " << c.worst_x << ", " << c.worst_y;
    }
}

TEST(rays, see_a_hole_and_a_triangle_that_is_not_there)
{
    const std::size_t middle = (24 * 64 + 32) * 4 + 1, corner = (1 * 64 + 1) * 4 + 2, aside = (26 * 64 + 21) * 4 + 3;
    const RayCounts holed = judged("builtin:teapot", [&](Column<std::uint32_t>& ids) {
        EXPECT_NE(ids[middle], kNoTriangle);
        ids[middle] = kNoTriangle;
    });
    EXPECT_EQ(holed.wrong, 1u);
    EXPECT_EQ(holed.worst_x, 32);
    EXPECT_EQ(holed.worst_y, 24);
    const RayCounts coplanar = judged("builtin:plate", [&](Column<std::uint32_t>& ids) {
        const std::uint32_t here = ids[aside];
        EXPECT_NE(here, kNoTriangle);
        ids[aside] = *std::find_if(ids.begin(), ids.end(), [&](std::uint32_t id) { return id != here && id != kNoTriangle; });
    });
    EXPECT_EQ(coplanar.wrong, 1u);
    const RayCounts floating = judged("builtin:teapot", [&](Column<std::uint32_t>& ids) {
        EXPECT_EQ(ids[corner], kNoTriangle);
        ids[corner] = 7;
    });
    EXPECT_EQ(floating.wrong, 1u);
}

} // namespace
} // namespace burnish::test
