// Stages specialised by their constants: valid SPIR-V that keeps the needed code and no more.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "raster/frame/frame.h"
#include "raster/vulkan/frame_numbers.h"
#include "raster/vulkan/prune.h"
#include "raster/vulkan/shaders.h"
#include "shading/lang/tables.h"
#include "tests/unit/vulkan/pruned.h"

namespace burnish::test {
namespace {

Words stage(const char* name)
{
    return *shader_words(name, "");
}

// Searches like a debugger: "NAME(" begins glslc's name for a function.
bool has_function(const Words& words, std::string name)
{
    name += '(';
    return std::string_view(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0])).find(name) !=
           std::string_view::npos;
}

std::int32_t bit_of_technique(std::string_view name)
{
    for (std::size_t at = 0; at < techniques().size(); ++at)
        if (techniques()[at].name == name)
            return 1 << at;
    return 0;
}

TEST(prune, leaves_the_techniques_and_lobes_that_are_used)
{
    const Words all = stage("shade");
    for (const char* kept : {"major_axis", "as_mc"}) {
        const Words some = pruned(all, {bit_of_technique(kept), 1, 0, 0});
        EXPECT_LT(some.size(), all.size() * 2 / 3) << kept;
        for (const char* technique : {"major_axis", "as_mc", "filtered_is", "bent_normal"}) {
            const std::string entry = std::string(technique) + "_specular";
            EXPECT_TRUE(has_function(all, entry));
            EXPECT_EQ(has_function(some, entry), std::string_view(kept) == technique) << entry << " where " << kept << " is used";
        }
        EXPECT_FALSE(has_function(some, "ward_eval")) << "asked in a function of its own, lobe_used()";
        EXPECT_TRUE(has_function(all, "ward_eval"));
    }
}

TEST(prune, leaves_everything_where_all_may_be_met)
{
    const Words all = stage("shade"), same = pruned(all, {-1, -1, 1, 1});
    for (const char* name : {"major_axis_specular", "as_mc_specular", "ward_eval", "store_shared_sample"})
        EXPECT_TRUE(has_function(same, name)) << name;
}

constexpr const char* kSpecial[] = {"light_of_facets",      "apply_parallax", "fetch_texture",
                                    "light_of_area_lights", "undo_widening",  "area_light_by_samples"};

TEST(prune, leaves_out_what_neither_the_frame_nor_a_material_has)
{
    const Words all = stage("shade");
    const std::vector<std::int32_t> constants = {bit_of_technique("bent_normal"), -1, 0, 0};
    const Words some = pruned(all, constants, known_numbers({}, {plain_material(), plain_material()}));
    const Words unknown = pruned(all, constants);
    EXPECT_LT(3 * some.size(), 2 * unknown.size());
    for (const char* name : kSpecial) {
        EXPECT_TRUE(has_function(unknown, name)) << name;
        EXPECT_FALSE(has_function(some, name)) << name;
    }
    EXPECT_TRUE(has_function(some, "bent_normal_specular"));
}

TEST(prune, leaves_what_one_material_of_several_has)
{
    const Words all = stage("shade");
    const std::vector<std::int32_t> constants = {bit_of_technique("bent_normal"), -1, 0, 0};
    const auto kept = [&](MaterialRecord m, const char* name) {
        return has_function(pruned(all, constants, known_numbers({}, {plain_material(), m})), name);
    };
    MaterialRecord m = plain_material();
    EXPECT_FALSE(kept(m, "apply_parallax"));
    m.parallax = 1;
    EXPECT_TRUE(kept(m, "apply_parallax"));
    m = plain_material(), m.textured = 1;
    EXPECT_TRUE(kept(m, "fetch_texture"));
    m = plain_material(), m.moments = kMomentsOfAll;
    EXPECT_TRUE(kept(m, "undo_widening"));
    m = plain_material(), m.facets = 3;
    EXPECT_FALSE(kept(m, "light_of_facets")) << "without a normal map";
    m.textures[kNormalTex].texture = 0;
    EXPECT_TRUE(kept(m, "light_of_facets"));
}

// A roughness that changes from picture to picture must not compile stages anew.
TEST(prune, numbers_do_not_change_with_places_in_tables)
{
    const auto key_of = [](const MaterialRecord& m, const std::vector<FrameDesc>& others) {
        std::string key;
        for (const KnownNumber& n : known_numbers({}, {m}, {}, others))
            key += std::to_string(n.binding) + "." + std::to_string(n.offset) + "=" + std::to_string(n.value) + " ";
        return key;
    };
    MaterialRecord a = plain_material(), b = plain_material();
    a.albedo_slice = 0, b.albedo_slice = 4096;
    a.phong_set = 0, b.phong_set = 64;
    EXPECT_EQ(key_of(a, {}), key_of(b, {}));
    b.technique = a.technique + 1;
    EXPECT_NE(key_of(a, {}), key_of(b, {}));
    EXPECT_EQ(key_of(a, {FrameDesc()}), key_of(b, {FrameDesc()})) << "frames that share pipelines have other techniques";
}

TEST(prune, leaves_lights_where_there_are_some)
{
    FrameRecord frame = {};
    frame.area_light_count = 2;
    const Words some = pruned(stage("shade"), {bit_of_technique("bent_normal"), -1, 0, 0}, known_numbers(frame, {plain_material()}));
    EXPECT_TRUE(has_function(some, "light_of_area_lights"));
}

TEST(prune, gives_back_what_is_no_module)
{
    const Words all = stage("gather");
    Words cut(all.begin(), all.end() - 1), other = all, brief = all;
    other[0] = 0;
    constexpr std::uint32_t kBranchConditionalOfOneWord = 1u << 16 | 250u;
    brief.push_back(kBranchConditionalOfOneWord);
    for (const Words& words : {cut, other, brief, Words{}, Words(all.begin(), all.begin() + 5)})
        EXPECT_EQ(pruned(words, {}), words);
}

TEST(prune, makes_valid_modules)
{
    if (!validator_is_there())
        GTEST_SKIP() << "no spirv-val";
    const struct {
        const char* name;
        std::vector<std::int32_t> constants;
    } cases[] = {{"shade", {0x2a, 0x15, 0, 1}},
                 {"compose", {0x2a, 0x15, 0, 1, -1, 1}},
                 {"share", {0x20, 1, 1, 1}},
                 {"forward_native", {1, 1, 0, 0, 0x155}}};
    for (const auto& [name, constants] : cases)
        check_pruned(name, stage(name), constants);
}

} // namespace
} // namespace burnish::test
