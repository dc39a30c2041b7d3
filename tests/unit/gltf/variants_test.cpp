// Variants of materials (KHR_materials_variants).
#include <gtest/gtest.h>

#include "asset.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;

namespace {

const std::string kMaterials = R"(,"materials":[{"name":"red"},{"name":"green"},{"name":"blue"}])";

// Returns a triangle of the first material. mappings: JSON; names: of the file's variants.
Asset varied(const std::string& mappings, const std::string& names = R"({"name":"spring"},{"name":"summer"},{"name":"autumn"})")
{
    Asset asset = triangle();
    asset.primitive = R"(,"material":0,"extensions":{"KHR_materials_variants":{"mappings":[)" + mappings + "]}}";
    asset.more =
        kMaterials + R"(,"extensionsUsed":["KHR_materials_variants"],"extensions":{"KHR_materials_variants":{"variants":[)" + names + "]}}";
    return asset;
}

const std::string kMappings = R"({"material":1,"variants":[0,2]},{"material":2,"variants":[1]})";

Result<Scene> load_variant(const Asset& asset, const std::string& name, bool strict = false)
{
    Limits limits;
    limits.strict = strict;
    const std::string text = asset.gltf();
    Moment moment;
    moment.variant = name;
    return load_gltf_bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), "test", limits, moment);
}

std::string material_of(const Asset& asset, const std::string& variant)
{
    const Result<Scene> scene = load_variant(asset, variant);
    return scene ? scene->materials[static_cast<std::size_t>(scene->primitives[0].material)].name : error_of(scene);
}

TEST(variants, choose_the_materials_that_meshes_list)
{
    const Asset asset = varied(kMappings);
    EXPECT_EQ(material_of(asset, ""), "red");
    EXPECT_EQ(material_of(asset, "spring"), "green");
    EXPECT_EQ(material_of(asset, "summer"), "blue");
    EXPECT_EQ(material_of(asset, "autumn"), "green");
    const Result<Scene> scene = load_variant(asset, "");
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->variants, (std::vector<std::string>{"spring", "summer", "autumn"}));
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0];
}

TEST(variants, meshes_keep_their_own_materials_where_they_list_none)
{
    EXPECT_EQ(material_of(varied(R"({"material":1,"variants":[0]})"), "summer"), "red");
    Asset asset = varied(kMappings);
    asset.primitive = R"(,"material":2)";
    EXPECT_EQ(material_of(asset, "spring"), "blue");
}

TEST(variants, names_that_the_file_lacks_are_errors_with_its_names)
{
    const std::string unknown = material_of(varied(kMappings), "winter");
    EXPECT_NE(unknown.find("'winter'"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find("spring, summer, autumn"), std::string::npos) << unknown;
    EXPECT_NE(material_of(triangle(), "spring").find("no variants"), std::string::npos);
    Moment moment;
    moment.variant = "spring";
    const Result<Scene> builtin = load_scene("builtin:teapot", {}, moment);
    ASSERT_FALSE(builtin);
    EXPECT_NE(builtin.error().reason.find("Moment::variant"), std::string::npos);
}

TEST(variants, that_are_wrong_are_refused_with_their_place)
{
    const std::string mapping = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0";
    for (const auto& [mappings, place] : {std::pair<std::string, std::string>{R"({"material":3,"variants":[0]})", mapping + "/material"},
                                          {R"({"material":-1,"variants":[0]})", mapping + "/material"},
                                          {R"({"material":1,"variants":[3]})", mapping + "/variants/0"},
                                          {R"({"material":1,"variants":0})", mapping + "/variants"},
                                          {R"({"material":1})", mapping},
                                          {R"({"variants":[0]})", mapping}})
        for (const char* name : {"", "spring"}) {
            const Result<Scene> scene = load_variant(varied(mappings), name);
            ASSERT_FALSE(scene) << mappings;
            EXPECT_EQ(scene.error().place.rfind(place, 0), 0u) << scene.error().line();
        }
    EXPECT_FALSE(load_variant(varied(kMappings, R"({"name":1})"), ""));
    EXPECT_FALSE(load_variant(varied(kMappings, "{}"), ""));
}

TEST(variants, of_one_name_count_once)
{
    const Asset twice = varied(R"({"material":1,"variants":[0]},{"material":2,"variants":[0]})");
    EXPECT_EQ(material_of(twice, "spring"), "green");
    EXPECT_FALSE(load_variant(twice, "spring", true));
    const Result<Scene> warned = load_variant(twice, "spring");
    ASSERT_TRUE(warned);
    ASSERT_FALSE(warned->warnings.empty());
    EXPECT_NE(warned->warnings[0].find("twice"), std::string::npos);
    EXPECT_EQ(material_of(varied(kMappings, R"({"name":"a"},{"name":"a"},{"name":"b"})"), "a"), "green");
}

} // namespace
