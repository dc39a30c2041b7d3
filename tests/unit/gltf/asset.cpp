#include "asset.h"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

#include "core/scene/gltf/gltf.h"

namespace burnish::test {

std::string base64(const ByteVector& bytes)
{
    static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16;
        if (i + 1 < bytes.size())
            group |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
        if (i + 2 < bytes.size())
            group |= bytes[i + 2];
        for (unsigned k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

int Asset::view(const ByteVector& data, const std::string& extra)
{
    while (bin.size() % 4)
        bin.push_back(0);
    views.push_back(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", bin.size(), data.size(), extra));
    bin.insert(bin.end(), data.begin(), data.end());
    return static_cast<int>(views.size()) - 1;
}

int Asset::accessor(const ByteVector& data, int component, const std::string& type, std::size_t count, const std::string& extra,
                    const std::string& view_extra)
{
    accessors.push_back(fmt::format(R"({{"bufferView":{},"componentType":{},"type":"{}","count":{}{}}})", view(data, view_extra), component,
                                    type, count, extra));
    return static_cast<int>(accessors.size()) - 1;
}

void Asset::attribute(const std::string& name, int accessor_index)
{
    attributes += fmt::format(R"({}"{}":{})", attributes.empty() ? "" : ",", name, accessor_index);
}

std::string Asset::json(const std::string& buffer_uri_member) const
{
    const std::string graph =
        nodes.empty() ? fmt::format(R"(,"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{}}}])", node) : nodes;
    return fmt::format(R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}{}}}],"bufferViews":[{}],)"
                       R"("accessors":[{}],"meshes":[{{"name":"m","primitives":[{{"attributes":{{{}}}{}}}]}}]{}{}}})",
                       bin.size(), buffer_uri_member, fmt::join(views, ","), fmt::join(accessors, ","), attributes, primitive, graph, more);
}

std::string Asset::gltf() const
{
    return json(",\"uri\":\"data:application/octet-stream;base64," + base64(bin) + "\"");
}

ByteVector Asset::glb() const
{
    std::string text = json("");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    ByteVector data = bin;
    data.resize((data.size() + 3) / 4 * 4, 0);
    ByteVector out;
    const auto word = [&](std::size_t value) {
        for (unsigned k = 0; k < 4; ++k)
            out.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
    };
    word(0x46546c67);
    word(2);
    word(12 + 8 + text.size() + 8 + data.size());
    word(text.size());
    word(0x4e4f534a);
    out.insert(out.end(), text.begin(), text.end());
    word(data.size());
    word(0x004e4942);
    out.insert(out.end(), data.begin(), data.end());
    return out;
}

Asset triangle()
{
    Asset asset;
    asset.attribute("POSITION", asset.accessor(floats({0, 0, 0, 1, 0, 0, 0, 1, 0}), kF32, "VEC3", 3, R"(,"min":[0,0,0],"max":[1,1,0])"));
    return asset;
}

Result<Scene> load_text(const std::string& gltf, const Limits& limits)
{
    return load_gltf_bytes(reinterpret_cast<const std::uint8_t*>(gltf.data()), gltf.size(), "test.gltf", limits);
}

Result<Scene> load(const Asset& asset, const Limits& limits)
{
    return load_text(asset.gltf(), limits);
}

std::string error_of(const Result<Scene>& result)
{
    return result ? "" : result.error().place + ": " + result.error().reason;
}

void expect_sound(const Scene& scene)
{
    const VertexTable& v = scene.vertices;
    const Column<float>* const columns[] = {&v.px, &v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.tx, &v.ty, &v.tz,
                                            &v.tw, &v.u0, &v.v0, &v.u1, &v.v1, &v.cr, &v.cg, &v.cb, &v.ca};
    bool finite = true;
    for (const Column<float>* column : columns) {
        ASSERT_EQ(column->size(), v.size());
        for (const float x : *column)
            finite = finite && std::isfinite(x);
    }
    EXPECT_TRUE(finite);
    float off_unit = 0.0f, off_right_angle = 0.0f;
    bool signs = true;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const float n2 = v.nx[i] * v.nx[i] + v.ny[i] * v.ny[i] + v.nz[i] * v.nz[i];
        const float t2 = v.tx[i] * v.tx[i] + v.ty[i] * v.ty[i] + v.tz[i] * v.tz[i];
        off_unit = std::fmax(off_unit, std::fmax(std::fabs(n2 - 1.0f), std::fabs(t2 - 1.0f)));
        const float dot = v.nx[i] * v.tx[i] + v.ny[i] * v.ty[i] + v.nz[i] * v.tz[i];
        off_right_angle = std::fmax(off_right_angle, std::fabs(dot));
        signs = signs && (v.tw[i] == 1.0f || v.tw[i] == -1.0f);
    }
    EXPECT_LT(off_unit, 1e-5f);
    EXPECT_LT(off_right_angle, 1e-5f);
    EXPECT_TRUE(signs);
    for (const Primitive& p : scene.primitives) {
        EXPECT_EQ(p.index_count % 3, 0u);
        ASSERT_LE(std::size_t{p.first_index} + p.index_count, scene.indices.size());
        ASSERT_LE(std::size_t{p.first_vertex} + p.vertex_count, v.size());
        bool inside = true;
        for (std::uint32_t i = 0; i < p.index_count; ++i)
            inside = inside && scene.indices[p.first_index + i] - p.first_vertex < p.vertex_count;
        EXPECT_TRUE(inside);
        ASSERT_LT(static_cast<std::size_t>(p.material), scene.materials.size());
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        EXPECT_LT(scene.nodes[i].parent, static_cast<int>(i));
        EXPECT_LT(scene.nodes[i].mesh, static_cast<int>(scene.meshes.size()));
        EXPECT_LT(scene.nodes[i].light, static_cast<int>(scene.lights.size()));
        EXPECT_LT(scene.nodes[i].camera, static_cast<int>(scene.cameras.size()));
    }
    for (const Mesh& m : scene.meshes)
        EXPECT_LE(m.first_primitive + m.primitive_count, scene.primitives.size());
    for (const Texture& t : scene.textures)
        EXPECT_LT(static_cast<std::size_t>(t.image), scene.images.size());
    EXPECT_FALSE(scene.materials.empty());
}

ByteVector read_bytes(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

} // namespace burnish::test
