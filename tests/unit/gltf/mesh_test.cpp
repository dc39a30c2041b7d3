// Primitives: modes, normals, tangents, welding, colours.
#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "asset.h"

using namespace burnish;
using namespace burnish::test;

namespace {

// Returns a scene's warnings, without those for deliberate omissions of these small files: position bounds, unit normals, skin roots.
std::vector<std::string> said_of(const Scene& scene)
{
    std::vector<std::string> said;
    for (const std::string& warning : scene.warnings)
        if (warning.empty() || warning[0] != '/')
            said.push_back(warning);
    return said;
}

using Corner = std::array<float, 2>; // x and y of a corner

std::vector<Corner> corners_of(const Scene& scene)
{
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < scene.indices.size(); ++i)
        corners.push_back({scene.vertices.px[scene.indices[i]], scene.vertices.py[scene.indices[i]]});
    return corners;
}

const ByteVector kFivePoints = floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});

Asset points(int mode)
{
    Asset asset;
    asset.attribute("POSITION", asset.accessor(kFivePoints, kF32, "VEC3", 5));
    asset.primitive = R"(,"mode":)" + std::to_string(mode);
    return asset;
}

// Returns a square of two triangles in the plane z = 0, with normals +Z and texture coordinates u = x, v = 1 - y.
Asset square()
{
    Asset asset;
    asset.attribute("POSITION", asset.accessor(floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), kF32, "VEC3", 4));
    asset.attribute("NORMAL", asset.accessor(floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), kF32, "VEC3", 4));
    asset.attribute("TEXCOORD_0", asset.accessor(floats({0, 1, 1, 1, 1, 0, 0, 0}), kF32, "VEC2", 4));
    const int indices = asset.accessor(bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3}), kU16, "SCALAR", 6);
    asset.primitive = R"(,"indices":)" + std::to_string(indices);
    return asset;
}

} // namespace

TEST(mesh, strips_become_triangles_that_keep_their_winding)
{
    const Result<Scene> scene = load(points(5));
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    const std::vector<Corner> want = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}, {0, 1}, {1, 1}, {0, 2}};
    EXPECT_EQ(corners_of(*scene), want);
    for (const float nz : scene->vertices.nz)
        EXPECT_EQ(nz, 1.0f); // all normals face +z
}

TEST(mesh, fans_become_triangles_around_the_first_vertex)
{
    const Result<Scene> scene = load(points(6));
    ASSERT_TRUE(scene) << error_of(scene);
    const std::vector<Corner> want = {{1, 0}, {0, 1}, {0, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 1}, {0, 2}, {0, 0}};
    EXPECT_EQ(corners_of(*scene), want);
}

TEST(mesh, an_incomplete_last_triangle_is_left_out_with_a_warning)
{
    const Result<Scene> scene = load(points(4));
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->indices.size(), 3u);
    ASSERT_EQ(said_of(*scene).size(), 1u);
    EXPECT_NE(said_of(*scene)[0].find("multiple of 3"), std::string::npos);
}

TEST(mesh, points_and_lines_are_left_out_with_a_warning)
{
    for (const int mode : {0, 1, 2, 3}) {
        const Result<Scene> scene = load(points(mode));
        ASSERT_TRUE(scene) << error_of(scene);
        expect_sound(*scene);
        EXPECT_TRUE(scene->primitives.empty());
        EXPECT_EQ(scene->meshes[0].primitive_count, 0u);
        EXPECT_EQ(said_of(*scene), std::vector<std::string>{"mesh \"m\": points and lines are not supported and left out"});
    }
}

TEST(mesh, missing_normals_are_flat)
{
    Asset asset; // two triangles that share an edge at a right angle: six corners, no common vertex
    asset.attribute("POSITION", asset.accessor(floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}), kF32, "VEC3", 4));
    const int indices = asset.accessor(bytes_of<std::uint8_t>({0, 1, 2, 0, 2, 3}), kU8, "SCALAR", 6);
    asset.primitive = R"(,"indices":)" + std::to_string(indices);
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_EQ(scene->vertices.size(), 6u);
    EXPECT_EQ(scene->vertices.nz[scene->indices[0]], 1.0f);
    EXPECT_EQ(scene->vertices.nx[scene->indices[3]], 1.0f);
}

TEST(mesh, normals_are_normalized_and_those_without_length_replaced)
{
    Asset asset = triangle();
    asset.attribute("NORMAL", asset.accessor(floats({0, 0, 0, 0, 3, 0, 1e30f, 0, 0}), kF32, "VEC3", 3));
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_EQ(scene->vertices.nz[scene->indices[0]], 1.0f);
    EXPECT_EQ(scene->vertices.ny[scene->indices[1]], 1.0f);
    EXPECT_EQ(scene->vertices.nx[scene->indices[2]], 1.0f);
    EXPECT_EQ(said_of(*scene).size(), 1u);
}

TEST(mesh, tangents_made_from_texture_coordinates_follow_u_and_the_normal_map_green_points_against_v)
{
    const Result<Scene> scene = load(square());
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_EQ(scene->vertices.size(), 4u); // welded again
    EXPECT_FALSE(scene->primitives[0].has_file_tangents);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(scene->vertices.tx[i], 1.0f, 1e-6f); // u grows with x
        EXPECT_EQ(scene->vertices.tw[i], 1.0f);          // cross(n, t) = +y, where v falls
    }
}

TEST(mesh, mirrored_texture_coordinates_turn_the_handedness)
{
    Asset asset = square();
    const int uv = asset.accessor(floats({1, 1, 0, 1, 0, 0, 1, 0}), kF32, "VEC2", 4); // u = 1 - x
    asset.attributes = R"("POSITION":0,"NORMAL":1,"TEXCOORD_0":)" + std::to_string(uv);
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(scene->vertices.tx[i], -1.0f, 1e-6f);
        EXPECT_EQ(scene->vertices.tw[i], -1.0f);
    }
}

TEST(mesh, tangents_of_the_file_are_kept_orthogonal_and_unit)
{
    Asset asset = square();
    const std::vector<float> tangents = {0, 2, 0, -1, 0, 1, 1, -1, 0, 0, 5, 1, 0, 0, 0, 1};
    asset.attribute("TANGENT", asset.accessor(floats(tangents), kF32, "VEC4", 4));
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene); // also where the file's tangents lie along the normal or have no length
    EXPECT_TRUE(scene->primitives[0].has_file_tangents);
    for (const std::size_t i : {0u, 1u}) {
        EXPECT_EQ(scene->vertices.ty[scene->indices[i]], 1.0f);
        EXPECT_EQ(scene->vertices.tw[scene->indices[i]], -1.0f);
    }
}

TEST(mesh, tangents_without_normals_are_ignored)
{
    Asset asset = triangle();
    asset.attribute("TANGENT", asset.accessor(floats({0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1}), kF32, "VEC4", 3));
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_FALSE(scene->primitives[0].has_file_tangents);
}

TEST(mesh, equal_vertices_are_welded_and_different_ones_are_not)
{
    Asset asset; // the square without indices; one corner differs in colour
    asset.attribute("POSITION", asset.accessor(floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}), kF32, "VEC3", 6));
    asset.attribute("COLOR_0", asset.accessor(floats({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0.5f, 1, 1, 1, 1}), kF32, "VEC3", 6));
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->vertices.size(), 5u);
    EXPECT_EQ(scene->indices[3], scene->indices[0]);
    EXPECT_NE(scene->indices[4], scene->indices[2]);
}

TEST(mesh, vertices_that_differ_in_colour_alone_stay_apart)
{
    Asset asset;
    std::vector<float> positions, colours;
    for (int i = 0; i < 900; ++i) { // enough vertices for colliding hash slots
        positions.insert(positions.end(), {static_cast<float>(i % 3), static_cast<float>(i % 2), 0.0f});
        colours.insert(colours.end(), {static_cast<float>(i) / 900.0f, 0.0f, 0.0f});
    }
    asset.attribute("POSITION", asset.accessor(floats(positions), kF32, "VEC3", 900));
    asset.attribute("COLOR_0", asset.accessor(floats(colours), kF32, "VEC3", 900));
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->vertices.size(), 900u);
}

TEST(mesh, many_vertices_weld_to_the_same_order_as_they_are_first_used)
{
    Asset asset;
    std::vector<float> positions;
    for (int i = 0; i < 6000; ++i) // each triangle twice
        for (const float c : {static_cast<float>(i / 6), static_cast<float>(i % 3), 1.0f})
            positions.push_back(c);
    asset.attribute("POSITION", asset.accessor(floats(positions), kF32, "VEC3", 6000));
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    ASSERT_EQ(scene->vertices.size(), 3000u);
    for (std::uint32_t i = 0; i < 6000; ++i)
        ASSERT_EQ(scene->indices[i], i / 6 * 3 + i % 3);
}

TEST(mesh, vertex_colours_of_every_allowed_type_are_read)
{
    struct Case {
        ByteVector data;
        int component;
        const char* type;
        const char* extra;
    };
    const char* const kNormalized = R"(,"normalized":true)";
    const Case cases[] = {
        {floats({1, 0.2f, 0, 1, 0.2f, 0, 1, 0.2f, 0}), kF32, "VEC3", ""},
        {floats({1, 0.2f, 0, 1, 1, 0.2f, 0, 1, 1, 0.2f, 0, 1}), kF32, "VEC4", ""},
        {bytes_of<std::uint8_t>({255, 51, 0, 0, 255, 51, 0, 0, 255, 51, 0, 0}), kU8, "VEC3", kNormalized}, // stride 4
        {bytes_of<std::uint8_t>({255, 51, 0, 255, 255, 51, 0, 255, 255, 51, 0, 255}), kU8, "VEC4", kNormalized},
        {bytes_of<std::uint16_t>({65535, 13107, 0, 65535, 65535, 13107, 0, 65535, 65535, 13107, 0, 65535}), kU16, "VEC4", kNormalized},
    };
    for (const Case& c : cases) {
        Asset asset = triangle();
        const bool padded = c.component == kU8 && c.type[3] == '3';
        asset.attribute("COLOR_0", asset.accessor(c.data, c.component, c.type, 3, c.extra, padded ? R"(,"byteStride":4)" : ""));
        const Result<Scene> scene = load(asset);
        ASSERT_TRUE(scene) << error_of(scene);
        EXPECT_TRUE(scene->primitives[0].has_color);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(scene->vertices.cr[i], 1.0f);
            EXPECT_NEAR(scene->vertices.cg[i], 0.2f, 1e-7f);
            EXPECT_EQ(scene->vertices.cb[i], 0.0f);
            EXPECT_EQ(scene->vertices.ca[i], 1.0f);
        }
    }
}

TEST(mesh, attributes_that_are_missing_have_their_defaults)
{
    const Result<Scene> scene = load(triangle());
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    const Primitive& p = scene->primitives[0];
    EXPECT_FALSE(p.has_uv0 || p.has_uv1 || p.has_color || p.has_file_tangents);
    EXPECT_EQ(scene->vertices.u0[0], 0.0f);
    EXPECT_EQ(scene->vertices.ca[0], 1.0f);
    ASSERT_EQ(scene->materials.size(), 1u); // the default material
    EXPECT_EQ(p.material, 0);
}

TEST(mesh, a_texture_without_its_coordinates_is_a_warning)
{
    Asset asset = square();
    asset.primitive += R"(,"material":0)";
    asset.more = R"(,"materials":[{"emissiveTexture":{"index":0,"texCoord":1}}],"textures":[{}])";
    EXPECT_EQ(said_of(*load(asset)), std::vector<std::string>{"texture 0 has no image that can be read; left out"});
    asset.more = R"(,"materials":[{"emissiveTexture":{"index":0,"texCoord":1}}],"textures":[{"source":0}],"images":[{"uri":")"
                 R"(data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNocFAAAAIkAOGrWWInAAAAAElFTkSuQmCC"}])";
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(said_of(*scene), std::vector<std::string>{"mesh \"m\": no TEXCOORD_1 for a texture of its material"});
}

TEST(mesh, two_texture_coordinate_sets_are_kept_apart)
{
    Asset asset = triangle();
    asset.attribute("TEXCOORD_0", asset.accessor(floats({0, 0, 1, 0, 0, 1}), kF32, "VEC2", 3));
    asset.attribute("TEXCOORD_1", asset.accessor(floats({2, 2, 3, 2, 2, 3}), kF32, "VEC2", 3));
    asset.attribute("_CUSTOM", 0); // ignored
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_TRUE(scene->primitives[0].has_uv1);
    EXPECT_EQ(scene->vertices.u0[1], 1.0f);
    EXPECT_EQ(scene->vertices.u1[1], 3.0f);
}

TEST(mesh, quantized_positions_are_scaled_by_the_node)
{
    Asset asset;
    asset.attribute("POSITION", asset.accessor(bytes_of<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0}), kI16, "VEC3", 3,
                                               R"(,"normalized":true)", R"(,"byteStride":8)"));
    asset.attribute("NORMAL", asset.accessor(bytes_of<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}), kI8, "VEC3", 3,
                                             R"(,"normalized":true)", R"(,"byteStride":4)"));
    asset.more = R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])";
    asset.node = R"(,"scale":[2,2,2])";
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_EQ(scene->vertices.px[scene->indices[1]], 1.0f);
    EXPECT_EQ(scene->vertices.py[scene->indices[2]], -1.0f);
    EXPECT_EQ(scene->vertices.nz[0], 1.0f);
    EXPECT_EQ(scene->nodes[0].world[0][0], 2.0f);
}

TEST(mesh, a_primitive_without_positions_is_left_out)
{
    Asset asset = triangle();
    asset.attributes = "";
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_TRUE(scene->primitives.empty());
    EXPECT_EQ(said_of(*scene).size(), 1u);
}
