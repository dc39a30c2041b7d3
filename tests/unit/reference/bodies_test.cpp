// Bodies of transmissive materials in the tile renderer: what is measured of their meshes, and what they show.
#include <gtest/gtest.h>

#include <cmath>

#include "raster/frame/bodies.h"
#include "tests/unit/reference/glass.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

// Returns a closed block of glass with half extents `half`, its middle at the origin.
Scene block(const Material& material, const glm::vec3& half)
{
    std::vector<Triangle> triangles = tessellated_box(1.0f, 2);
    for (Triangle& t : triangles) {
        if (glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), t[0] + t[1] + t[2]) < 0.0f)
            std::swap(t[1], t[2]); // all faces turn outwards
        for (glm::vec3& corner : t)
            corner *= half;
    }
    Scene s = scene_of(triangles, false);
    s.materials[0] = material;
    return s;
}

Body body_of(const Scene& scene)
{
    const Stage stage(scene, 1.0f, 2);
    return measure_body(stage.scene, stage.tables, 0, stage.jobs);
}

glm::dvec3 pixel(const Frame& f, int x, int y)
{
    const float* p = f.color.f32() + 3 * (y * f.color.width + x);
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

TEST(bodies, of_balls_are_round_and_of_blocks_flat)
{
    const Body ball = body_of(ball_scene(glass(0.0f), false));
    EXPECT_FALSE(ball.thin);
    EXPECT_NEAR(ball.extent, 2.0, 0.02);
    EXPECT_NEAR(ball.roundness, 1.0, 0.02);
    const Body flat = body_of(block(glass(0.0f), {1.0f, 1.0f, 0.01f}));
    EXPECT_FALSE(flat.thin);
    EXPECT_LT(flat.roundness, 1e-6);
    EXPECT_NEAR(body_of(block(glass(0.0f), {0.5f, 0.5f, 0.5f})).extent, 1.0, 1e-3);
}

TEST(bodies, of_open_meshes_are_thin)
{
    EXPECT_TRUE(body_of(plane_scene(glass(0.0f))).thin);
    Scene cut = ball_scene(glass(0.0f), false);
    cut.indices.resize(cut.indices.size() - 3 * 64 * 2 * 3); // without the rows at its lower pole
    cut.primitives[0].index_count = static_cast<std::uint32_t>(cut.indices.size());
    EXPECT_TRUE(body_of(cut).thin);
}

TEST(bodies, have_the_thickness_of_their_material_in_their_node_s_scale)
{
    Scene ball = ball_scene(glass(0.0f), false);
    ball.materials[0].thickness = 0.01f;
    ball.nodes[0].local = glm::mat4(3.0f);
    ball.nodes[0].local[3][3] = 1.0f;
    update_world(ball);
    const Body body = body_of(ball);
    EXPECT_NEAR(body.extent, 0.03, 1e-6);
    EXPECT_NEAR(body.roundness, 0.005, 2e-4); // a thin wall is nearly a plate
}

// The closed form: at a distance b from its middle, a ball with radius 1 shows the sky where two refractions turn the ray. Light that the
// far side reflects leaves by the next side.
TEST(bodies, a_ball_shows_the_sky_upside_down)
{
    Stage stage(ball_scene(glass(0.0f), false), 1.0f, 2);
    stage.environment = environment_of(sky_gradient, 64, stage.jobs);
    const auto sky = [](double turned) {
        return static_cast<double>(sky_gradient({static_cast<float>(-std::sin(turned)), 0.0f, static_cast<float>(-std::cos(turned))}).x);
    };
    for (double b : {-0.85, -0.6, -0.3, 0.3, 0.6, 0.85}) {
        FrameDesc d = desc_of(4, 4, view_from({0, 0, 1}, 0.01f));
        d.view.eye += glm::vec3(static_cast<float>(b), 0.0f, 0.0f);
        const double in = std::asin(b), out = std::asin(b / 1.5), r = reflectance(std::cos(in), 1.5);
        const double through = sky(2.0 * (in - out)), further = sky(2.0 * (in - out) + kHalfTurn - 2.0 * out),
                     mirrored = sky(-(kHalfTurn - 2.0 * in));
        const double drawn = pixel(stage.render(d, best_isa()), 1, 1).x;
        EXPECT_NEAR(drawn, r * mirrored + (1.0 - r) * ((1.0 - r) * through + r * further), 0.03) << b;
        d.glass = 0;
        EXPECT_GT(std::fabs(pixel(stage.render(d, best_isa()), 1, 1).x - through), 0.05) << "one interface turns light less: " << b;
    }
}

// Returns a block before a wall that emits `colour`, seen from the front.
Scene block_before_wall(const Material& material, const glm::vec3& half, const glm::vec3& colour)
{
    Scene s = block(material, half);
    Material wall = lambert(0.0f);
    wall.unlit = true, wall.base_color = glm::vec4(colour, 1.0f);
    add_scene(s, plane_scene(wall), {0.0f, 0.0f, -1.5f}, 4.0f);
    return s;
}

TEST(bodies, show_opaque_surfaces_behind)
{
    const glm::dvec3 colour(0.2, 0.6, 0.4);
    for (const bool orthographic : {true, false})
        for (const float roughness : {0.0f, 0.5f}) {
            const Stage stage(block_before_wall(glass(roughness, 1.0f), {1.0f, 1.0f, 0.1f}, glm::vec3(colour)), 5.0f, 2);
            FrameDesc d = desc_of(32, 32, orthographic ? view_from({0, 0, 1}, 0.5f) : make_view({0, 0, 3}, {0, 0, 0}, 0.3f, 32, 32));
            const glm::dvec3 seen = pixel(stage.render(d, best_isa()), 15, 16);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen[c], colour[c], 0.01) << orthographic << ' ' << roughness;
            d.glass = 0;
            EXPECT_NEAR(pixel(stage.render(d, best_isa()), 15, 16).x, 5.0, 0.05) << "one interface shows the sky";
        }
}

TEST(bodies, absorb_light_and_tint_it_twice)
{
    Material m = glass(0.0f, 1.0f);
    m.attenuation_distance = 0.5f, m.attenuation_color = {0.25f, 0.5f, 1.0f};
    m.base_color = {1.0f, 1.0f, 0.5f, 1.0f};
    const Stage stage(block_before_wall(m, {1.0f, 1.0f, 0.25f}, {1.0f, 1.0f, 1.0f}), 1.0f, 2);
    const glm::dvec3 seen = pixel(stage.render(desc_of(16, 16, view_from({0, 0, 1}, 0.5f)), best_isa()), 8, 8);
    const float extent = static_cast<float>(measure_body(stage.scene, stage.tables, 0, stage.jobs).extent);
    EXPECT_NEAR(seen.x, std::pow(0.25, static_cast<double>(extent) / 0.5), 0.01);
    EXPECT_NEAR(seen.y, std::pow(0.5, static_cast<double>(extent) / 0.5), 0.01);
    EXPECT_NEAR(seen.z, 0.25, 0.01);
}

TEST(bodies, absorb_light_in_the_reference_too)
{
    BN_NEEDS_EMBREE();
    Material m = glass(0.0f, 1.0f);
    m.attenuation_distance = 0.5f, m.attenuation_color = {0.25f, 0.5f, 1.0f};
    const Stage stage(block(m, {1.0f, 1.0f, 0.25f}), 1.0f, 2);
    ReferenceOptions o;
    o.mode = ReferenceMode::path, o.samples = 64, o.bounces = 8;
    const ChannelEstimate e = estimate_channels(render_reference(stage, desc_of(8, 8, view_from({0, 0, 1}, 0.1f)), o));
    EXPECT_NEAR(e.mean.x, 0.25, 0.005);
    EXPECT_NEAR(e.mean.y, 0.5, 0.005);
    EXPECT_NEAR(e.mean.z, 1.0, 0.005);
}

// Only tiles with bodies are drawn twice; counts, parts of pixels and hashes do not tell.
TEST(bodies, are_the_same_in_all_tiles_and_on_all_threads)
{
    const Scene scene = block_before_wall(glass(0.3f), {0.3f, 0.2f, 0.1f}, {0.2f, 0.6f, 0.4f});
    FrameDesc d = desc_of(200, 150, make_view({0.3f, 0.4f, 3.0f}, {0, 0, 0}, 0.6f, 200, 150));
    d.parts = d.triangle_ids = true, d.msaa = 4;
    const Stage one(scene, 1.0f, 1), two(scene, 1.0f, 2);
    const Frame all = one.render(d, best_isa());
    for (const Isa isa : available_isas())
        for (const int tile : {32, 64}) {
            d.tile_size = tile;
            const Frame f = two.render(d, isa);
            EXPECT_EQ(pixel_hash(f.color), pixel_hash(all.color)) << tile;
            EXPECT_EQ(f.stats.visible_fragments, all.stats.visible_fragments);
            EXPECT_EQ(f.stats.background_pixels, all.stats.background_pixels);
            ASSERT_EQ(f.parts.size(), all.parts.size());
        }
    d.glass = 0;
    const Frame single = one.render(d, best_isa());
    EXPECT_NE(pixel_hash(single.color), pixel_hash(all.color));
    EXPECT_EQ(single.stats.visible_fragments, all.stats.visible_fragments);
    EXPECT_EQ(single.stats.background_pixels, all.stats.background_pixels);
    EXPECT_EQ(single.parts.size(), all.parts.size());
    EXPECT_TRUE(std::equal(single.triangle_ids.begin(), single.triangle_ids.end(), all.triangle_ids.begin()));
}

} // namespace
} // namespace burnish::test
