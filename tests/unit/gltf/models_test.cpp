// Real models.
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "asset.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;
namespace fs = std::filesystem;

namespace {

struct Model {
    const char* file;
    std::size_t triangles, meshes, nodes, materials, images;
};

// Counts by another glTF reader.
const Model kModels[] = {
    {"AnisotropyBarnLampSmall.glb", 10203, 3, 3, 3, 4},
    {"AnisotropyStrengthTest.glb", 97240, 50, 51, 50, 1},
    {"AnisotropyStrengthTest_meshopt.glb", 97240, 50, 51, 50, 1},
    {"ClearCoatTest.glb", 37116, 27, 33, 19, 6},
    {"FlightHelmetParts/FlightHelmetParts.gltf", 8872, 2, 2, 2, 6},
    {"Lights.glb", 12, 1, 11, 1, 0},
    {"SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12, 1, 1, 1, 0},
    {"TextureTransformTest/TextureTransformTest.gltf", 18, 9, 12, 9, 5},
    {"ibl_six_colours.glb", 6912, 3, 3, 3, 0},
    {"meshopt-no-fallback/meshopt-no-fallback.gltf", 60, 2, 4, 2, 0},
    {"pmndrs_suzi_draco.glb", 14842, 1, 1, 1, 0},
};
// Optional models.
const Model kMoreModels[] = {
    {"AnisotropyBarnLamp.glb", 10203, 3, 3, 3, 4},
    {"FlightHelmet/FlightHelmet.gltf", 94722, 6, 6, 6, 15},
    {"NormalTangentTest.glb", 7774, 1, 2, 1, 3},
    {"chess-board.glb", 178848, 8, 10, 3, 8},
};

Result<Scene> load_model(const std::string& file)
{
    return load_gltf(data_file("models/" + file), {});
}

} // namespace

TEST(models, all_load_with_the_counts_of_their_files)
{
    std::vector<Model> models(std::begin(kModels), std::end(kModels));
    std::copy_if(std::begin(kMoreModels), std::end(kMoreModels), std::back_inserter(models),
                 [](const Model& model) { return has_data_file(std::string("models/") + model.file); });
    for (const Model& model : models) {
        SCOPED_TRACE(model.file);
        const Result<Scene> scene = load_model(model.file);
        ASSERT_TRUE(scene) << scene.error().line();
        expect_sound(*scene);
        EXPECT_EQ(scene->indices.size() / 3, model.triangles);
        EXPECT_EQ(scene->meshes.size(), model.meshes);
        EXPECT_EQ(scene->nodes.size(), model.nodes);
        EXPECT_EQ(scene->materials.size(), model.materials);
        EXPECT_EQ(scene->images.size(), model.images);
    }
}

TEST(models, the_compressed_twin_equals_the_plain_model_within_its_quantization)
{
    const Result<Scene> plain = load_model("AnisotropyStrengthTest.glb");
    const Result<Scene> packed = load_model("AnisotropyStrengthTest_meshopt.glb");
    ASSERT_TRUE(plain && packed);
    ASSERT_EQ(plain->nodes.size(), packed->nodes.size());
    const auto bounds = [](const Scene& scene) { // bounds of the drawn triangles, in world space
        std::array<glm::vec3, 2> box = {glm::vec3(1e30f), glm::vec3(-1e30f)};
        for (const Node& node : scene.nodes) {
            if (node.mesh < 0)
                continue;
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
            for (std::uint32_t p = 0; p < mesh.primitive_count; ++p) {
                const Primitive& primitive = scene.primitives[mesh.first_primitive + p];
                for (std::uint32_t k = 0; k < primitive.vertex_count; ++k) {
                    const std::uint32_t v = primitive.first_vertex + k;
                    const VertexTable& t = scene.vertices;
                    const glm::vec3 world(node.world * glm::vec4(t.px[v], t.py[v], t.pz[v], 1.0f));
                    box = {glm::min(box[0], world), glm::max(box[1], world)};
                }
            }
        }
        return box;
    };
    const auto a = bounds(*plain), b = bounds(*packed);
    for (int side = 0; side < 2; ++side)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(a[static_cast<std::size_t>(side)][c], b[static_cast<std::size_t>(side)][c], 1e-3f);
    for (std::size_t i = 0; i < plain->materials.size(); ++i)
        EXPECT_NEAR(plain->materials[i].anisotropy_strength, packed->materials[i].anisotropy_strength, 1e-6f);
}

TEST(models, the_sparse_accessor_moves_three_vertices)
{
    const Result<Scene> scene = load_model("SimpleSparseAccessor/SimpleSparseAccessor.gltf");
    ASSERT_TRUE(scene);
    const auto has = [&](float x, float y) {
        for (std::size_t i = 0; i < scene->vertices.size(); ++i)
            if (scene->vertices.px[i] == x && scene->vertices.py[i] == y)
                return true;
        return false;
    };
    EXPECT_TRUE(has(1, 2) && has(3, 3) && has(5, 4));  // the sparse values
    EXPECT_FALSE(has(1, 1) || has(3, 1) || has(5, 1)); // the replaced values
}

TEST(models, lights_and_camera_arrive)
{
    const Result<Scene> scene = load_model("Lights.glb");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->lights.size(), 4u);
    EXPECT_EQ(scene->lights[0].color, glm::vec3(1, 0, 0));
    EXPECT_EQ(scene->lights[1].type, LightType::spot);
    EXPECT_EQ(scene->lights[3].type, LightType::directional);
    ASSERT_EQ(scene->cameras.size(), 1u);
    int lights = 0, cameras = 0;
    for (const Node& node : scene->nodes) {
        lights += node.light != kNone;
        cameras += node.camera != kNone;
    }
    EXPECT_EQ(lights, 4);
    EXPECT_EQ(cameras, 1);
}

// MikkTSpace made the helmet's tangents. Tangents of this independent implementation must agree nearly everywhere.
TEST(models, tangents_made_here_agree_with_those_that_the_exporter_made)
{
    const TempFolder folder;
    const ByteVector bytes = read_bytes(data_file("models/FlightHelmetParts/FlightHelmetParts.gltf"));
    std::string text(bytes.begin(), bytes.end());
    for (std::size_t at = 0; (at = text.find("\"TANGENT\"", at)) != std::string::npos;)
        text.replace(at, 9, "\"_TANGENT\"");
    for (const auto& entry : fs::directory_iterator(data_file("models/FlightHelmetParts")))
        if (entry.path().extension() != ".gltf")
            fs::copy_file(entry.path(), folder.path(entry.path().filename().string())); // symbolic links would lead out of the folder
    const Result<Scene> ours = load_gltf(folder.write("helmet.gltf", text), {});
    const Result<Scene> theirs = load_model("FlightHelmetParts/FlightHelmetParts.gltf");
    ASSERT_TRUE(ours && theirs);
    ASSERT_EQ(ours->indices.size(), theirs->indices.size());
    EXPECT_FALSE(ours->warnings.empty());
    std::size_t close = 0, same_side = 0;
    for (std::size_t i = 0; i < ours->indices.size(); ++i) {
        const std::uint32_t a = ours->indices[i], b = theirs->indices[i];
        const VertexTable &va = ours->vertices, &vb = theirs->vertices;
        close += va.tx[a] * vb.tx[b] + va.ty[a] * vb.ty[b] + va.tz[a] * vb.tz[b] > 0.95f;
        same_side += va.tw[a] == vb.tw[b];
    }
    EXPECT_GT(static_cast<double>(close), 0.98 * static_cast<double>(ours->indices.size()));
    EXPECT_GT(static_cast<double>(same_side), 0.999 * static_cast<double>(ours->indices.size()));
}
