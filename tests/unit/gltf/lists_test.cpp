// Fields in core/scene's lists (material.def, light.def, area_light.def) are read from their paths and checked by their ranges.
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "asset.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;
using nlohmann::json;

namespace {

constexpr double kAny = 3.4028234663852886e38;

Asset with(const json& material, const json& light)
{
    Asset asset = triangle();
    asset.more = R"(,"textures":[{}],"materials":[)" + material.dump() + R"(],"extensions":{"KHR_lights_punctual":{"lights":[)" +
                 light.dump() + "]}}";
    return asset;
}

const json kPlain = {{"type", "spot"}, {"spot", json::object()}};

// Sets a value at a path. A texture on the way gets an index.
json with_value(json object, const std::string& path, const json& value)
{
    object[json::json_pointer(path)] = value;
    const std::string parent = path.substr(0, path.rfind('/'));
    if (parent.ends_with("Texture"))
        object[json::json_pointer(parent + "/index")] = 0;
    if (parent.ends_with("/conductor")) // each needs the other
        object[json::json_pointer(parent + (path.ends_with("eta") ? "/k" : "/eta"))] = {1, 1, 1};
    return object;
}

template <class T> json filled(double value)
{
    return sizeof(T) == sizeof(float) ? json(value) : json(std::vector<double>(sizeof(T) / sizeof(float), value));
}

// make: builds an asset from a value and its path ("" for none); member: reads the field from a Scene.
template <class T, class Make, class Member>
void expect_read_and_checked(const std::string& where, const char* path, T fallback, double least, double most, const Make& make,
                             const Member& member)
{
    const Result<Scene> without = load(make(json::object(), ""));
    ASSERT_TRUE(without) << path << ": " << error_of(without);
    EXPECT_EQ(member(*without), fallback) << path;
    const double value = most >= kAny || least >= 1.0 ? 1.25 : 0.25;
    const Result<Scene> with_it = load(make(filled<T>(value), path));
    ASSERT_TRUE(with_it) << path << ": " << error_of(with_it);
    EXPECT_EQ(member(*with_it), T(static_cast<float>(value))) << path;
    const std::string place = where + path + (sizeof(T) == sizeof(float) ? "" : "/0");
    for (const double wrong : {least - 1.0, most + 1.0}) {
        if (std::abs(wrong) >= kAny)
            continue;
        const Result<Scene> bad = load(make(filled<T>(wrong), path));
        ASSERT_FALSE(bad) << path << " of " << wrong;
        EXPECT_EQ(bad.error().place, place);
    }
}

} // namespace

TEST(lists, every_factor_of_materials_is_read_and_checked)
{
    const auto make = [](const json& value, const std::string& path) {
        return with(path.empty() ? json::object() : with_value(json::object(), path, value), kPlain);
    };
#define BN_FACTOR(kind, name, fallback, path, least, most)                                                                                 \
    expect_read_and_checked("/materials/0", path, FieldKinds::kind(fallback), least, most, make,                                           \
                            [](const Scene& s) { return s.materials[0].name; });
#include "core/scene/material.def"
}

TEST(lists, every_flag_of_materials_is_read)
{
    const auto load_with = [](const char* path, const json& value) { return load(with(with_value(json::object(), path, value), kPlain)); };
    const std::map<std::string, json> values = {{"boolean", true}, {"object", json::object()}};
#define BN_FLAG(kind, name, path)                                                                                                          \
    {                                                                                                                                      \
        const Result<Scene> set = load_with(path, values.at(#kind));                                                                       \
        ASSERT_TRUE(set) << error_of(set);                                                                                                 \
        EXPECT_TRUE(set->materials[0].name) << path;                                                                                       \
        EXPECT_FALSE(load_with(path, "yes")) << path;                                                                                      \
    }
#include "core/scene/material.def"
    const Result<Scene> plain = load(with(json::object(), kPlain));
    ASSERT_TRUE(plain);
#define BN_FLAG(kind, name, path) EXPECT_FALSE(plain->materials[0].name) << path;
#include "core/scene/material.def"
}

TEST(lists, every_choice_of_materials_is_read_and_checked)
{
    const auto load_with = [](const char* path, const json& value) { return load(with(with_value(json::object(), path, value), kPlain)); };
    const Result<Scene> plain = load(with(json::object(), kPlain));
    ASSERT_TRUE(plain);
#define BN_CHOICE(type, name, words, path)                                                                                                 \
    {                                                                                                                                      \
        std::istringstream list(words);                                                                                                    \
        int at = 0;                                                                                                                        \
        for (std::string word; list >> word; ++at) {                                                                                       \
            const Result<Scene> set = load_with(path, word);                                                                               \
            ASSERT_TRUE(set) << error_of(set);                                                                                             \
            EXPECT_EQ(static_cast<int>(set->materials[0].name), at) << word;                                                               \
        }                                                                                                                                  \
        EXPECT_GT(at, 1) << path;                                                                                                          \
        EXPECT_EQ(static_cast<int>(plain->materials[0].name), 0) << path;                                                                  \
        EXPECT_FALSE(load_with(path, "ANY")) << path;                                                                                      \
        EXPECT_FALSE(load_with(path, 1)) << path;                                                                                          \
    }
#include "core/scene/material.def"
}

TEST(lists, every_factor_of_lights_is_read_and_checked)
{
    const auto make = [](const json& value, const std::string& path) {
        return with(json::object(), path.empty() ? kPlain : with_value(kPlain, path, value));
    };
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most)                                                                           \
    expect_read_and_checked("/extensions/KHR_lights_punctual/lights/0", path, FieldKinds::kind(fallback), least, most, make,               \
                            [](const Scene& s) { return s.lights[0].name; });
#include "core/scene/light.def"
}

namespace {

Asset with_area_light(const json& light)
{
    Asset asset = triangle();
    asset.node = R"(,"extras":{"burnish":{"areaLight":)" + light.dump() + "}}";
    return asset;
}

// Returns a light with the given shape and number of points, placed around a square.
json area_light(const std::string& shape, int count)
{
    json points = json::array();
    const double around[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int k = 0; k < count; ++k)
        points.insert(points.end(), {around[k][0], around[k][1], 2.0});
    return {{"shape", shape}, {"points", points}, {"radius", 0.5}, {"radiance", {1, 2, 3}}};
}

} // namespace

TEST(lists, every_form_of_area_lights_is_read){
#define BN_AREA_SHAPE(name, at, least, most, what)                                                                                         \
    {                                                                                                                                      \
        const Result<Scene> scene = load(with_area_light(area_light(#name, least)));                                                       \
        ASSERT_TRUE(scene) << #name << error_of(scene);                                                                                    \
        ASSERT_EQ(scene->area_lights.size(), 1u);                                                                                          \
        EXPECT_EQ(scene->nodes[0].area_light, 0);                                                                                          \
        EXPECT_EQ(static_cast<int>(scene->area_lights[0].shape), at);                                                                      \
        EXPECT_EQ(scene->area_lights[0].points.size(), std::size_t{least});                                                                \
        EXPECT_FALSE(scene->area_lights[0].two_sided);                                                                                     \
        EXPECT_FALSE(scene->area_lights[0].solid);                                                                                         \
    }
#include "core/scene/area_light.def"
}

TEST(lists, every_factor_of_area_lights_is_read_and_checked)
{
    const auto make = [](const json& value, const std::string& path) {
        return with_area_light(path.empty() ? area_light("quad", 4) : with_value(area_light("quad", 4), path, value));
    };
#define BN_AREA_FACTOR(kind, name, path, least, most)                                                                                      \
    {                                                                                                                                      \
        using Value = FieldKinds::kind;                                                                                                    \
        const Result<Scene> scene = load(make(filled<Value>(1.25), path));                                                                 \
        ASSERT_TRUE(scene) << path << error_of(scene);                                                                                     \
        EXPECT_EQ(scene->area_lights[0].name, Value(1.25f)) << path;                                                                       \
        const Result<Scene> bad = load(make(filled<Value>(least - 1.0), path));                                                            \
        ASSERT_FALSE(bad) << path;                                                                                                         \
        EXPECT_EQ(bad.error().place,                                                                                                       \
                  std::string("/nodes/0/extras/burnish/areaLight" path) + (sizeof(Value) == sizeof(float) ? "" : "/0"));                   \
    }
#include "core/scene/area_light.def"
}
