// Failure scenes: built-in scenes of the laboratory that take an amount.
#include "core/lab/failure_scenes.h"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace burnish {
namespace {

struct failure_scenes_of_the_laboratory : testing::Test {
    static void SetUpTestSuite()
    {
        EXPECT_FALSE(make_builtin_scene("needles")); // a program without laboratory has none
        add_parametric_scenes(failure_scenes());
    }
};

TEST_F(failure_scenes_of_the_laboratory, are_made_by_an_amount)
{
    EXPECT_GE(parametric_scenes().size(), 18u);
    for (const ParametricScene& scene : parametric_scenes()) {
        const std::string name = scene.info.name;
        const Result<Scene> usual = make_builtin_scene(name);
        ASSERT_TRUE(usual) << name;
        EXPECT_EQ(usual->name, name);
        EXPECT_GT(usual->indices.size(), 0u) << name;
        for (const char* amount : {"=x", "=0.5 ", "=nan", "=-1", "=", "=1e9"})
            EXPECT_FALSE(make_builtin_scene(name + amount)) << name << amount;
    }
    const auto places = [](const char* name) {
        const Scene scene = *make_builtin_scene(name);
        return std::vector<float>(scene.vertices.px.begin(), scene.vertices.px.end());
    };
    EXPECT_NE(places("needles=0.01"), places("needles=0.02"));
    EXPECT_EQ(places("needles"), places("needles=0.02"));
    EXPECT_EQ(make_builtin_scene("needles=7").error().line(), "builtin:needles=7: what follows = is no number from 1e-06 to 0.06");
}

TEST_F(failure_scenes_of_the_laboratory, are_those_that_the_program_looks_for)
{
    const std::vector<std::string> listed = {
#define BN_LAB_SCENE(name) name,
#include "apps/cli/lab_scenes.def"
    };
    std::vector<std::string> made;
    for (const ParametricScene& scene : failure_scenes())
        made.push_back(scene.info.name);
    EXPECT_EQ(listed, made);
}

} // namespace
} // namespace burnish
