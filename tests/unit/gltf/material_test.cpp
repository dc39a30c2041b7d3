// Materials, textures, images.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "asset.h"
#include "core/image/io/image_io.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;

namespace {

// Returns the bytes of a 2x1 PNG.
ByteVector small_png()
{
    const TempFolder folder;
    Image image = make_image(2, 1, 3, PixelType::u8);
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
        image.bytes[i] = static_cast<std::byte>(40 * i);
    const Status status = write_image(folder.path("a.png"), image);
    EXPECT_TRUE(status);
    return read_bytes(folder.path("a.png"));
}

std::string png_uri()
{
    return "data:image/png;base64," + base64(small_png());
}

Result<Scene> load_materials(const std::string& materials, const std::string& textures = "")
{
    Asset asset = triangle();
    asset.more = ",\"materials\":[" + materials + "]" + textures;
    return load(asset);
}

std::string one_image_textures();

TEST(material, warnings_name_the_material)
{
    const std::string third = R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":2}})";
    const Result<Scene> scene = load_materials(R"({"name":"brass",)" + third + "},{" + third + "}", one_image_textures());
    ASSERT_TRUE(scene);
    for (const std::string line : {"material \"brass\": texture coordinates TEXCOORD_2 are not supported, TEXCOORD_0 is used",
                                   "material 1: texture coordinates TEXCOORD_2 are not supported, TEXCOORD_0 is used"})
        EXPECT_EQ(std::count(scene->warnings.begin(), scene->warnings.end(), line), 1) << line;
}

std::string one_image_textures()
{
    return R"(,"textures":[{"source":0},{"source":0,"sampler":0}],"images":[{"uri":")" + png_uri() +
           R"("}],"samplers":[{"magFilter":9728,"minFilter":9984,"wrapS":33071,"wrapT":33648}])";
}

Result<Scene> load_transform(const std::string& transform)
{
    return load_materials(R"({"emissiveTexture":{"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":)" + transform + "}}}",
                          one_image_textures());
}

} // namespace

TEST(material, defaults_are_those_of_gltf)
{
    const Result<Scene> scene = load_materials("{}");
    ASSERT_TRUE(scene) << error_of(scene);
    const Material& m = scene->materials[0];
    EXPECT_EQ(m.base_color, glm::vec4(1.0f));
    EXPECT_EQ(m.metallic, 1.0f);
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.emissive, glm::vec3(0.0f));
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.specular, 1.0f);
    EXPECT_EQ(m.transmission, 0.0f);
    EXPECT_EQ(m.clearcoat, 0.0f);
    EXPECT_EQ(m.clearcoat_roughness, 0.0f);
    EXPECT_EQ(m.sheen_color, glm::vec3(0.0f));
    EXPECT_EQ(m.sheen_roughness, 0.0f);
    EXPECT_EQ(m.dispersion, 0.0f);
    EXPECT_EQ(m.iridescence, 0.0f);
    EXPECT_EQ(m.iridescence_ior, 1.3f);
    EXPECT_EQ(m.iridescence_thickness_least, 100.0f);
    EXPECT_EQ(m.iridescence_thickness, 400.0f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(m.alpha_cutoff, 0.5f);
    EXPECT_EQ(m.anisotropy_strength, 0.0f);
    EXPECT_EQ(m.normal_scale, 1.0f);
    EXPECT_EQ(m.occlusion_strength, 1.0f);
    EXPECT_FALSE(m.double_sided || m.unlit || m.base_color_tex.used() || m.normal_tex.used());
}

TEST(material, every_factor_and_extension_arrives)
{
    const Result<Scene> scene = load_materials(
        R"({"name":"all","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0,"roughnessFactor":0.25},)"
        R"("emissiveFactor":[1,0.5,0],"alphaMode":"MASK","alphaCutoff":0.75,"doubleSided":true,"extensions":{)"
        R"("KHR_materials_unlit":{},"KHR_materials_emissive_strength":{"emissiveStrength":10},"KHR_materials_ior":{"ior":1.33},)"
        R"("KHR_materials_transmission":{"transmissionFactor":0.75},"KHR_materials_dispersion":{"dispersion":0.25},)"
        R"("KHR_materials_clearcoat":{"clearcoatFactor":0.7,"clearcoatRoughnessFactor":0.2},)"
        R"("KHR_materials_sheen":{"sheenColorFactor":[0.1,0.2,0.3],"sheenRoughnessFactor":0.6},)"
        R"("KHR_materials_iridescence":{"iridescenceFactor":0.8,"iridescenceIor":1.6,"iridescenceThicknessMinimum":50,)"
        R"("iridescenceThicknessMaximum":700},)"
        R"("KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[2,1,0]},)"
        R"("KHR_materials_anisotropy":{"anisotropyStrength":0.6,"anisotropyRotation":1.5}}})");
    ASSERT_TRUE(scene) << error_of(scene);
    const Material& m = scene->materials[0];
    EXPECT_EQ(m.name, "all");
    EXPECT_EQ(m.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(m.metallic, 0.0f);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.emissive, glm::vec3(1.0f, 0.5f, 0.0f));
    EXPECT_EQ(m.emissive_strength, 10.0f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.alpha_cutoff, 0.75f);
    EXPECT_TRUE(m.double_sided);
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(m.ior, 1.33f);
    EXPECT_EQ(m.transmission, 0.75f);
    EXPECT_EQ(m.clearcoat, 0.7f);
    EXPECT_EQ(m.clearcoat_roughness, 0.2f);
    EXPECT_EQ(m.sheen_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.sheen_roughness, 0.6f);
    EXPECT_EQ(m.dispersion, 0.25f);
    EXPECT_EQ(m.iridescence, 0.8f);
    EXPECT_EQ(m.iridescence_ior, 1.6f);
    EXPECT_EQ(m.iridescence_thickness_least, 50.0f);
    EXPECT_EQ(m.iridescence_thickness, 700.0f);
    EXPECT_EQ(m.specular, 0.5f);
    EXPECT_EQ(m.specular_color, glm::vec3(2, 1, 0));
    EXPECT_EQ(m.anisotropy_strength, 0.6f);
    EXPECT_EQ(m.anisotropy_rotation, 1.5f);
}

TEST(material, factors_out_of_range_are_errors_at_their_place)
{
    const std::pair<const char*, const char*> cases[] = {
        {R"({"pbrMetallicRoughness":{"roughnessFactor":1.01}})", "/materials/0/pbrMetallicRoughness/roughnessFactor"},
        {R"({"pbrMetallicRoughness":{"metallicFactor":-0.1}})", "/materials/0/pbrMetallicRoughness/metallicFactor"},
        {R"({"pbrMetallicRoughness":{"baseColorFactor":[0,0,2,1]}})", "/materials/0/pbrMetallicRoughness/baseColorFactor/2"},
        {R"({"pbrMetallicRoughness":{"baseColorFactor":[0,0,0]}})", "/materials/0/pbrMetallicRoughness/baseColorFactor"},
        {R"({"emissiveFactor":[0,0,"x"]})", "/materials/0/emissiveFactor/2"},
        {R"({"alphaMode":"GLASS"})", "/materials/0/alphaMode"},
        {R"({"alphaCutoff":-1})", "/materials/0/alphaCutoff"},
        {R"({"extensions":{"KHR_materials_ior":{"ior":0.5}}})", "/materials/0/extensions/KHR_materials_ior/ior"},
        {R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":2}}})",
         "/materials/0/extensions/KHR_materials_transmission/transmissionFactor"},
        {R"({"extensions":{"KHR_materials_specular":{"specularFactor":2}}})",
         "/materials/0/extensions/KHR_materials_specular/specularFactor"},
        {R"({"extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":1.5}}})",
         "/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength"},
        {R"({"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":1e39}}})",
         "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength"},
        {R"({"normalTexture":{"index":0}})", "/materials/0/normalTexture/index"},
        {R"({"normalTexture":{}})", "/materials/0/normalTexture"},
    };
    for (const auto& [material, place] : cases) {
        const Result<Scene> scene = load_materials(material);
        ASSERT_FALSE(scene) << material;
        EXPECT_EQ(scene.error().place, place);
        EXPECT_FALSE(scene.error().reason.empty());
    }
}

TEST(material, whole_numbers_serve_as_factors_and_as_indices_written_with_a_point)
{
    const Result<Scene> scene =
        load_materials(R"({"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":5000000000}},"emissiveFactor":[1,0,0],)"
                       R"("normalTexture":{"index":1.0}})",
                       one_image_textures());
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->materials[0].emissive_strength, 5e9f);
    EXPECT_TRUE(scene->materials[0].normal_tex.used());
}

TEST(material, an_image_is_decoded_once_however_many_textures_use_it)
{
    const Result<Scene> scene = load_materials(
        R"({"normalTexture":{"index":0,"scale":0.5},"occlusionTexture":{"index":1,"strength":0.25},"emissiveTexture":{"index":1}})",
        one_image_textures());
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    ASSERT_EQ(scene->images.size(), 1u);
    EXPECT_EQ(scene->images[0].width, 2);
    EXPECT_EQ(static_cast<int>(scene->images[0].bytes[1]), 40);
    ASSERT_EQ(scene->textures.size(), 2u);
    const Material& m = scene->materials[0];
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_EQ(m.occlusion_strength, 0.25f);
    EXPECT_EQ(m.emissive_tex.texture, m.occlusion_tex.texture);
    const Texture& plain = scene->textures[static_cast<std::size_t>(m.normal_tex.texture)];
    const Texture& sampled = scene->textures[static_cast<std::size_t>(m.occlusion_tex.texture)];
    EXPECT_EQ(plain.wrap_s, WrapMode::repeat);
    EXPECT_FALSE(plain.nearest);
    EXPECT_EQ(sampled.wrap_s, WrapMode::clamp);
    EXPECT_EQ(sampled.wrap_t, WrapMode::mirror);
    EXPECT_TRUE(sampled.nearest);
}

TEST(material, images_come_from_files_and_buffer_views_too)
{
    const TempFolder folder;
    folder.write("pics/a.png", small_png());
    Asset asset = triangle();
    const int view = asset.view(small_png());
    folder.write("a.bin", asset.bin);
    asset.more = R"(,"materials":[{"normalTexture":{"index":0},"emissiveTexture":{"index":1}}],"textures":[{"source":0},)"
                 R"({"source":1}],"images":[{"uri":"pics/a.png"},{"mimeType":"image/png","bufferView":)" +
                 std::to_string(view) + "}]";
    const Result<Scene> scene = load_scene(folder.write("a.gltf", asset.json(R"(,"uri":"a.bin")")), {});
    ASSERT_TRUE(scene) << error_of(scene);
    ASSERT_EQ(scene->images.size(), 2u);
    EXPECT_EQ(scene->images[0].bytes, scene->images[1].bytes);
}

TEST(material, textures_above_the_memory_limit_are_an_error)
{
    Asset asset = triangle();
    asset.more = R"(,"materials":[{"normalTexture":{"index":0},"emissiveTexture":{"index":1}}],"textures":[{"source":0},)"
                 R"({"source":1}],"images":[{"uri":")" +
                 png_uri() + R"("},{"uri":")" + png_uri() + R"("}])";
    Limits limits;
    limits.texture_bytes = 12; // both images of 6 bytes
    EXPECT_TRUE(load(asset, limits));
    limits.texture_bytes = 11;
    const Result<Scene> scene = load(asset, limits);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().place, "/images/1");
}

// Threads decode images; the scene, its warnings, its files and its first error equal one thread's.
TEST(material, images_are_the_same_by_any_number_of_threads)
{
    const TempFolder folder;
    std::string textures, images, materials;
    for (int i = 0; i < 12; ++i) {
        Image image = make_image(3 + 5 * i % 17, 2 + 7 * i % 11, 3, PixelType::u8);
        for (std::size_t k = 0; k < image.bytes.size(); ++k)
            image.bytes[k] = static_cast<std::byte>(k * k + static_cast<std::size_t>(i));
        const std::string name = std::to_string(i) + ".png", comma = i ? "," : "";
        ASSERT_TRUE(write_image(folder.path(name), image));
        textures += comma + "{\"source\":" + std::to_string(11 - i) + "}";
        images += comma + "{\"uri\":\"" + name + "\",\"mimeType\":\"image/" + (i == 4 ? "jpeg" : "png") + "\"}";
        materials += comma + "{\"emissiveTexture\":{\"index\":" + std::to_string(7 * i % 12) + "}}";
    }
    Asset asset = triangle();
    asset.more = ",\"materials\":[" + materials + "],\"textures\":[" + textures + "],\"images\":[" + images + "]";
    folder.write("a.bin", asset.bin);
    const std::string path = folder.write("a.gltf", asset.json(R"(,"uri":"a.bin")"));
    const Jobs four(4);
    Limits limits;
    const auto alike = [&](const std::string& what) {
        const Result<Scene> one = load_scene(path, limits), many = load_scene(path, limits, {}, &four);
        EXPECT_EQ(error_of(one), error_of(many)) << what;
        if (!one || !many)
            return;
        EXPECT_EQ(one->warnings, many->warnings) << what;
        EXPECT_EQ(one->files, many->files) << what;
        ASSERT_EQ(one->images.size(), many->images.size());
        for (std::size_t i = 0; i < one->images.size(); ++i)
            EXPECT_EQ(one->images[i].bytes, many->images[i].bytes) << what << i;
    };
    alike("all");
    const Result<Scene> whole = load_scene(path, limits);
    ASSERT_TRUE(whole) << error_of(whole);
    EXPECT_FALSE(whole->warnings.empty()) << "image 4 lies about its type";
    std::uint64_t bytes = 0;
    for (const Image& image : whole->images)
        bytes += image.bytes.size();
    for (const std::uint64_t limit : {bytes, bytes - 1, bytes / 2, std::uint64_t{1}}) {
        limits.texture_bytes = limit;
        EXPECT_EQ(static_cast<bool>(load_scene(path, limits, {}, &four)), limit == bytes);
        alike("a limit of " + std::to_string(limit));
    }
    limits.texture_bytes = bytes;
    folder.write("3.png", std::string("no picture"));
    ByteVector cut = read_bytes(folder.path("8.png"));
    cut.resize(cut.size() / 2);
    folder.write("8.png", cut);
    EXPECT_FALSE(load_scene(path, limits, {}, &four));
    alike("two images with faults");
}

TEST(material, bytes_that_are_no_image_are_an_error_even_where_nothing_uses_them)
{
    EXPECT_EQ(error_of(load_materials("{}", R"(,"images":[{"uri":"data:image/png;base64,AAAA"}])")),
              "/images/0: is no PNG, JPEG or WebP image");
    EXPECT_EQ(error_of(load_materials("{}", R"(,"images":[{}])")), "/images/0: has neither a uri nor a bufferView");
}

TEST(texture_transform, is_offset_after_rotation_after_scale)
{
    const Result<Scene> scene = load_transform(R"({"offset":[0.5,0.25],"rotation":1.5707963267948966,"scale":[2,3],"texCoord":0})");
    ASSERT_TRUE(scene) << error_of(scene);
    const TextureRef& ref = scene->materials[0].emissive_tex;
    EXPECT_EQ(ref.uv_set, 0); // the extension's set overrides
    // (1, 1) is scaled to (2, 3), turned counter-clockwise to (3, -2) in an image whose v points down, then moved.
    const glm::vec2 uv = ref.uv_transform * glm::vec3(1, 1, 1);
    EXPECT_NEAR(uv.x, 3.5f, 1e-6f);
    EXPECT_NEAR(uv.y, -1.75f, 1e-6f);
}

TEST(texture_transform, agrees_with_the_sines_and_cosines_of_any_angle)
{
    for (const double angle : {0.0, 0.3, -2.0, 3.1, 100.0, -12345.678}) {
        const Result<Scene> scene = load_transform("{\"rotation\":" + std::to_string(angle) + "}");
        ASSERT_TRUE(scene) << error_of(scene);
        const TextureRef& ref = scene->materials[0].emissive_tex;
        EXPECT_EQ(ref.uv_set, 1);
        EXPECT_NEAR(ref.uv_transform[0][0], std::cos(angle), 1e-6);
        EXPECT_NEAR(ref.uv_transform[0][1], -std::sin(angle), 1e-6);
        EXPECT_NEAR(ref.uv_transform[1][0], std::sin(angle), 1e-6);
        EXPECT_NEAR(ref.uv_transform[1][1], std::cos(angle), 1e-6);
    }
}

TEST(texture_transform, puts_the_arrow_of_the_test_model_on_its_marker)
{
    const Result<Scene> scene = load_scene(data_file("models/TextureTransformTest/TextureTransformTest.gltf"), {});
    ASSERT_TRUE(scene) << scene.error().line();
    // The arrow in the image points from its corner to (1, 1). The model's markers, children of the quads, show its expected place. Quads
    // have their centre at the origin and a side of 1; v points down.
    const auto direction = [&](const char* marker, const char* material) {
        glm::vec2 uv(0.0f);
        for (const Node& node : scene->nodes)
            if (node.name == marker)
                uv = {node.local[3].x + 0.5f, 0.5f - node.local[3].y};
        for (const Material& m : scene->materials)
            if (m.name == material)
                return glm::normalize(m.base_color_tex.uv_transform * glm::vec3(uv, 1.0f));
        return glm::vec2(0.0f);
    };
    EXPECT_NEAR(direction("Rotation - Correct", "Rotation").x, std::sqrt(0.5f), 1e-4f);
    EXPECT_LT(direction("Rotation - Error", "Rotation").y, 0.5f);
    EXPECT_NEAR(direction("Scale - Correct", "Scale").x, std::sqrt(0.5f), 1e-4f);
    EXPECT_NEAR(direction("All - Correct", "All").x, std::sqrt(0.5f),
                0.03f); // the model's marker is placed by hand
}
