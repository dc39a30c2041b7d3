// A scene far from the world's origin gives the same image as near the origin.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/scene/builtin/builtin.h"
#include "core/scene/origin.h"
#include "raster/session/session.h"

namespace burnish {
namespace {

constexpr int kWidth = 96, kHeight = 64;

// Translates the whole world. Every root keeps the remainder that floats lose.
void translate(Scene& scene, const glm::dvec3& by)
{
    for (Node& node : scene.nodes) {
        if (node.parent != kNone)
            continue;
        const glm::dvec3 place = glm::dvec3(glm::vec3(node.local[3])) + node.local_beyond + by;
        node.local[3] = glm::vec4(glm::vec3(place), 1.0f);
        node.local_beyond = place - glm::dvec3(glm::vec3(place));
    }
}

void add_lamp(Scene& scene)
{
    Light light;
    light.intensity = 30.0f;
    Node node;
    node.light = static_cast<int>(scene.lights.size());
    node.local[3] = glm::vec4(1.5f, 2.5f, 2.0f, 1.0f);
    scene.lights.push_back(light);
    scene.nodes.push_back(node);
    AreaLight area;
    area.points = {glm::vec3(-1, 3, 1), glm::vec3(1, 3, 1), glm::vec3(1, 3, -1), glm::vec3(-1, 3, -1)};
    area.radiance = glm::vec3(3.0f);
    area.two_sided = true;
    Node lamp;
    lamp.area_light = static_cast<int>(scene.area_lights.size());
    scene.area_lights.push_back(area);
    scene.nodes.push_back(lamp);
}

// Draws from the same place relative to the scene, moved by `by`.
Frame picture(const std::string& name, const glm::dvec3& by, Backend backend, glm::dvec3& origin)
{
    Result<Scene> scene = make_builtin_scene(name);
    EXPECT_TRUE(scene);
    add_lamp(*scene);
    translate(*scene, by);
    EnvironmentOptions small;
    small.cube_size = 16, small.samples = 16, small.use_cache = false;
    SessionParts parts;
    parts.jobs = std::make_shared<const Jobs>(1);
    parts.scene = *make_scene_data(name, std::move(*scene), Limits{});
    parts.environment = *load_shared_environment("builtin:studio", small, Limits{}, *parts.jobs);
    EXPECT_TRUE(parts.scene->scene.warnings.empty()) << parts.scene->scene.warnings.front();
    origin = parts.scene->scene.origin;
    SessionOptions options;
    options.backend = backend;
    options.reference.samples = 4;
    Result<Session> session = Session::make(parts, options);
    EXPECT_TRUE(session) << session.error().line();
    FrameDesc desc;
    desc.width = kWidth, desc.height = kHeight, desc.msaa = 4, desc.technique = "bent_normal";
    const glm::dvec3 eye = glm::dvec3(2.0, 1.75, 3.5) + by - origin, target = glm::dvec3(0.0, 0.5, 0.0) + by - origin;
    desc.view = make_view(glm::vec3(eye), glm::vec3(target), 0.8f, kWidth, kHeight);
    Result<Frame> frame = session->render(desc);
    EXPECT_TRUE(frame) << frame.error().line();
    return *frame;
}

std::size_t words_off(const Frame& a, const Frame& b, float most)
{
    std::size_t off = 0;
    for (int i = 0; i < 3 * kWidth * kHeight; ++i)
        off += !(std::fabs(a.color.f32()[i] - b.color.f32()[i]) <= most * std::fabs(a.color.f32()[i]));
    return off;
}

constexpr Backend kBackends[] = {Backend::tile, Backend::reference};

// 4600 km is a multiple of the origins' grid step, so every bit stays.
TEST(far, whole_kilometres_away_has_the_same_bits)
{
    for (const std::string name : {"teapot", "spheres"})
        for (const Backend backend : kBackends) {
            if (backend == Backend::reference && !reference_available())
                continue;
            glm::dvec3 near_origin, far_origin;
            const Frame near = picture(name, glm::dvec3(0.0), backend, near_origin);
            const Frame far = picture(name, glm::dvec3(4.6e6, -64.0, 1.2e6), backend, far_origin);
            EXPECT_EQ(near_origin, glm::dvec3(0.0));
            EXPECT_EQ(far_origin, glm::dvec3(4.6e6, -64.0, 1.2e6)) << name;
            EXPECT_EQ(pixel_hash(near.color), pixel_hash(far.color)) << name;
        }
}

// Elsewhere the scene's floats are rounded at other places, to 2^-22 m.
TEST(far, anywhere_has_the_same_picture)
{
    for (const Backend backend : kBackends) {
        if (backend == Backend::reference && !reference_available())
            continue;
        glm::dvec3 origin;
        const Frame near = picture("teapot", glm::dvec3(0.0), backend, origin);
        const Frame far = picture("teapot", glm::dvec3(4600000.3, 123.456, -6.0e6 - 1.0 / 3.0), backend, origin);
        EXPECT_GT(glm::length(origin), 7e6);
        const std::size_t off = words_off(near, far, 0.01f);
        std::printf("%zu of %d words differ by more than 1 %%\n", off, 3 * kWidth * kHeight);
        EXPECT_LE(off, static_cast<std::size_t>(3 * kWidth * kHeight / 200));
    }
}

Scene two_points(const glm::vec3& offset, float size)
{
    Result<Scene> scene = make_builtin_scene("plate");
    EXPECT_TRUE(scene);
    for (std::size_t i = 0; i < scene->vertices.size(); ++i) {
        scene->vertices.px[i] = scene->vertices.px[i] * size + offset.x;
        scene->vertices.py[i] = scene->vertices.py[i] * size + offset.y;
        scene->vertices.pz[i] = scene->vertices.pz[i] * size + offset.z;
    }
    return std::move(*scene);
}

TEST(far, vertices_that_lost_their_digits_are_warned_of)
{
    const auto data = make_scene_data("far", two_points({4.6e6f, 0, 0}, 1.0f), Limits{});
    ASSERT_TRUE(data);
    ASSERT_EQ((*data)->scene.warnings.size(), 1u);
    EXPECT_NE((*data)->scene.warnings[0].find("steps of 0.5 m"), std::string::npos) << (*data)->scene.warnings[0];
    EXPECT_NE((*data)->scene.warnings[0].find("vertices"), std::string::npos);
}

TEST(far, scenes_from_here_to_there_are_warned_of)
{
    Result<Scene> scene = make_builtin_scene("plate");
    ASSERT_TRUE(scene);
    const std::size_t count = scene->nodes.size();
    for (std::size_t i = 0; i < count; ++i)
        if (scene->nodes[i].mesh != kNone && scene->nodes[i].parent == kNone) {
            Node other = scene->nodes[i];
            other.name = "beyond", other.local[3] = glm::vec4(4.6e6f, 0, 0, 1);
            scene->nodes.push_back(other);
        }
    const auto data = make_scene_data("wide", std::move(*scene), Limits{});
    ASSERT_TRUE(data);
    EXPECT_EQ((*data)->scene.origin, glm::dvec3(0.0));
    ASSERT_EQ((*data)->scene.warnings.size(), 1u);
    EXPECT_NE((*data)->scene.warnings[0].find("node 'beyond' lies 4.6e+06 m"), std::string::npos) << (*data)->scene.warnings[0];
    EXPECT_NE((*data)->scene.warnings[0].find("steps of 0.5 m"), std::string::npos) << (*data)->scene.warnings[0];
}

TEST(far, scenes_about_the_origin_keep_it)
{
    for (const glm::dvec3 by : {glm::dvec3(0.0), glm::dvec3(1.0, -1.0, 2.0)}) {
        Result<Scene> scene = make_builtin_scene("teapot");
        ASSERT_TRUE(scene);
        translate(*scene, by);
        const auto data = make_scene_data("near", std::move(*scene), Limits{});
        ASSERT_TRUE(data);
        EXPECT_EQ((*data)->scene.origin, glm::dvec3(0.0));
        EXPECT_TRUE((*data)->scene.warnings.empty());
    }
}

} // namespace
} // namespace burnish
