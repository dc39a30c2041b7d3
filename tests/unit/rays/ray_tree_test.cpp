// The tree of rays: hits of brute force in double, closed meshes without leaks, the same hits in every lane.
#include "raster/rays/ray_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/builtin.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Ray {
    glm::vec3 origin, direction;
    float near = 0.0f, far = kInfinity;
};

void put(RayPacket& k, int lane, const Ray& r)
{
    k.org_x[lane] = r.origin.x, k.org_y[lane] = r.origin.y, k.org_z[lane] = r.origin.z;
    k.dir_x[lane] = r.direction.x, k.dir_y[lane] = r.direction.y, k.dir_z[lane] = r.direction.z;
    k.tnear[lane] = r.near, k.tfar[lane] = r.far, k.valid[lane] = -1;
}

glm::vec3 direction_of(Random& random)
{
    const double z = 2.0 * static_cast<double>(random.unit()) - 1.0, angle = 2.0 * kPi * static_cast<double>(random.unit());
    const double across = std::sqrt(1.0 - z * z);
    return glm::vec3(glm::dvec3(across * det_cos(angle), across * det_sin(angle), z));
}

glm::vec3 place_of(Random& random)
{
    const float x = random.unit(), y = random.unit();
    return glm::vec3(x, y, random.unit()) * 2.0f - 1.0f;
}

std::vector<Triangle> soup(int count, float size, Random& random)
{
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 middle = place_of(random);
        Triangle t;
        for (glm::vec3& corner : t)
            corner = middle + place_of(random) * size;
        triangles.push_back(t);
    }
    return triangles;
}

struct Hit {
    std::uint32_t triangle = kNoHit;
    double t = 0.0, margin = 0.0; // margin: the least weight, how far the hit is inside
};

// Returns all hits of a ray, found in double by plane and weights.
std::vector<Hit> hits_of(const DrawTables& tables, const Ray& r)
{
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; i < tables.triangle_count(); ++i) {
        glm::dvec3 p[3];
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = tables.indices[std::size_t{3} * i + static_cast<std::size_t>(k)];
            p[k] = glm::dvec3(glm::vec3(tables.px[v], tables.py[v], tables.pz[v]));
        }
        const glm::dvec3 e = p[1] - p[0], g = p[2] - p[0], d(r.direction), s = glm::dvec3(r.origin) - p[0];
        const double det = glm::dot(glm::cross(e, g), d);
        if (det == 0.0)
            continue;
        const double t = -glm::dot(glm::cross(e, g), s) / det;
        const glm::dvec3 at = s + d * t, n = glm::cross(e, g);
        const double v = glm::dot(glm::cross(e, at), n) / glm::dot(n, n), u = glm::dot(glm::cross(at, g), n) / glm::dot(n, n);
        const double margin = std::min({u, v, 1.0 - u - v});
        if (margin > -1e-4 && t > static_cast<double>(r.near) - 1e-4)
            hits.push_back({i, t, margin});
    }
    return hits;
}

TEST(ray_tree, meets_what_brute_force_in_double_meets)
{
    const Jobs jobs(2);
    Random random{7};
    int sure = 0, missed = 0;
    for (const int count : {1, 2, 5, 64, 700}) {
        const Scene scene = scene_of(soup(count, count > 100 ? 0.15f : 0.6f, random), true);
        const DrawTables tables = make_draw_tables(scene);
        const std::unique_ptr<RayScene> rays = make_tree_scene(scene, tables, jobs, best_isa());
        for (int turn = 0; turn < 40; ++turn) {
            RayPacket k = {}, shadow = {};
            Ray ray[kRays];
            for (int lane = 0; lane < kRays; ++lane) {
                ray[lane] = {place_of(random) * 1.5f, direction_of(random)};
                put(k, lane, ray[lane]), put(shadow, lane, ray[lane]);
            }
            rays->trace(k, RayKind::bounce), rays->trace(shadow, RayKind::occlusion);
            for (int lane = 0; lane < kRays; ++lane) {
                std::optional<Hit> nearest;
                bool close_call = false; // within the rounding of floats
                for (const Hit& hit : hits_of(tables, ray[lane])) {
                    close_call = close_call || std::fabs(hit.margin) < 1e-4 || std::fabs(hit.t) < 1e-4;
                    if (hit.margin > 0.0 && hit.t > 0.0 && (!nearest || hit.t < nearest->t))
                        nearest = hit;
                }
                if (close_call)
                    continue;
                ++sure;
                ASSERT_EQ(k.geometry[lane] != kNoHit, nearest.has_value());
                ASSERT_EQ(shadow.tfar[lane] < 0.0f, nearest.has_value());
                missed += !nearest;
                if (!nearest)
                    continue;
                EXPECT_NEAR(static_cast<double>(k.tfar[lane]), nearest->t, 1e-4 * (1.0 + nearest->t));
                EXPECT_EQ(k.triangle[lane], nearest->triangle);
            }
        }
    }
    EXPECT_GT(sure, 2500);
    EXPECT_GT(missed, 300);
}

// A ray from inside a closed mesh leaves it: none passes between triangles, or through an edge or corner that it is aimed at.
TEST(ray_tree, leaks_nowhere)
{
    const Jobs jobs(2);
    Random random{11};
    Result<Scene> scene = make_builtin_scene("sphere");
    ASSERT_TRUE(scene);
    const DrawTables ball = make_draw_tables(*scene);
    const Scene box = scene_of(tessellated_box(1.0f, 9), true);
    const DrawTables walls = make_draw_tables(box);
    for (const bool of_box : {false, true}) {
        const Scene* const shown = of_box ? &box : &*scene;
        const DrawTables* const tables = of_box ? &walls : &ball;
        const std::unique_ptr<RayScene> rays = make_tree_scene(*shown, *tables, jobs, best_isa());
        const glm::vec3 middle = 0.5f * (tables->bounds_min + tables->bounds_max);
        const glm::vec3 half = 0.5f * (tables->bounds_max - tables->bounds_min);
        for (int turn = 0; turn < 6000; ++turn) {
            RayPacket k = {};
            for (int lane = 0; lane < kRays; ++lane) {
                const glm::vec3 from = middle + place_of(random) * half * 0.5f;
                const auto vertex = static_cast<std::size_t>(random.below(static_cast<int>(tables->indices.size())));
                const auto at = [&](std::size_t i) {
                    const std::uint32_t v = tables->indices[i];
                    return glm::vec3(tables->px[v], tables->py[v], tables->pz[v]);
                };
                const std::size_t next = vertex - vertex % 3 + (vertex + 1) % 3;
                const float along = turn % 3 == 0 ? 0.0f : random.unit(); // a corner, an edge, or anywhere
                const glm::vec3 aim = at(vertex) + (at(next) - at(vertex)) * along;
                put(k, lane, {from, turn % 3 == 2 ? direction_of(random) : aim - from});
            }
            rays->trace(k, RayKind::occlusion);
            for (int lane = 0; lane < kRays; ++lane)
                ASSERT_LT(k.tfar[lane], 0.0f) << "turn " << turn << ", lane " << lane;
        }
    }
}

TEST(ray_tree, hits_are_the_same_for_every_isa_packet_and_number_of_threads)
{
    Random random{3};
    std::vector<Triangle> triangles = soup(6000, 0.05f, random);
    for (std::size_t i = 0; i < 500; ++i) // the same triangle twice: the lower id counts
        triangles.push_back(triangles[i]);
    const Scene scene = scene_of(triangles, false);
    const DrawTables tables = make_draw_tables(scene);
    const Jobs one(1), three(3);
    std::vector<std::unique_ptr<RayScene>> scenes;
    for (const Isa isa : isas_with<TraceFns>())
        scenes.push_back(make_tree_scene(scene, tables, one, isa));
    scenes.push_back(make_tree_scene(scene, tables, three, best_isa()));
    std::size_t twins = 0;
    for (int turn = 0; turn < 400; ++turn) {
        const RayKind kind = turn % 3 == 0 ? RayKind::camera : turn % 3 == 1 ? RayKind::bounce : RayKind::occlusion;
        Ray ray[kRays];
        for (Ray& r : ray)
            r = {place_of(random), direction_of(random), 0.05f, turn % 2 ? kInfinity : 1.0f};
        RayPacket first = {};
        for (std::size_t s = 0; s < scenes.size(); ++s) {
            RayPacket k = {};
            for (int lane = 0; lane < kRays; ++lane) // others in the packet change nothing
                if (s == 0 || (lane + turn) % 2 == 0)
                    put(k, lane, ray[lane]);
            scenes[s]->trace(k, kind);
            if (s == 0) {
                first = k;
                continue;
            }
            for (int lane = 0; lane < kRays; ++lane)
                if (k.valid[lane]) {
                    ASSERT_EQ(k.tfar[lane], first.tfar[lane]);
                    if (kind != RayKind::occlusion && k.geometry[lane] != kNoHit) {
                        ASSERT_EQ(k.triangle[lane], first.triangle[lane]);
                        ASSERT_EQ(k.u[lane], first.u[lane]);
                        ASSERT_EQ(k.v[lane], first.v[lane]);
                        twins += k.triangle[lane] < 500;
                        ASSERT_LT(k.triangle[lane], 6000u);
                    }
                }
        }
    }
    EXPECT_GT(twins, 50u);
}

TEST(ray_tree, cameras_look_through_the_backs_of_single_sided_triangles)
{
    const Jobs jobs(1);
    const Triangle facing = {glm::vec3(-1, -1, 0), {1, -1, 0}, {0, 1, 0}}; // counter-clockwise from +z
    const Triangle behind = {glm::vec3(-1, -1, -1), {1, -1, -1}, {0, 1, -1}};
    const Scene scene = scene_of({facing, behind}, false);
    const DrawTables tables = make_draw_tables(scene);
    const std::unique_ptr<RayScene> rays = make_tree_scene(scene, tables, jobs, best_isa());
    RayPacket k = {};
    put(k, 0, {{0, 0, 1}, {0, 0, -1}}), put(k, 1, {{0, 0, -3}, {0, 0, 1}});
    RayPacket bounce = k;
    rays->trace(k, RayKind::camera), rays->trace(bounce, RayKind::bounce);
    EXPECT_EQ(k.triangle[0], 0u);
    EXPECT_EQ(k.geometry[1], kNoHit);
    EXPECT_EQ(bounce.triangle[1], 1u);
    EXPECT_EQ(bounce.tfar[1], 2.0f);
}

TEST(ray_tree, of_nothing_and_of_flat_triangles_meets_nothing)
{
    const Jobs jobs(1);
    for (const std::vector<Triangle>& triangles :
         {std::vector<Triangle>{}, {{glm::vec3(0), glm::vec3(0), glm::vec3(0)}}, {{glm::vec3(-1, 0, 0), {1, 0, 0}, {0, 0, 0}}}}) {
        const Scene scene = scene_of(triangles, true);
        const DrawTables tables = make_draw_tables(scene);
        const std::unique_ptr<RayScene> rays = make_tree_scene(scene, tables, jobs, best_isa());
        RayPacket k = {};
        put(k, 0, {{0, 0, 1}, {0, 0, -1}}), put(k, 1, {{0.2f, 0.3f, 1}, {0, 0, -1}});
        put(k, 2, {{0, 0, 1}, glm::vec3(std::nanf(""))}), put(k, 3, {{0, 0, 1}, {0, 0, 0}});
        rays->trace(k, RayKind::bounce);
        for (int lane = 0; lane < 4; ++lane)
            EXPECT_EQ(k.geometry[lane], kNoHit) << lane;
    }
}

} // namespace
} // namespace burnish::test
