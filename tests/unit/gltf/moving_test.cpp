// Moving objects: animations at a time, skins, morph targets, instances, each against values derived by hand from the specification.
#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>
#include <string>

#include "asset.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Result<Scene> load_at(const Asset& asset, std::optional<float> seconds, int animation = 0)
{
    const std::string text = asset.gltf();
    return load_gltf_bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), "test.gltf", {}, {seconds, animation});
}

// Returns a triangle whose node moves by one channel with keys at 1, 2 and 4 seconds.
Asset moved_triangle(const std::string& path, const std::string& kind, const std::string& type, const std::vector<float>& values,
                     std::size_t elements)
{
    Asset asset = triangle();
    const int times = asset.accessor(floats({1, 2, 4}), kF32, "SCALAR", 3, R"(,"min":[1],"max":[4])");
    const int output = asset.accessor(floats(values), kF32, type, elements);
    asset.more = fmt::format(R"(,"animations":[{{"samplers":[{{"input":{},"output":{},"interpolation":"{}"}}],)"
                             R"("channels":[{{"sampler":0,"target":{{"node":0,"path":"{}"}}}}]}}])",
                             times, output, kind, path);
    return asset;
}

// Returns the world position of the first node's origin.
glm::vec3 origin_of(const Scene& scene)
{
    return glm::vec3(scene.nodes.at(0).world[3]);
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-6f)
{
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

TEST(moving, a_scene_without_a_moment_rests_and_says_so)
{
    const Result<Scene> scene = load_at(moved_triangle("translation", "LINEAR", "VEC3", {5, 0, 0, 6, 0, 0, 7, 0, 0}, 3), {});
    ASSERT_TRUE(scene) << error_of(scene);
    expect_near(origin_of(*scene), {0, 0, 0});
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_NE(scene->warnings[0].find("Moment::seconds"), std::string::npos);
}

TEST(moving, keys_are_held_blended_or_splined)
{
    const std::vector<float> keys = {5, 0, 0, 6, 2, 0, 8, 0, 4};
    const struct {
        const char* kind;
        float time;
        glm::vec3 at;
    } rows[] = {{"LINEAR", 0.0f, {5, 0, 0}}, {"LINEAR", 1.25f, {5.25f, 0.5f, 0}}, {"LINEAR", 2.0f, {6, 2, 0}}, {"LINEAR", 3.0f, {7, 1, 2}},
                {"LINEAR", 9.0f, {8, 0, 4}}, {"STEP", 1.99f, {5, 0, 0}},          {"STEP", 2.0f, {6, 2, 0}},   {"STEP", 3.99f, {6, 2, 0}}};
    for (const auto& row : rows) {
        const Result<Scene> scene = load_at(moved_triangle("translation", row.kind, "VEC3", keys, 3), row.time);
        ASSERT_TRUE(scene) << error_of(scene);
        SCOPED_TRACE(fmt::format("{} at {}", row.kind, row.time));
        expect_near(origin_of(*scene), row.at);
        EXPECT_EQ(scene->warnings.size(), row.time > 4.0f ? 1u : 0u);
    }
    // Each key has in-tangent, value, out-tangent. Between keys 2 and 4 the result is the cubic with those values and slopes.
    const std::vector<float> spline = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 3, 0, 0, 5, 0, 0, 4, 0, 0, 0, 0, 0};
    const Result<Scene> scene = load_at(moved_triangle("translation", "CUBICSPLINE", "VEC3", spline, 9), 3.0f);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_near(origin_of(*scene), {0.5f * 2 + 0.125f * 2 * 3 + 0.5f * 4 - 0.125f * 2 * 5, 0, 0});
}

TEST(moving, rotations_go_the_shorter_way_at_a_steady_rate)
{
    const float half = std::sqrt(0.5f); // 0, then 90 degrees about z with the opposite sign, then 90 degrees
    const Result<Scene> scene =
        load_at(moved_triangle("rotation", "LINEAR", "VEC4", {0, 0, 0, 1, 0, 0, -half, -half, 0, 0, half, half}, 3), 1.0f + 1.0f / 3.0f);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_near(glm::vec3(scene->nodes[0].world[0]), {std::cos(0.5235988f), 0.5f, 0}, 2e-6f);
}

TEST(moving, morph_targets_move_by_their_weights)
{
    Asset asset = triangle();
    const int offsets = asset.accessor(floats({0, 0, 1, 0, 2, 0, 0, 0, 0}), kF32, "VEC3", 3, R"(,"min":[0,0,0],"max":[0,2,1])");
    asset.primitive = fmt::format(R"(,"targets":[{{"POSITION":{}}}])", offsets);
    const Result<Scene> plain = load_at(asset, {});
    ASSERT_TRUE(plain) << error_of(plain);
    EXPECT_EQ(plain->vertices.pz[0], 0.0f);
    asset.node = R"(,"weights":[0.5])";
    const Result<Scene> scene = load_at(asset, {});
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    const VertexTable& v = scene->vertices;
    ASSERT_EQ(v.size(), 3u); // and no vertex of the undeformed mesh
    expect_near({v.px[0], v.py[0], v.pz[0]}, {0, 0, 0.5f});
    expect_near({v.px[1], v.py[1], v.pz[1]}, {1, 1, 0});
    expect_near({v.px[2], v.py[2], v.pz[2]}, {0, 1, 0});
    EXPECT_LT(v.nz[0], 0.99f); // the bent triangle's normal

    Asset animated = moved_triangle("weights", "LINEAR", "SCALAR", {0, 1, 0}, 3);
    const int more = animated.accessor(floats({0, 0, 1, 0, 0, 0, 0, 0, 0}), kF32, "VEC3", 3, R"(,"min":[0,0,0],"max":[0,0,1])");
    animated.primitive = fmt::format(R"(,"targets":[{{"POSITION":{}}}])", more);
    const Result<Scene> moment = load_at(animated, 1.75f);
    ASSERT_TRUE(moment) << error_of(moment);
    EXPECT_FLOAT_EQ(moment->vertices.pz[0], 0.75f);
}

// Two joints: the first moves by 10 along x, the second turns by 90 degrees about z. Equal weights give the mean.
TEST(moving, skins_bend_meshes_by_their_joints)
{
    Asset asset = triangle();
    const float half = std::sqrt(0.5f);
    asset.attribute("NORMAL", asset.accessor(floats({0, 0, 1, 1, 0, 0, 0, 0, 1}), kF32, "VEC3", 3));
    asset.attribute("JOINTS_0", asset.accessor({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, kU8, "VEC4", 3));
    asset.attribute("WEIGHTS_0", asset.accessor(floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}), kF32, "VEC4", 3));
    const int inverse = asset.accessor(
        floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), kF32, "MAT4", 2);
    asset.nodes = fmt::format(R"(,"scenes":[{{"nodes":[0]}}],"nodes":[{{"children":[1,2,3]}},{{"mesh":0,"skin":0,"translation":[7,7,7]}},)"
                              R"({{"translation":[10,0,0]}},{{"rotation":[0,0,{0},{0}]}}])",
                              half);
    asset.more = fmt::format(R"(,"skins":[{{"joints":[2,3],"inverseBindMatrices":{}}}])", inverse);
    const Result<Scene> scene = load_at(asset, {});
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0];
    const VertexTable& v = scene->vertices;
    ASSERT_EQ(v.size(), 3u);
    expect_near({v.px[0], v.py[0], v.pz[0]}, {9, 0, 0});    // (0,0,0) - (1,0,0) + (10,0,0), for any node position
    expect_near({v.px[1], v.py[1], v.pz[1]}, {0, 1, 0});    // (1,0,0) turned
    expect_near({v.px[2], v.py[2], v.pz[2]}, {4, 0.5f, 0}); // the mean of (9,1,0) and (-1,0,0)
    expect_near({v.nx[1], v.ny[1], v.nz[1]}, {0, 1, 0});
    int meshes = 0;
    for (const Node& node : scene->nodes)
        if (node.mesh != kNone) {
            ++meshes;
            EXPECT_EQ(node.world, glm::mat4(1.0f));
        }
    EXPECT_EQ(meshes, 1);
}

TEST(moving, instances_are_nodes)
{
    Asset asset = triangle();
    const int places = asset.accessor(floats({1, 0, 0, 0, 2, 0}), kF32, "VEC3", 2),
              sizes = asset.accessor(floats({1, 1, 1, 3, 3, 3}), kF32, "VEC3", 2);
    asset.node =
        fmt::format(R"(,"translation":[0,0,5],"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{},"SCALE":{}}}}}}})",
                    places, sizes);
    asset.more = R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])";
    const Result<Scene> scene = load_at(asset, {});
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_TRUE(scene->warnings.empty());
    ASSERT_EQ(scene->nodes.size(), 3u);
    EXPECT_EQ(scene->nodes[0].mesh, kNone);
    expect_near(glm::vec3(scene->nodes[1].world[3]), {1, 0, 5});
    expect_near(glm::vec3(scene->nodes[2].world[3]), {0, 2, 5});
    expect_near(glm::vec3(scene->nodes[2].world[0]), {3, 0, 0});
    EXPECT_EQ(scene->nodes[1].mesh, 0);
    asset.node = R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":99}}})";
    EXPECT_EQ(error_of(load_at(asset, {})), "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION: is no accessor");
    const int turns = asset.accessor(floats({0, 0, 0, 1, 0, 0, 0, 0}), kF32, "VEC4", 2);
    asset.node = fmt::format(R"(,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"ROTATION":{}}}}}}})", turns);
    EXPECT_EQ(error_of(load_at(asset, {})),
              "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION: element 1 is not a unit quaternion");
}

TEST(moving, what_cannot_be_moved_is_said)
{
    const Asset asset = moved_triangle("translation", "LINEAR", "VEC3", {5, 0, 0, NAN, 0, 0, 7, 0, 0}, 3);
    EXPECT_EQ(error_of(load_at(asset, 2.0f)), "/animations/0/channels/0: gives a translation that is NaN or infinite");
    const Asset turned = moved_triangle("rotation", "LINEAR", "VEC4", {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1}, 3);
    EXPECT_EQ(error_of(load_at(turned, 2.0f)), "/animations/0/channels/0: gives a rotation that is not a unit quaternion");
    EXPECT_EQ(error_of(load_at(asset, 2.0f, 3)).substr(0, 11), "/animations");
    EXPECT_EQ(error_of(load_at(triangle(), 2.0f)).substr(0, 11), "/animations");
}

} // namespace
