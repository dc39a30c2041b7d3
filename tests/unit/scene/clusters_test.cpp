// Cluster bounds are conservative: culling by them loses nothing.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "core/scene/builtin/builtin.h"
#include "core/scene/draw_tables.h"

namespace burnish {
namespace {

glm::dvec3 position(const DrawTables& t, std::size_t corner)
{
    const std::uint32_t i = t.indices[corner];
    return glm::dvec3(glm::vec3(t.px[i], t.py[i], t.pz[i]));
}

DrawTables tables_of(const char* name)
{
    return make_draw_tables(*make_builtin_scene(name));
}

TEST(clusters, cover_every_triangle_once_in_order)
{
    const DrawTables t = tables_of("teapot");
    std::uint32_t next = 0;
    for (const Cluster& c : t.clusters) {
        EXPECT_EQ(c.first_triangle, next);
        EXPECT_GE(c.triangle_count, 1u);
        EXPECT_LE(c.triangle_count, kClusterTriangles);
        const Draw& draw = t.draws[c.draw];
        EXPECT_GE(c.first_triangle, draw.first_triangle);
        EXPECT_LE(c.first_triangle + c.triangle_count, draw.first_triangle + draw.triangle_count);
        next = c.first_triangle + c.triangle_count;
    }
    EXPECT_EQ(next, t.triangle_count());
}

TEST(clusters, spheres_hold_their_vertices)
{
    for (const char* name : {"teapot", "spheres", "plate"}) {
        const DrawTables t = tables_of(name);
        for (const Cluster& c : t.clusters)
            for (std::size_t k = 0; k < std::size_t{3} * c.triangle_count; ++k)
                EXPECT_LE(glm::length(position(t, std::size_t{3} * c.first_triangle + k) - glm::dvec3(c.center)),
                          static_cast<double>(c.radius))
                    << name;
    }
}

// Returns true where the documented test culls the cluster from an eye, computed as in a renderer.
bool culled(const Cluster& c, const glm::vec3& eye)
{
    const glm::vec3 d = c.center - eye;
    return c.cone_cutoff < 1.0f && glm::dot(d, c.cone_axis) >= c.cone_cutoff * glm::length(d) + c.radius;
}

int count_wrongly_culled(const DrawTables& t, const Cluster& c, const glm::vec3& eye)
{
    int wrong = 0;
    for (std::size_t k = 0; k < c.triangle_count; ++k) {
        const std::size_t first = 3 * (c.first_triangle + k);
        const glm::dvec3 a = position(t, first), b = position(t, first + 1), d = position(t, first + 2);
        wrong += glm::dot(glm::cross(b - a, d - a), glm::dvec3(eye) - a) > 0.0;
    }
    return wrong;
}

TEST(clusters, only_triangles_that_face_away_are_culled)
{
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> reach(0.0f, 1.0f);
    for (const char* name : {"teapot", "spheres", "plate"}) {
        const DrawTables t = tables_of(name);
        long long seen = 0, gone = 0;
        for (int trial = 0; trial < 300; ++trial) {
            const glm::vec3 way = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
            const glm::vec3 eye = way * (2.0f * reach(random)); // also between and inside the objects
            for (const Cluster& c : t.clusters) {
                ++seen;
                if (!culled(c, eye))
                    continue;
                ++gone;
                ASSERT_EQ(count_wrongly_culled(t, c, eye), 0) << name;
            }
        }
        EXPECT_GT(gone, seen / 10) << name << ": the cones are good for nothing";
    }
}

TEST(clusters, double_sided_materials_are_never_culled)
{
    Scene scene = *make_builtin_scene("teapot");
    for (Material& m : scene.materials)
        m.double_sided = true;
    for (const Cluster& c : make_draw_tables(scene).clusters)
        EXPECT_EQ(c.cone_cutoff, 1.0f);
}

TEST(clusters, far_from_the_origin_the_sphere_grows_by_the_rounding_of_its_coordinates)
{
    Scene scene = *make_builtin_scene("spheres");
    const double far = 3e5, rounding = far * 1.2e-7; // of center - eye in float
    for (Node& node : scene.nodes)
        node.local[3].z += static_cast<float>(far);
    update_world(scene);
    const DrawTables t = make_draw_tables(scene);
    ASSERT_FALSE(t.clusters.empty());
    for (const Cluster& c : t.clusters)
        for (std::size_t k = 0; k < std::size_t{3} * c.triangle_count; ++k) {
            const glm::dvec3 p = position(t, std::size_t{3} * c.first_triangle + k);
            ASSERT_LE(glm::length(p - glm::dvec3(c.center)) + rounding, static_cast<double>(c.radius));
        }
}

} // namespace
} // namespace burnish
