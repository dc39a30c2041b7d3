// Nodes, cameras, lights, external files, extensions.
#include <gtest/gtest.h>

#include "asset.h"
#include "core/scene/gltf/extensions.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Result<Scene> load_nodes(const std::string& nodes, const std::string& more = "")
{
    Asset asset = triangle();
    asset.nodes = nodes;
    asset.more = more;
    return load(asset);
}

const std::string kLights = R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)"
                            R"({"type":"point","name":"bulb","color":[1,0.5,0.25],"intensity":40,"range":7},)"
                            R"({"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}},{"type":"directional"}]}})";

} // namespace

TEST(scene, translation_rotation_scale_equals_its_matrix)
{
    // Scale by 2 3 4, then half a turn about Z (quaternion 0 0 1 0), then a move by 5 6 7.
    const Result<Scene> trs = load_nodes(R"(,"nodes":[{"mesh":0,"translation":[5,6,7],"rotation":[0,0,1,0],"scale":[2,3,4]}])");
    const Result<Scene> matrix = load_nodes(R"(,"nodes":[{"mesh":0,"matrix":[-2,0,0,0, 0,-3,0,0, 0,0,4,0, 5,6,7,1]}])");
    ASSERT_TRUE(trs) << error_of(trs);
    ASSERT_TRUE(matrix) << error_of(matrix);
    EXPECT_EQ(trs->nodes[0].local, matrix->nodes[0].local);
    EXPECT_EQ(trs->nodes[0].world[3], glm::vec4(5, 6, 7, 1));
}

TEST(scene, quarter_turn_about_y_takes_z_to_x)
{
    const Result<Scene> scene = load_nodes(R"(,"nodes":[{"rotation":[0,0.70710678,0,0.70710678]}])");
    ASSERT_TRUE(scene) << error_of(scene);
    const glm::vec4 x = scene->nodes[0].local * glm::vec4(0, 0, 1, 0);
    EXPECT_NEAR(x.x, 1.0f, 1e-6f);
    EXPECT_NEAR(x.z, 0.0f, 1e-6f);
}

TEST(scene, parents_come_first_and_only_the_default_scene_is_kept)
{
    const Result<Scene> scene =
        load_nodes(R"(,"scene":1,"scenes":[{"nodes":[4]},{"name":"kept","nodes":[3]}],"nodes":[{"name":"leaf","translation":[0,0,1]},)"
                   R"({"name":"left","children":[0]},{"name":"right","mesh":0},{"name":"root","children":[1,2],"translation":[1,0,0]},)"
                   R"({"name":"elsewhere"}])");
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    ASSERT_EQ(scene->nodes.size(), 4u);
    EXPECT_EQ(scene->name, "kept");
    const char* const names[] = {"root", "left", "leaf", "right"};
    const int parents[] = {-1, 0, 1, 0};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(scene->nodes[i].name, names[i]);
        EXPECT_EQ(scene->nodes[i].parent, parents[i]);
    }
    EXPECT_EQ(scene->nodes[2].world[3], glm::vec4(1, 0, 1, 1));
}

TEST(scene, without_scenes_all_roots_are_kept)
{
    const Result<Scene> scene = load_nodes(R"(,"nodes":[{"children":[2]},{"mesh":0},{}])");
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->nodes.size(), 3u);
}

TEST(scene, a_scene_without_nodes_is_legal)
{
    const Result<Scene> scene = load_text(R"({"asset":{"version":"2.0"},"scenes":[{}]})");
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_TRUE(scene->nodes.empty());
}

TEST(scene, negative_scale_is_left_in_the_node)
{
    const Result<Scene> scene = load_nodes(R"(,"nodes":[{"mesh":0,"scale":[-1,1,1]}])");
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_LT(glm::determinant(glm::mat3(scene->nodes[0].world)), 0.0f);
    EXPECT_EQ(scene->vertices.px[scene->indices[1]], 1.0f); // the mesh is unchanged
}

TEST(scene, cameras_are_read)
{
    const Result<Scene> scene =
        load_nodes(R"(,"nodes":[{"camera":1}])", R"(,"cameras":[{"type":"perspective","name":"p","perspective":{"yfov":0.7,"znear":0.25}},)"
                                                 R"({"type":"orthographic","orthographic":{"xmag":2,"ymag":3,"znear":0,"zfar":10}}])");
    ASSERT_TRUE(scene) << error_of(scene);
    ASSERT_EQ(scene->cameras.size(), 2u);
    EXPECT_EQ(scene->cameras[0].name, "p");
    EXPECT_FALSE(scene->cameras[0].orthographic);
    EXPECT_EQ(scene->cameras[0].yfov, 0.7f);
    EXPECT_EQ(scene->cameras[0].znear, 0.25f);
    EXPECT_EQ(scene->cameras[0].zfar, 0.0f); // infinite
    EXPECT_TRUE(scene->cameras[1].orthographic);
    EXPECT_EQ(scene->cameras[1].ymag, 3.0f);
    EXPECT_EQ(scene->nodes[0].camera, 1);
}

TEST(scene, punctual_lights_are_read)
{
    const Result<Scene> scene = load_nodes(R"(,"nodes":[{"extensions":{"KHR_lights_punctual":{"light":1}}}])", kLights);
    ASSERT_TRUE(scene) << error_of(scene);
    ASSERT_EQ(scene->lights.size(), 3u);
    EXPECT_EQ(scene->lights[0].type, LightType::point);
    EXPECT_EQ(scene->lights[0].name, "bulb");
    EXPECT_EQ(scene->lights[0].color, glm::vec3(1, 0.5f, 0.25f));
    EXPECT_EQ(scene->lights[0].intensity, 40.0f);
    EXPECT_EQ(scene->lights[0].range, 7.0f);
    EXPECT_EQ(scene->lights[1].type, LightType::spot);
    EXPECT_EQ(scene->lights[1].inner_cone, 0.1f);
    EXPECT_EQ(scene->lights[1].outer_cone, 0.5f);
    EXPECT_EQ(scene->lights[2].type, LightType::directional);
    EXPECT_EQ(scene->lights[2].range, 0.0f);
    EXPECT_EQ(scene->nodes[0].light, 1);
}

TEST(scene, node_cycles_second_parents_and_deep_chains_are_errors)
{
    EXPECT_NE(error_of(load_nodes(R"(,"nodes":[{"children":[1]},{"children":[0]}])")).find("cycle"), std::string::npos);
    EXPECT_NE(error_of(load_nodes(R"(,"nodes":[{"children":[0]}])")).find("cycle"), std::string::npos);
    EXPECT_EQ(error_of(load_nodes(R"(,"nodes":[{"children":[2]},{"children":[2]},{}])")),
              "/nodes/1/children/0: node 2 has two parents, 0 and 1");
    EXPECT_EQ(error_of(load_nodes(R"(,"scenes":[{"nodes":[0,1]}],"nodes":[{"children":[1]},{}])")),
              "/scenes/0/nodes/1: node 1 is in the scene twice");
    std::string chain = R"(,"nodes":[)";
    for (int i = 0; i < 300; ++i)
        chain += R"({"children":[)" + std::to_string(i + 1) + "]},";
    const Result<Scene> deep = load_nodes(chain + "{}]");
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().place, "/nodes/256"); // the 257th of the chain
}

TEST(scene, transforms_that_overflow_are_errors)
{
    const Result<Scene> scene = load_nodes(R"(,"nodes":[{"scale":[1e30,1,1],"children":[1]},{"scale":[1e30,1,1]}])");
    EXPECT_EQ(error_of(scene), "/nodes/1: the transform to world space overflows");
    EXPECT_EQ(error_of(load_nodes(R"(,"nodes":[{"rotation":[0,0,0,0]}])")), "/nodes/0/rotation: is not a unit quaternion");
}

TEST(scene, external_files_are_read_below_the_folder)
{
    const TempFolder folder;
    const Asset asset = triangle();
    folder.write("data/a b.bin", asset.bin);
    const std::string scene_path = folder.write("scene.gltf", asset.json(R"(,"uri":"data/a%20b.bin")"));
    const Result<Scene> scene = load_gltf(scene_path, {});
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->indices.size(), 3u);
    const Result<Scene> through_load_scene = load_scene(scene_path, {});
    EXPECT_TRUE(through_load_scene);
}

TEST(scene, uris_that_leave_the_folder_are_refused_unless_allowed)
{
    const TempFolder folder;
    const Asset asset = triangle();
    folder.write("outside.bin", asset.bin);
    const auto load_with = [&](const std::string& uri, bool allowed) {
        Limits limits;
        limits.uris_outside = allowed;
        return load_gltf(folder.write("sub/scene.gltf", asset.json(",\"uri\":\"" + uri + "\"")), limits);
    };
    for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"), std::string("a/../../outside.bin"),
                                   std::string("..\\\\outside.bin"), folder.path("outside.bin")}) {
        const Result<Scene> refused = load_with(uri, false);
        ASSERT_FALSE(refused) << uri;
        EXPECT_EQ(refused.error().place, "/buffers/0/uri");
        EXPECT_NE(refused.error().reason.find("Limits::uris_outside"), std::string::npos) << refused.error().reason;
    }
    EXPECT_TRUE(load_with("../outside.bin", true));
    EXPECT_TRUE(load_with(folder.path("outside.bin"), true));
    for (const char* uri : {"http://example.org/a.bin", "file:///outside.bin", "FTP:a", "C:/a.bin"}) {
        const Result<Scene> scheme = load_with(uri, true);
        ASSERT_FALSE(scheme) << uri;
        EXPECT_NE(scheme.error().reason.find("URI scheme"), std::string::npos) << scheme.error().reason;
    }
    for (const char* uri : {"", "%", "%4", "%zz", "a%00b", "missing.bin", "."})
        EXPECT_FALSE(load_with(uri, false)) << uri;
}

TEST(scene, unknown_required_extensions_are_an_error_that_lists_all_of_them)
{
    Asset asset = triangle();
    asset.more = R"(,"extensionsRequired":["KHR_materials_ior","ACME_one","KHR_materials_diffuse_transmission","ACME_one"])";
    EXPECT_EQ(error_of(load(asset)), "/extensionsRequired: the file requires extensions that are not "
                                     "supported: ACME_one, KHR_materials_diffuse_transmission");
}

TEST(scene, unknown_used_extensions_warn_once_each)
{
    Asset asset = triangle();
    asset.more = R"(,"extensionsUsed":["ACME_one","KHR_materials_diffuse_transmission","ACME_one","KHR_materials_ior"])";
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->warnings, (std::vector<std::string>{"extension ACME_one is not supported and ignored",
                                                         "extension KHR_materials_diffuse_transmission is not supported and ignored",
                                                         "/extensionsUsed/2: stands here twice"}));
}

TEST(scene, ignored_extensions_are_counted_and_with_strict_refused)
{
    Asset asset = triangle();
    asset.more = R"(,"extensionsUsed":["KHR_materials_ior","KHR_materials_diffuse_transmission","ACME_one"])";
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(ignored_extensions(scene->warnings), (std::vector<std::string>{"KHR_materials_diffuse_transmission", "ACME_one"}));
    Limits strict;
    strict.strict = true;
    EXPECT_EQ(error_of(load(asset, strict)),
              "/extensionsUsed: extension KHR_materials_diffuse_transmission is not supported (Limits::strict)");
    EXPECT_FALSE(is_read("animations")); // no extension
    EXPECT_TRUE(is_read("KHR_draco_mesh_compression"));
}

TEST(scene, builtin_names_go_to_the_generated_scenes)
{
    EXPECT_FALSE(load_scene("builtin:no-such-scene", {}));
    EXPECT_TRUE(load_scene("builtin:spheres", {}));
}
