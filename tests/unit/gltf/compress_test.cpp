// EXT_meshopt_compression and its filters. The models test KHR_draco_mesh_compression.
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "asset.h"
#include "core/scene/gltf/filters.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;

namespace {

// Returns unit vectors spread over the sphere, four floats each.
std::vector<float> sphere_vectors(int n)
{
    std::vector<float> v;
    for (int i = 0; i < n; ++i) {
        const float z = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(n);
        const float r = std::sqrt(1.0f - z * z), angle = 2.4f * static_cast<float>(i);
        v.insert(v.end(), {r * std::cos(angle), r * std::sin(angle), z, i % 2 ? 1.0f : -1.0f});
    }
    return v;
}

ByteVector encoded_vertices(const ByteVector& vertices, std::size_t count, std::size_t stride)
{
    ByteVector out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), vertices.data(), count, stride));
    return out;
}

ByteVector encoded_indices(const std::vector<std::uint32_t>& indices)
{
    ByteVector out(meshopt_encodeIndexBufferBound(indices.size(), 100));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
    return out;
}

// Returns a square with compressed positions and indices. `from` and `to` edit the positions' extension.
Asset compressed_square(const std::string& from = "", const std::string& to = "")
{
    Asset asset;
    const auto add_view = [&](const ByteVector& data, std::size_t stride, std::size_t count, const char* mode) {
        asset.view(data);
        const std::size_t begin = asset.bin.size() - data.size();
        std::string view =
            fmt::format(R"({{"buffer":0,"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteOffset":{},)"
                        R"("byteLength":{},"byteStride":{},"count":{},"mode":"{}"}}}}}})",
                        stride * count, begin, data.size(), stride, count, mode);
        if (const std::size_t at = view.find(from); !from.empty() && at != std::string::npos && asset.views.size() == 1)
            view.replace(at, from.size(), to);
        asset.views.back() = view;
    };
    add_view(encoded_vertices(floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), 4, 12), 12, 4, "ATTRIBUTES");
    add_view(encoded_indices({0, 1, 2, 0, 2, 3}), 2, 6, "TRIANGLES");
    asset.accessors = {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":4})",
                       R"({"bufferView":1,"componentType":5123,"type":"SCALAR","count":6})"};
    asset.attribute("POSITION", 0);
    asset.primitive = R"(,"indices":1)";
    asset.more = R"(,"extensionsRequired":["EXT_meshopt_compression"])";
    return asset;
}

} // namespace

TEST(meshopt, compressed_positions_and_indices_are_decoded)
{
    const Result<Scene> scene = load(compressed_square());
    ASSERT_TRUE(scene) << error_of(scene);
    expect_sound(*scene);
    EXPECT_EQ(scene->indices.size(), 6u);
    EXPECT_EQ(scene->vertices.size(), 4u);
    float area = 0.0f;
    for (std::size_t i = 0; i < 6; i += 3) {
        const auto x = [&](std::size_t k) { return scene->vertices.px[scene->indices[i + k]]; };
        const auto y = [&](std::size_t k) { return scene->vertices.py[scene->indices[i + k]]; };
        area += 0.5f * ((x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0)));
    }
    EXPECT_EQ(area, 1.0f);
}

TEST(meshopt, sizes_that_do_not_hold_together_are_errors_before_anything_is_decoded)
{
    const std::pair<const char*, const char*> changes[] = {
        {R"("count":4)", R"("count":5)"},
        {R"("byteStride":12)", R"("byteStride":6)"},
        {R"("byteStride":12,"count":4)", R"("byteStride":6,"count":8)"},
        {R"("mode":"ATTRIBUTES")", R"("mode":"TRIANGLES")"},
        {R"("mode":"ATTRIBUTES")", R"("mode":"ATTRIBUTES","filter":"QUATERNION")"},
        {R"("mode":"ATTRIBUTES")", R"("mode":"ATTRIBUTES","filter":"OCTAHEDRAL")"},
        {R"("mode":"ATTRIBUTES")", R"("mode":"ELSE")"},
        {R"("byteOffset":0)", R"("byteOffset":100000)"},
        {R"("byteOffset":0)", R"("byteOffset":9007199254740992)"},
    };
    for (const auto& [from, to] : changes) {
        const Result<Scene> scene = load(compressed_square(from, to));
        ASSERT_FALSE(scene) << to;
        EXPECT_EQ(scene.error().place.substr(0, 49), "/bufferViews/0/extensions/EXT_meshopt_compression") << error_of(scene);
    }
}

TEST(meshopt, a_count_that_the_bytes_cannot_hold_takes_no_memory)
{
    Asset asset = compressed_square();
    const std::string view = asset.views[0];
    for (const auto& [stride, count] : {std::pair<std::uint64_t, std::uint64_t>{12, 1ull << 40}, {256, 1ull << 30}}) {
        asset.views[0] =
            fmt::format(R"({{"buffer":0,"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteLength":30,)"
                        R"("byteStride":{},"count":{},"mode":"ATTRIBUTES"}}}}}})",
                        stride * count, stride, count);
        EXPECT_NE(error_of(load(asset)).find("cannot be stored"), std::string::npos);
    }
}

TEST(meshopt, damaged_data_is_an_error)
{
    Asset asset = compressed_square();
    asset.bin[0] ^= 0xff; // the header byte of the vertex codec
    EXPECT_EQ(error_of(load(asset)), "/bufferViews/0/extensions/EXT_meshopt_compression: the compressed data is damaged");
}

TEST(meshopt_filter, octahedral_vectors_agree_with_the_library_within_a_unit)
{
    constexpr int kCount = 1000;
    const std::vector<float> vectors = sphere_vectors(kCount);
    for (const int bits : {4, 8, 12, 16}) {
        for (const std::size_t stride : {4u, 8u}) {
            if (stride == 4 && bits > 8)
                continue;
            ByteVector ours(kCount * stride), theirs;
            meshopt_encodeFilterOct(ours.data(), kCount, stride, bits, vectors.data());
            theirs = ours;
            gltf::filter_octahedral(ours.data(), kCount, stride);
            meshopt_decodeFilterOct(theirs.data(), kCount, stride);
            for (std::size_t i = 0; i < ours.size(); i += stride / 4) {
                if (stride == 4) {
                    ASSERT_NEAR(static_cast<std::int8_t>(ours[i]), static_cast<std::int8_t>(theirs[i]), 1) << i;
                } else {
                    std::int16_t a, b;
                    std::memcpy(&a, &ours[i], 2);
                    std::memcpy(&b, &theirs[i], 2);
                    ASSERT_NEAR(a, b, i % 8 == 6 ? 0 : 8) << i; // the library's estimate has 12 bits
                }
            }
        }
    }
}

TEST(meshopt_filter, quaternions_agree_with_the_library_within_a_unit)
{
    constexpr int kCount = 1000;
    std::vector<float> vectors = sphere_vectors(kCount);
    for (std::size_t i = 0; i < vectors.size(); i += 4)
        for (std::size_t k = 0; k < 4; ++k)
            vectors[i + k] *= std::sqrt(0.5f); // three components of a unit vector and a sign: a unit quaternion
    for (const int bits : {4, 10, 16}) {
        ByteVector ours(kCount * 8), theirs;
        meshopt_encodeFilterQuat(ours.data(), kCount, 8, bits, vectors.data());
        theirs = ours;
        gltf::filter_quaternion(ours.data(), kCount);
        meshopt_decodeFilterQuat(theirs.data(), kCount, 8);
        for (std::size_t i = 0; i < ours.size(); i += 2) {
            std::int16_t a, b;
            std::memcpy(&a, &ours[i], 2);
            std::memcpy(&b, &theirs[i], 2);
            ASSERT_NEAR(a, b, 1) << i;
        }
    }
}

TEST(meshopt_filter, exponential_floats_equal_the_library)
{
    std::vector<float> values = sphere_vectors(500);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] *= std::ldexp(1.0f, static_cast<int>(i % 60) - 30);
    ByteVector ours(values.size() * 4), theirs;
    meshopt_encodeFilterExp(ours.data(), values.size(), 4, 15, values.data());
    theirs = ours;
    gltf::filter_exponential(ours.data(), values.size());
    meshopt_decodeFilterExp(theirs.data(), values.size(), 4);
    EXPECT_EQ(ours, theirs);
}

TEST(meshopt_filter, any_bytes_decode_without_undefined_behaviour)
{
    std::uint32_t state = 1;
    ByteVector bytes(8 * 4096);
    for (std::uint8_t& b : bytes)
        b = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
    ByteVector copy = bytes;
    gltf::filter_octahedral(copy.data(), copy.size() / 4, 4);
    copy = bytes;
    gltf::filter_octahedral(copy.data(), copy.size() / 8, 8);
    copy = bytes;
    gltf::filter_quaternion(copy.data(), copy.size() / 8);
    copy = bytes;
    gltf::filter_exponential(copy.data(), copy.size() / 4);
    EXPECT_NE(copy, bytes);
}
