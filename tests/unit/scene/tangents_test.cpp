#include "core/scene/tangents.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <sstream>
#include <string>

namespace burnish {
namespace {

struct Case {
    std::string name;
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec4> expected;
};

std::vector<Case> golden_cases()
{
    std::ifstream file(BN_SOURCE_DIR "/tests/data/mikktspace_golden.txt");
    std::vector<Case> cases;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string first;
        words >> first;
        if (first == "#")
            continue;
        if (first == "case") {
            words >> cases.emplace_back().name;
            continue;
        }
        float v[12] = {std::stof(first)};
        for (int k = 1; k < 12; ++k)
            words >> v[k];
        Case& c = cases.back();
        c.positions.emplace_back(v[0], v[1], v[2]);
        c.normals.emplace_back(v[3], v[4], v[5]);
        c.uvs.emplace_back(v[6], v[7]);
        c.expected.emplace_back(v[8], v[9], v[10], v[11]);
    }
    return cases;
}

TEST(tangents, equal_an_independent_implementation_in_every_corner)
{
    const std::vector<Case> cases = golden_cases();
    ASSERT_EQ(cases.size(), 14u);
    for (const Case& c : cases) {
        const std::vector<glm::vec4> got = mikk_tangents(c.positions, c.normals, c.uvs);
        ASSERT_EQ(got.size(), c.expected.size());
        for (std::size_t i = 0; i < got.size(); ++i) {
            EXPECT_GT(glm::dot(glm::vec3(got[i]), glm::vec3(c.expected[i])), 0.9999f) << c.name << " corner " << i;
            EXPECT_EQ(got[i].w, c.expected[i].w) << c.name << " corner " << i;
        }
    }
}

void expect_frame(const glm::vec4& t, const glm::vec3& n, std::size_t i)
{
    EXPECT_NEAR(glm::length(glm::vec3(t)), 1.0f, 1e-6f) << i;
    EXPECT_NEAR(glm::dot(glm::vec3(t), n), 0.0f, 1e-6f) << i;
    EXPECT_TRUE(t.w == 1.0f || t.w == -1.0f) << i;
}

TEST(tangents, are_unit_and_orthogonal_whatever_comes_in)
{
    std::mt19937 random(7);
    std::uniform_int_distribution<int> few(0, 2);
    const float odd[] = {0.0f, 1.0f, -1.0f};
    std::vector<glm::vec3> p, n;
    std::vector<glm::vec2> uv;
    for (int i = 0; i < 3000; ++i) { // few distinct values: shared, collapsed and overlapping triangles abound
        p.emplace_back(odd[few(random)], odd[few(random)], odd[few(random)]);
        uv.emplace_back(odd[few(random)], odd[few(random)]);
        n.push_back(few(random) ? glm::vec3(0, 0, 1) : glm::vec3(few(random) ? 1 : -1, 0, 0));
    }
    p[5] = glm::vec3(1e38f, -1e38f, 1e-38f);
    uv[8].x = std::numeric_limits<float>::infinity();
    uv[9].y = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec4> t = mikk_tangents(p, n, uv);
    for (std::size_t i = 0; i < t.size(); ++i)
        expect_frame(t[i], n[i], i);
}

TEST(tangents, a_large_fan_needs_no_stack)
{
    std::vector<glm::vec3> p;
    std::vector<glm::vec2> uv;
    const int count = 300000;
    const auto rim = [](int i) { return glm::vec3(static_cast<float>(i), 1.0f + static_cast<float>(i % 7), 0.0f); };
    for (int i = 0; i < count; ++i)
        for (const glm::vec3& q : {glm::vec3(0.0f), rim(i + 1), rim(i)}) {
            p.push_back(q);
            uv.emplace_back(q.x, q.y);
        }
    const std::vector<glm::vec4> t = mikk_tangents(p, std::vector<glm::vec3>(p.size(), glm::vec3(0, 0, 1)), uv);
    EXPECT_NEAR(t[0].x, 1.0f, 1e-6f);
    EXPECT_NEAR(t[3 * 299999].x, 1.0f, 1e-6f);
}

TEST(tangents, nothing_gives_nothing)
{
    EXPECT_TRUE(mikk_tangents({}, {}, {}).empty());
}

TEST(tangents, any_tangent_is_orthogonal_and_continuous_away_from_its_pole)
{
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 n = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const glm::vec3 t = any_tangent(n);
        ASSERT_NEAR(glm::length(t), 1.0f, 1e-6f);
        ASSERT_NEAR(glm::dot(t, n), 0.0f, 1e-6f);
        if (n.z > -0.9f) {
            const glm::vec3 near = glm::normalize(n + 1e-3f * glm::vec3(normal(random), normal(random), normal(random)));
            ASSERT_LT(glm::length(any_tangent(near) - t), 0.1f);
        }
    }
    EXPECT_NEAR(glm::dot(any_tangent({0, 0, -1}), glm::vec3(0, 0, -1)), 0.0f, 1e-6f);
}

} // namespace
} // namespace burnish
