// Pictures by burnish's own rays: references as by Embree, and contact shadows as by closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/builtin/builtin.h"
#include "core/scene/origin.h"
#include "raster/session/floor.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

TEST(own_rays, draw_the_reference_of_embree)
{
    BN_NEEDS_EMBREE();
    for (const char* name : {"teapot", "bumps", "lights"}) {
        Result<Scene> scene = make_builtin_scene(name);
        ASSERT_TRUE(scene);
        for (const ReferenceMode mode : {ReferenceMode::shadowed, ReferenceMode::path}) {
            const Stage stage(*scene, 1.0f, 2);
            FrameDesc desc = desc_of(48, 36, auto_frame(stage.tables, 48, 36));
            ReferenceOptions options;
            options.mode = mode, options.samples = 64;
            const Frame embree = render_reference(stage, desc, options);
            options.own_rays = true;
            const Frame own = render_reference(stage, desc, options);
            // Rays that meet an edge choose a side by rounding, so a few samples of a pixel differ
            double off = 0.0, all = 0.0;
            for (std::size_t i = 0; i < own.color.bytes.size() / sizeof(float); ++i) {
                off += std::fabs(static_cast<double>(own.color.f32()[i]) - static_cast<double>(embree.color.f32()[i]));
                all += static_cast<double>(embree.color.f32()[i]);
            }
            EXPECT_LT(off, 2e-3 * all) << name;
            EXPECT_GT(all, 100.0) << name;
        }
    }
}

struct Floored {
    Scene scene;
    DrawTables tables;
    Column<float> visibility;
};

Floored floored(Scene scene, FloorKind kind, int threads = 2)
{
    update_world(scene);
    settle_origin(scene);
    Floored f{std::move(scene), {}, {}};
    FloorSettings settings;
    settings.kind = kind, settings.threads = threads;
    Result<Column<float>> visibility = lay_floor(f.scene, settings, Limits(), "scene");
    EXPECT_TRUE(visibility);
    update_world(f.scene);
    f.tables = make_draw_tables(f.scene);
    f.visibility = std::move(*visibility);
    darken_vertices(f.tables, f.visibility);
    return f;
}

// A ball's centre is h above a place and d away. If all of the ball is above the horizon, it hides h r^2 / d^3 of the sky's cosine.
TEST(contact_shadows, below_a_ball_are_the_closed_form)
{
    const Floored f = floored(ball_scene(lambert(0.5f), false), FloorKind::shadow);
    int near = 0, all = 0;
    double sum = 0.0;
    for (const Draw& draw : f.tables.draws) {
        if (!draw.stage)
            continue;
        for (std::uint32_t v = draw.first_vertex; v < draw.first_vertex + draw.vertex_count; ++v) {
            const double x = static_cast<double>(f.tables.px[v]), z = static_cast<double>(f.tables.pz[v]);
            const double h = -static_cast<double>(f.tables.py[v]), away2 = x * x + z * z + h * h;
            const double hidden = h / (away2 * std::sqrt(away2));
            if (std::sqrt(x * x + z * z) > 1.8 * std::sqrt(3.0)) // from there on the floor brightens to its rim
                continue;
            const double off = static_cast<double>(f.tables.shading[v].color[0]) - (1.0 - hidden);
            EXPECT_LT(std::fabs(off), 0.03) << x << " " << z;
            sum += off, near += hidden > 0.5, ++all;
        }
    }
    EXPECT_GT(near, 1000);
    EXPECT_LT(std::fabs(sum), 0.003 * all);
}

TEST(contact_shadows, are_the_same_for_any_number_of_threads)
{
    Result<Scene> scene = make_builtin_scene("lacquer");
    ASSERT_TRUE(scene);
    const Floored one = floored(*scene, FloorKind::stage, 1), three = floored(*scene, FloorKind::stage, 3);
    ASSERT_EQ(one.tables.shading.size(), three.tables.shading.size());
    std::size_t darkened = 0;
    for (std::size_t v = 0; v < one.tables.shading.size(); ++v) {
        ASSERT_EQ(one.tables.shading[v].color[0], three.tables.shading[v].color[0]);
        darkened += v < one.visibility.size() && one.visibility[v] < 0.9f;
    }
    EXPECT_GT(darkened, 50u); // of the disc below the balls
}

TEST(floor, is_framed_by_no_view_and_lies_below_the_scene)
{
    for (const FloorKind kind : {FloorKind::shadow, FloorKind::stage}) {
        Result<Scene> scene = make_builtin_scene("teapot");
        ASSERT_TRUE(scene);
        const DrawTables bare = make_draw_tables(*scene);
        const Floored f = floored(*scene, kind);
        EXPECT_GT(f.tables.triangle_count(), bare.triangle_count());
        EXPECT_EQ(f.tables.bounds_min, bare.bounds_min);
        EXPECT_EQ(f.tables.bounds_max, bare.bounds_max);
        EXPECT_EQ(auto_frame(f.tables, 64, 48).eye, auto_frame(bare, 64, 48).eye);
        for (const Draw& draw : f.tables.draws)
            if (draw.stage) {
                EXPECT_LT(draw.bounds_min.y, bare.bounds_min.y);
            }
    }
}

TEST(floor, lies_below_scenes_far_away)
{
    const auto floor_of = [](const glm::vec3& away) {
        Scene scene = ball_scene(lambert(0.5f), false);
        for (Node& node : scene.nodes)
            node.local[3] += glm::vec4(away, 0.0f);
        const Floored f = floored(std::move(scene), FloorKind::stage);
        glm::vec3 low(0.0f), high(0.0f);
        for (const Draw& draw : f.tables.draws)
            if (draw.stage)
                low = glm::min(low, draw.bounds_min - f.tables.bounds_min), high = glm::max(high, draw.bounds_max - f.tables.bounds_min);
        return std::pair(low, high);
    };
    const auto [low, high] = floor_of(glm::vec3(0.0f));
    EXPECT_LT(low.x, -5.0f);
    EXPECT_GT(high.x, 5.0f);
    for (const glm::vec3& away : {glm::vec3(0.0f, 0.0f, 40.0f), {4.6e6f, -128.0f, 1.2e6f}}) {
        const auto [far_low, far_high] = floor_of(away);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(far_low[axis], low[axis], 1e-4f) << away.z;
            EXPECT_NEAR(far_high[axis], high[axis], 1e-4f) << away.z;
        }
    }
}

TEST(floor, of_a_reference_that_finds_shadows_itself_has_none)
{
    Scene scene = ball_scene(lambert(0.5f), false);
    update_world(scene);
    FloorSettings settings;
    settings.kind = FloorKind::shadow, settings.shaded = false;
    const Result<Column<float>> visibility = lay_floor(scene, settings, Limits(), "scene");
    ASSERT_TRUE(visibility);
    EXPECT_EQ(visibility->size(), 0u);
    EXPECT_FALSE(scene.primitives.back().has_color && scene.vertices.cr[scene.primitives.back().first_vertex] != 1.0f);
}

TEST(floor, below_nothing_is_none)
{
    Scene scene;
    scene.materials.emplace_back();
    FloorSettings settings;
    settings.kind = FloorKind::stage;
    ASSERT_TRUE(lay_floor(scene, settings, Limits(), "scene"));
    EXPECT_TRUE(scene.nodes.empty());
}

} // namespace
} // namespace burnish::test
