#include "core/scene/builtin/builtin.h"

#include <array>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <string>

#include "core/base/hash.h"
#include "core/scene/draw_tables.h"
#include "tests/unit/data.h"

namespace burnish {
namespace {

std::uint64_t hash_column(const Column<float>& c, std::uint64_t seed)
{
    return hash_bytes(c.data(), c.size() * sizeof(float), seed);
}

std::uint64_t hash_scene(const Scene& scene)
{
    const VertexTable& v = scene.vertices;
    std::uint64_t h = 0;
    for (const Column<float>* c :
         {&v.px, &v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.tx, &v.ty, &v.tz, &v.tw, &v.u0, &v.v0, &v.u1, &v.v1, &v.cr, &v.cg, &v.cb, &v.ca})
        h = hash_column(*c, h);
    h = hash_bytes(scene.indices.data(), scene.indices.size() * sizeof(std::uint32_t), h);
    for (const Node& node : scene.nodes)
        h = hash_bytes(&node.world, sizeof(node.world), h);
    for (const Image& image : scene.images)
        h = hash_bytes(image.bytes.data(), image.bytes.size(), h);
    return h;
}

// Pins bits that are equal on every machine and with every compiler. Change the hashes on purpose only.
TEST(builtin, bits_are_pinned)
{
    const std::map<std::string, std::uint64_t> scenes = {{"teapot", 0xc7e1fb7e9946dd9eull},
                                                         {"spheres", 0x4de7ec20301778b3ull},
                                                         {"plate", 0x7f8dcd862d1fc796ull},
                                                         {"cloth", 0x647da1336d24225ull}};
    const std::map<std::string, std::uint64_t> environments = {{"studio", 0x19febed410644343ull}, {"sky", 0xf287c30da37dad5bull}};
    for (const auto& [name, want] : scenes)
        EXPECT_EQ(hash_scene(*make_builtin_scene(name)), want) << name;
    for (const auto& [name, want] : environments) {
        const Result<Image> image = make_builtin_environment(name);
        EXPECT_EQ(hash_bytes(image->bytes.data(), image->bytes.size()), want) << name;
    }
}

TEST(builtin, lists_name_what_can_be_made)
{
    ASSERT_EQ(builtin_scenes().size(), 11u);
    ASSERT_EQ(builtin_environments().size(), 3u);
    for (const BuiltinInfo& info : builtin_scenes())
        EXPECT_TRUE(make_builtin_scene(info.name)) << info.name;
    for (const BuiltinInfo& info : builtin_environments())
        EXPECT_TRUE(make_builtin_environment(info.name)) << info.name;
}

TEST(builtin, unknown_names_are_errors_that_list_the_known)
{
    const Result<Scene> scene = make_builtin_scene("kettle");
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().line(), "builtin:kettle: no built-in scene has this name; there are teapot, spheres, sphere, plate, lights, "
                                    "glass, bumps, lacquer, cloth, anodised, shaderballs");
    EXPECT_FALSE(make_builtin_environment("cave"));
}

TEST(builtin, scenes_have_frames_columns_and_modest_counts)
{
    for (const BuiltinInfo& info : builtin_scenes()) {
        const Scene scene = *make_builtin_scene(info.name);
        const VertexTable& v = scene.vertices;
        for (const Column<float>* c :
             {&v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.tx, &v.ty, &v.tz, &v.tw, &v.u0, &v.v0, &v.u1, &v.v1, &v.cr, &v.cg, &v.cb, &v.ca})
            ASSERT_EQ(c->size(), v.size());
        for (std::size_t i = 0; i < v.size(); ++i) {
            const glm::vec3 n(v.nx[i], v.ny[i], v.nz[i]), t(v.tx[i], v.ty[i], v.tz[i]);
            ASSERT_TRUE(std::isfinite(v.px[i] + v.py[i] + v.pz[i] + v.u0[i] + v.v0[i])) << info.name << i;
            ASSERT_NEAR(glm::dot(n, n), 1.0f, 1e-6f) << info.name << i;
            ASSERT_NEAR(glm::dot(t, t), 1.0f, 1e-6f) << info.name << i;
            ASSERT_NEAR(glm::dot(n, t), 0.0f, 1e-6f) << info.name << i;
            ASSERT_EQ(v.tw[i], 1.0f);
        }
        const DrawTables tables = make_draw_tables(scene);
        EXPECT_GE(tables.triangle_count(), 10000u) << info.name;
        EXPECT_LE(tables.triangle_count(), 100000u) << info.name;
    }
}

TEST(builtin, faces_agree_with_their_normals)
{
    for (const BuiltinInfo& info : builtin_scenes()) {
        const DrawTables t = make_draw_tables(*make_builtin_scene(info.name));
        for (std::size_t k = 0; k < t.triangle_count(); ++k) {
            glm::dvec3 p[3], n[3];
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t i = t.indices[3 * k + c];
                p[c] = glm::dvec3(glm::vec3(t.px[i], t.py[i], t.pz[i]));
                n[c] = glm::dvec3(glm::vec3(t.shading[i].normal[0], t.shading[i].normal[1], t.shading[i].normal[2]));
            }
            const glm::dvec3 face = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
            for (const glm::dvec3& corner : n) // within 60 degrees, even at the poles
                ASSERT_GT(glm::dot(face, corner), 0.5) << info.name << " triangle " << k;
        }
    }
}

using Place = std::array<float, 3>;

// Counts directed edges, by position, of the triangles that `use` picks. In a closed surface each edge meets its opposite once.
template <class Use> int count_open_edges(const DrawTables& t, const Use& use)
{
    std::map<std::pair<Place, Place>, int> edges;
    for (std::size_t k = 0; k < t.triangle_count(); ++k)
        for (std::size_t c = 0; use(k) && c < 3; ++c) {
            const std::uint32_t a = t.indices[3 * k + c], b = t.indices[3 * k + (c + 1) % 3];
            const Place from{t.px[a], t.py[a], t.pz[a]}, to{t.px[b], t.py[b], t.pz[b]};
            ++edges[{from, to}];
            --edges[{to, from}];
        }
    int open = 0;
    for (const auto& [edge, balance] : edges)
        open += balance != 0;
    return open;
}

TEST(builtin, spheres_plate_glass_and_teapot_body_are_closed)
{
    const auto all = [](std::size_t) { return true; };
    EXPECT_EQ(count_open_edges(make_draw_tables(*make_builtin_scene("spheres")), all), 0);
    EXPECT_EQ(count_open_edges(make_draw_tables(*make_builtin_scene("plate")), all), 0);
    EXPECT_EQ(count_open_edges(make_draw_tables(*make_builtin_scene("glass")), all), 0);
    // In the pot, handle and spout end openly inside the body: the handle with two rings of 32 edges, the spout with one. Each edge counts
    // from both sides.
    const DrawTables t = make_draw_tables(*make_builtin_scene("teapot"));
    const auto pot = [&t](std::size_t k) { return t.triangle_material[k] == 0; };
    EXPECT_EQ(count_open_edges(t, pot), 2 * 3 * 32);
}

TEST(builtin, teapot_stands_upright_with_its_spout_to_plus_x)
{
    const DrawTables t = make_draw_tables(*make_builtin_scene("teapot"));
    const Draw& pot = t.draws.at(0);
    EXPECT_EQ(pot.bounds_min.y, 0.0f);
    EXPECT_NEAR(pot.bounds_max.y, 0.1575f, 1e-6f);
    EXPECT_GT(pot.bounds_max.x, -pot.bounds_min.x); // the spout reaches further than the handle
    EXPECT_NEAR(pot.bounds_max.z, -pot.bounds_min.z, 1e-7f);
}

// Returns the distance from the teapot's nearest vertex to a point of Newell's space, in his units.
double nearest_vertex(const Scene& scene, double x, double y, double z)
{
    const VertexTable& v = scene.vertices;
    const glm::vec3 p(static_cast<float>(0.05 * x), static_cast<float>(0.05 * z), static_cast<float>(-0.05 * y));
    float nearest = 1.0f;
    for (std::uint32_t k = 0; k < scene.primitives[0].vertex_count; ++k)
        nearest = std::fmin(nearest, glm::length(glm::vec3(v.px[k], v.py[k], v.pz[k]) - p));
    return static_cast<double>(nearest) / 0.05;
}

// Corners of the patches, after Crow 1987, "The Origins of the Teapot".
TEST(builtin, teapot_passes_through_the_published_corners_of_its_patches)
{
    const Scene scene = *make_builtin_scene("teapot");
    const double turned[][2] = {{1.4, 2.4}, {1.5, 2.4}, {2.0, 0.9},  {1.5, 0.15},
                                {1.3, 2.4}, {0.2, 2.7}, {0.0, 3.15}, {0.0, 0.0}}; // radius, z
    for (const auto& [r, z] : turned)
        for (const auto& [x, y] : {std::array{r, 0.0}, {-r, 0.0}, {0.0, r}, {0.0, -r}})
            EXPECT_LT(nearest_vertex(scene, x, y, z), 1e-5) << x << " " << y << " " << z;
    const double mirrored[][2] = {{-1.6, 2.025}, {-1.5, 2.25}, {-2.7, 1.8}, {-3.0, 1.8}, {-2.0, 0.9}, {-1.9, 0.6}, // handle: x, z
                                  {1.7, 0.6},    {1.7, 1.425}, {3.3, 2.4},  {2.7, 2.4},  {3.2, 2.4},  {2.8, 2.4}};
    for (const auto& [x, z] : mirrored)
        EXPECT_LT(nearest_vertex(scene, x, 0.0, z), 1e-5) << x << " " << z;
    // Optional data: all 28 patches as geomview's distribution stores them, scaled by 1/4, moved, rounded to about 0.004 units.
    std::ifstream file(test::data_file("meshes/teapot.bez"));
    std::string magic;
    if (!(file >> magic))
        return;
    ASSERT_EQ(magic, "BBP");
    std::array<double, 48> patch{};
    int patches = 0;
    for (double first; file >> first; ++patches) {
        patch[0] = first;
        for (std::size_t i = 1; i < 48; ++i)
            file >> patch[i];
        for (const std::size_t i : {0u, 3u, 12u, 15u}) { // a patch contains its corners
            const double nearest =
                nearest_vertex(scene, 4.0 * (patch[3 * i] - 0.5), 4.0 * patch[3 * i + 1], 4.0 * (patch[3 * i + 2] - 0.263037));
            EXPECT_LT(nearest, 0.005) << "patch " << patches << " point " << i;
        }
    }
    EXPECT_EQ(patches, 28);
}

TEST(builtin, spheres_span_roughness_and_eta)
{
    const Result<Scene> scene = make_builtin_scene("spheres");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->materials.size(), 35u);
    const double eta[5] = {0.0, 0.25, 0.5, 0.75, 0.95};
    for (std::size_t i = 0; i < 35; ++i) { // alpha across and along, converted back from the extension
        const Material& m = scene->materials[i];
        const double across = static_cast<double>(m.roughness) * static_cast<double>(m.roughness);
        const double s = static_cast<double>(m.anisotropy_strength), along = across + (1.0 - across) * s * s;
        const double roughness = static_cast<double>(i % 7 + 1) * 0.1;
        EXPECT_NEAR(std::sqrt(0.5 * (along + across)), roughness, 1e-6) << i;
        EXPECT_NEAR((along - across) / (along + across), eta[i / 7], 1e-5) << i;
    }
}

TEST(builtin, plate_carries_unit_directions)
{
    const Scene scene = *make_builtin_scene("plate");
    ASSERT_TRUE(scene.materials.at(0).anisotropy_tex.used());
    const Image& image = scene.images.at(0);
    ASSERT_EQ(image.channels, 3);
    for (std::size_t i = 0; i < image.bytes.size(); i += 3) {
        const float x = static_cast<float>(image.bytes[i]) / 127.5f - 1.0f, y = static_cast<float>(image.bytes[i + 1]) / 127.5f - 1.0f;
        ASSERT_NEAR(std::sqrt(x * x + y * y), 1.0f, 0.01f);
        ASSERT_GE(static_cast<int>(image.bytes[i + 2]), 180);
    }
}

TEST(builtin, environments_are_finite_and_span_a_thousand_to_one)
{
    for (const BuiltinInfo& info : builtin_environments()) {
        const Image image = *make_builtin_environment(info.name);
        ASSERT_EQ(image.width, 1024);
        ASSERT_EQ(image.height, 512);
        ASSERT_EQ(image.channels, 3);
        ASSERT_EQ(image.type, PixelType::f32);
        float low = 1e30f, high = 0.0f;
        for (std::size_t i = 0; i < std::size_t{1024} * 512 * 3; ++i) {
            ASSERT_TRUE(std::isfinite(image.f32()[i])) << info.name;
            low = std::fmin(low, image.f32()[i]);
            high = std::fmax(high, image.f32()[i]);
        }
        EXPECT_GT(low, 0.0f) << info.name;
        if (std::string(info.name) != "night") {
            EXPECT_GE(high, 1000.0f * low) << info.name;
        }
    }
}

TEST(builtin, the_sun_is_small_bright_and_on_the_front_left)
{
    const Image sky = *make_builtin_environment("sky");
    int bright = 0;
    double column_sum = 0.0, row_sum = 0.0;
    for (int row = 0; row < 512; ++row)
        for (int column = 0; column < 1024; ++column)
            if (sky.f32()[(row * 1024 + column) * 3] > 1000.0f) {
                ++bright;
                column_sum += column;
                row_sum += row;
            }
    EXPECT_GT(bright, 10);
    EXPECT_LT(bright, 100);
    // u = 1/2 + atan2(z, x) / 2 pi with the sun at (-0.55, 0.62, 0.56), not normalised; v = acos(y) / pi.
    const double length = std::sqrt(0.55 * 0.55 + 0.62 * 0.62 + 0.56 * 0.56), pi = 3.141592653589793;
    EXPECT_NEAR((column_sum / bright + 0.5) / 1024, 0.5 + std::atan2(0.56, -0.55) / (2 * pi), 1e-3);
    EXPECT_NEAR((row_sum / bright + 0.5) / 512, std::acos(0.62 / length) / pi, 1e-3);
}

} // namespace
} // namespace burnish
