// Scenes without materials that let light through or blend.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "apps/lab/race/opaque_scene.h"
#include "core/scene/builtin/builtin.h"

namespace burnish::test {
namespace {

// Returns builtin:glass, a steel disc below four bodies of glass. blended: the disc blends.
std::shared_ptr<const SceneData> glass(bool blended)
{
    Result<Scene> scene = make_builtin_scene("glass");
    EXPECT_TRUE(scene);
    if (blended)
        scene->materials[0].alpha_mode = AlphaMode::blend;
    Result<std::shared_ptr<const SceneData>> data = make_scene_data("glass", std::move(*scene), Limits{});
    EXPECT_TRUE(data) << (data ? "" : data.error().line());
    return *data;
}

TEST(opaque_scene, leaves_glass_out_and_keeps_the_bounds)
{
    const std::shared_ptr<const SceneData> whole = glass(false);
    const Result<OpaqueScene> opaque = opaque_scene(whole);
    ASSERT_TRUE(opaque) << opaque.error().line();
    EXPECT_EQ(left_out_note(*opaque), "4 of 5 materials let light through or blend; neither renderer draws them");
    EXPECT_FALSE(opaque->empty());
    const DrawTables& tables = opaque->data->tables;
    ASSERT_EQ(tables.draws.size(), 1u);
    EXPECT_EQ(tables.draws[0].material, 0);
    EXPECT_EQ(tables.triangle_count(), whole->tables.draws[0].triangle_count);
    EXPECT_EQ(tables.bounds_min, whole->tables.bounds_min);
    EXPECT_EQ(tables.bounds_max, whole->tables.bounds_max);
    EXPECT_EQ(tables.lights.size(), 1u);
    EXPECT_EQ(whole->tables.draws.size(), 5u);
}

TEST(opaque_scene, says_that_nothing_is_left)
{
    const Result<OpaqueScene> opaque = opaque_scene(glass(true));
    ASSERT_TRUE(opaque) << opaque.error().line();
    EXPECT_TRUE(opaque->empty());
    EXPECT_EQ(opaque->left_out, 5);
}

TEST(opaque_scene, is_the_scene_itself_without_such_materials)
{
    Result<Scene> scene = make_builtin_scene("plate");
    ASSERT_TRUE(scene);
    const auto whole = make_scene_data("plate", std::move(*scene), Limits{});
    ASSERT_TRUE(whole);
    const Result<OpaqueScene> opaque = opaque_scene(*whole);
    ASSERT_TRUE(opaque);
    EXPECT_EQ(opaque->data, *whole);
    EXPECT_FALSE(opaque->empty());
    EXPECT_EQ(left_out_note(*opaque), "");
    EXPECT_EQ(left_out_note({nullptr, 1, 6}), "1 of 6 materials lets light through or blends; neither renderer draws it");
}

} // namespace
} // namespace burnish::test
