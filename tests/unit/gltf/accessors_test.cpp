// Accessors: component types, normalization, strides, sparse values, and the views themselves.
#include <gtest/gtest.h>

#include "asset.h"
#include "core/scene/gltf/views.h"

using namespace burnish;
using namespace burnish::test;
using gltf::AccessorView;
using gltf::ComponentType;

namespace {

// Loads a triangle whose TEXCOORD_0 has the given accessor. Returns u and v of its three corners.
std::vector<float> uvs_of(const ByteVector& data, int component, const std::string& extra)
{
    Asset asset = triangle();
    asset.attribute("TEXCOORD_0", asset.accessor(data, component, "VEC2", 3, extra));
    const Result<Scene> scene = load(asset);
    EXPECT_TRUE(scene) << error_of(scene);
    if (!scene)
        return {};
    EXPECT_EQ(scene->vertices.size(), 3u);
    std::vector<float> uv;
    for (std::size_t i = 0; i < scene->indices.size(); ++i)
        uv.insert(uv.end(), {scene->vertices.u0[scene->indices[i]], scene->vertices.v0[scene->indices[i]]});
    return uv;
}

const std::string kNormalized = R"(,"normalized":true)";

} // namespace

TEST(accessors, float_components_are_taken_as_they_are)
{
    EXPECT_EQ(uvs_of(floats({0, 0.25f, 3, -1, 0.5f, 1e-30f}), kF32, ""), (std::vector<float>{0, 0.25f, 3, -1, 0.5f, 1e-30f}));
}

TEST(accessors, integer_components_are_converted_to_their_value)
{
    EXPECT_EQ(uvs_of(bytes_of<std::int8_t>({0, 1, 2, -128, 127, 3}), kI8, ""), (std::vector<float>{0, 1, 2, -128, 127, 3}));
    EXPECT_EQ(uvs_of(bytes_of<std::uint8_t>({0, 1, 2, 255, 127, 3}), kU8, ""), (std::vector<float>{0, 1, 2, 255, 127, 3}));
    EXPECT_EQ(uvs_of(bytes_of<std::int16_t>({0, 1, 2, -32768, 32767, 3}), kI16, ""), (std::vector<float>{0, 1, 2, -32768, 32767, 3}));
    EXPECT_EQ(uvs_of(bytes_of<std::uint16_t>({0, 1, 2, 65535, 32767, 3}), kU16, ""), (std::vector<float>{0, 1, 2, 65535, 32767, 3}));
    EXPECT_EQ(uvs_of(bytes_of<std::uint32_t>({0, 1, 2, 70000, 5, 3}), kU32, ""), (std::vector<float>{0, 1, 2, 70000, 5, 3}));
}

TEST(accessors, normalized_integers_map_to_zero_one_or_minus_one_one)
{
    EXPECT_EQ(uvs_of(bytes_of<std::int8_t>({0, 127, -127, -128, 64, 1}), kI8, kNormalized),
              (std::vector<float>{0, 1, -1, -1, 64 / 127.0f, 1 / 127.0f}));
    EXPECT_EQ(uvs_of(bytes_of<std::uint8_t>({0, 255, 128, 1, 2, 3}), kU8, kNormalized),
              (std::vector<float>{0, 1, 128 / 255.0f, 1 / 255.0f, 2 / 255.0f, 3 / 255.0f}));
    EXPECT_EQ(uvs_of(bytes_of<std::int16_t>({0, 32767, -32767, -32768, 1, 2}), kI16, kNormalized),
              (std::vector<float>{0, 1, -1, -1, 1 / 32767.0f, 2 / 32767.0f}));
    EXPECT_EQ(uvs_of(bytes_of<std::uint16_t>({0, 65535, 1, 2, 3, 4}), kU16, kNormalized),
              (std::vector<float>{0, 1, 1 / 65535.0f, 2 / 65535.0f, 3 / 65535.0f, 4 / 65535.0f}));
}

TEST(accessors, interleaved_attributes_share_one_buffer_view)
{
    Asset asset;
    // Position, then texture coordinates, 20 bytes a vertex.
    const int view = asset.view(floats({0, 0, 0, 0.1f, 0.2f, 1, 0, 0, 0.3f, 0.4f, 0, 1, 0, 0.5f, 0.6f}), R"(,"byteStride":20)");
    asset.accessors = {R"({"bufferView":)" + std::to_string(view) + R"(,"componentType":5126,"type":"VEC3","count":3})",
                       R"({"bufferView":)" + std::to_string(view) + R"(,"byteOffset":12,"componentType":5126,"type":"VEC2","count":3})"};
    asset.attribute("POSITION", 0);
    asset.attribute("TEXCOORD_0", 1);
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    const std::uint32_t last = scene->indices[2];
    EXPECT_EQ(scene->vertices.py[last], 1.0f);
    EXPECT_EQ(scene->vertices.u0[last], 0.5f);
    EXPECT_EQ(scene->vertices.v0[last], 0.6f);
}

TEST(accessors, sparse_values_replace_those_of_the_base)
{
    for (const int index_type : {kU8, kU16, kU32}) {
        Asset asset;
        const ByteVector indices = index_type == kU8    ? bytes_of<std::uint8_t>({1, 2})
                                   : index_type == kU16 ? bytes_of<std::uint16_t>({1, 2})
                                                        : bytes_of<std::uint32_t>({1, 2});
        const int where = asset.view(indices), what = asset.view(floats({5, 0, 0, 0, 7, 0}));
        const std::string sparse = R"(,"sparse":{"count":2,"indices":{"bufferView":)" + std::to_string(where) + R"(,"componentType":)" +
                                   std::to_string(index_type) + R"(},"values":{"bufferView":)" + std::to_string(what) + "}}";
        asset.attribute("POSITION", asset.accessor(floats({0, 0, 1, 1, 1, 1, 2, 2, 2}), kF32, "VEC3", 3, sparse));
        const Result<Scene> scene = load(asset);
        ASSERT_TRUE(scene) << error_of(scene);
        const VertexTable& v = scene->vertices;
        EXPECT_EQ(v.pz[scene->indices[0]], 1.0f);
        EXPECT_EQ(v.px[scene->indices[1]], 5.0f);
        EXPECT_EQ(v.py[scene->indices[2]], 7.0f);
        EXPECT_EQ(v.pz[scene->indices[2]], 0.0f);
    }
}

TEST(accessors, sparse_values_stand_alone_over_zeros)
{
    Asset asset;
    const int where = asset.view(bytes_of<std::uint16_t>({2})), what = asset.view(floats({3, 4, 5}));
    asset.accessors.push_back(R"({"componentType":5126,"type":"VEC3","count":3,"sparse":{"count":1,"indices":{"bufferView":)" +
                              std::to_string(where) + R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(what) + "}}}");
    asset.attribute("POSITION", 0);
    const Result<Scene> scene = load(asset);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->vertices.px[scene->indices[0]], 0.0f);
    EXPECT_EQ(scene->vertices.py[scene->indices[2]], 4.0f);
}

TEST(accessors, sparse_indices_out_of_order_or_range_are_errors)
{
    for (const std::vector<std::uint16_t>& indices : {std::vector<std::uint16_t>{1, 1}, {2, 1}, {1, 3}}) {
        Asset asset;
        const int where = asset.view(bytes_of(indices)), what = asset.view(floats({5, 0, 0, 0, 7, 0}));
        asset.attribute("POSITION", asset.accessor(floats({0, 0, 1, 1, 1, 1, 2, 2, 2}), kF32, "VEC3", 3,
                                                   R"(,"sparse":{"count":2,"indices":{"bufferView":)" + std::to_string(where) +
                                                       R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(what) + "}}"));
        const Result<Scene> scene = load(asset);
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().place, "/accessors/0/sparse/indices");
    }
}

TEST(accessors, indices_of_every_unsigned_type_are_read)
{
    for (const int type : {kU8, kU16, kU32}) {
        Asset asset = triangle();
        const ByteVector data = type == kU8    ? bytes_of<std::uint8_t>({2, 0, 1})
                                : type == kU16 ? bytes_of<std::uint16_t>({2, 0, 1})
                                               : bytes_of<std::uint32_t>({2, 0, 1});
        asset.primitive = R"(,"indices":)" + std::to_string(asset.accessor(data, type, "SCALAR", 3));
        const Result<Scene> scene = load(asset);
        ASSERT_TRUE(scene) << error_of(scene);
        EXPECT_EQ(scene->vertices.py[scene->indices[0]], 1.0f);
        EXPECT_EQ(scene->vertices.px[scene->indices[2]], 1.0f);
    }
}

TEST(accessor_view, never_reaches_past_its_bytes_whatever_the_numbers)
{
    const ByteVector bytes(36);
    const auto make = [&](std::uint64_t offset, std::uint64_t stride, std::uint64_t count) {
        return AccessorView::make(bytes, offset, stride, count, ComponentType::f32, {3, 1}, false).has_value();
    };
    EXPECT_TRUE(make(0, 0, 3));
    EXPECT_TRUE(make(0, 12, 3));
    EXPECT_TRUE(make(24, 0, 1));
    EXPECT_TRUE(make(0, 24, 2)); // the last element ends before its stride
    EXPECT_FALSE(make(0, 0, 4));
    EXPECT_FALSE(make(1, 0, 3));
    EXPECT_FALSE(make(25, 0, 1));
    EXPECT_FALSE(make(36, 0, 1));
    EXPECT_FALSE(make(0, 8, 2)); // elements would overlap
    EXPECT_FALSE(make(0, 0, 0));
    EXPECT_FALSE(make(UINT64_MAX, 0, 1));
    EXPECT_FALSE(make(UINT64_MAX - 11, 12, 2));
    EXPECT_FALSE(make(0, 0, UINT64_MAX));
    EXPECT_FALSE(make(0, 12, UINT64_MAX / 12 + 2));
    EXPECT_FALSE(make(0, UINT64_MAX, 2));
    EXPECT_FALSE(make(0, 1ull << 63, 3));
}

TEST(accessor_view, columns_of_small_matrices_start_at_multiples_of_four_bytes)
{
    const ByteVector bytes = {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0};
    const auto view = AccessorView::make(bytes, 0, 0, 1, ComponentType::u8, {3, 3}, false);
    ASSERT_TRUE(view);
    for (int c = 0; c < 9; ++c)
        EXPECT_EQ(view->number(0, c), static_cast<float>(c + 1));
    EXPECT_EQ(gltf::element_bytes(ComponentType::u8, {2, 2}), 8u);
    EXPECT_EQ(gltf::element_bytes(ComponentType::i16, {3, 3}), 24u);
    EXPECT_EQ(gltf::element_bytes(ComponentType::f32, {4, 4}), 64u);
    EXPECT_EQ(gltf::element_bytes(ComponentType::u8, {3, 1}), 3u);
}
