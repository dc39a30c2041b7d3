// Bad input: one clear error with a place, in bounded time, and never a crash.
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>
#include <sys/resource.h>
#include <sys/stat.h>

#include "asset.h"
#include "core/base/clock.h"
#include "core/image/io/image_io.h"
#include "core/scene/gltf/gltf.h"

using namespace burnish;
using namespace burnish::test;
namespace fs = std::filesystem;

namespace {

Result<Scene> load_raw(const ByteVector& bytes)
{
    return load_gltf_bytes(bytes.data(), bytes.size(), "raw.glb", {});
}

long peak_kilobytes()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

void expect_clear(const Error& error, const std::string& file)
{
    EXPECT_EQ(error.code, ExitCode::bad_input);
    EXPECT_EQ(error.file, file);
    EXPECT_FALSE(error.reason.empty());
    EXPECT_EQ(error.line().find_first_of("\r\n"), std::string::npos);
}

} // namespace

TEST(bad_input, every_malformed_scene_is_an_error_with_its_place)
{
    int scenes = 0;
    for (const std::string& path : data_files("malformed")) {
        const std::string extension = fs::path(path).extension().string();
        if (extension != ".gltf" && extension != ".glb")
            continue;
        SCOPED_TRACE(path);
        const double begin_ms = process_cpu_ms();
        const Result<Scene> scene = load_scene(path, {});
        EXPECT_LT(process_cpu_ms() - begin_ms, 2000.0);
        ASSERT_FALSE(scene);
        expect_clear(scene.error(), path);
        EXPECT_FALSE(scene.error().place.empty());
        ++scenes;
    }
    EXPECT_GE(scenes, 15);
}

TEST(bad_input, every_malformed_image_is_an_error)
{
    int pictures = 0;
    for (const std::string& path : data_files("malformed")) {
        const std::string extension = fs::path(path).extension().string();
        if (extension != ".png" && extension != ".jpg" && extension != ".exr" && extension != ".hdr")
            continue;
        SCOPED_TRACE(path);
        const Result<Image> image = read_image(path, {});
        ASSERT_FALSE(image);
        expect_clear(image.error(), path);
        ++pictures;
    }
    EXPECT_GE(pictures, 10);
}

TEST(bad_input, paths_that_are_no_readable_file_are_errors)
{
    const TempFolder folder;
    for (const std::string& path :
         {folder.path("missing.gltf"), folder.path("."), std::string(), std::string("/dev/null"), folder.path("missing/folder.glb")}) {
        const Result<Scene> scene = load_scene(path, {});
        ASSERT_FALSE(scene) << path;
        expect_clear(scene.error(), path);
    }
    const std::string pipe = folder.path("pipe.gltf");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_FALSE(load_scene(pipe, {})); // without waiting for a writer
    EXPECT_FALSE(load_scene(folder.write("empty.glb", std::string()), {}));
    EXPECT_EQ(error_of(load_scene(folder.write("blank.gltf", std::string(" \n\t ")), {})), "byte 4: neither glTF JSON nor GLB");
    EXPECT_EQ(error_of(load_scene(folder.write("text.gltf", std::string("hello")), {})), "byte 0: neither glTF JSON nor GLB");
}

TEST(bad_input, files_above_the_size_limit_are_refused)
{
    const TempFolder folder;
    const Asset asset = triangle();
    const std::string path = folder.write("a.gltf", asset.gltf());
    Limits limits;
    limits.file_bytes = asset.gltf().size();
    EXPECT_TRUE(load_gltf(path, limits));
    limits.file_bytes -= 1;
    EXPECT_FALSE(load_gltf(path, limits));
    folder.write("big.bin", std::string(4096, 'x'));
    limits.file_bytes = 4095;
    const Result<Scene> external = load_gltf(folder.write("b.gltf", asset.json(R"(,"uri":"big.bin")")), limits);
    EXPECT_EQ(external.error().place, "/buffers/0/uri");
}

TEST(bad_input, json_errors_name_their_byte)
{
    EXPECT_EQ(load_text(R"({"asset":{"version":"2.0"},})").error().place, "byte 27");
    EXPECT_EQ(load_text("{\"a\":\"\xff\"}").error().place, "byte 6");
    EXPECT_EQ(load_text("{").error().place, "byte 1");
    EXPECT_EQ(load_text("[]").error().place, "byte 0");
    EXPECT_EQ(load_text(R"({"a":1e999})").error().place.substr(0, 4), "byte");
}

TEST(bad_input, deep_nesting_is_refused_before_it_is_parsed)
{
    const std::string deep = R"({"asset":{"version":"2.0"},"extras":)";
    const Result<Scene> scene = load_text(deep + std::string(1000000, '['));
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().place, fmt::format("byte {}", deep.size() + 63)); // the 65th level
    EXPECT_NE(scene.error().reason.find("Limits::json_depth"), std::string::npos);
    Limits limits;
    limits.json_depth = 4;
    EXPECT_TRUE(load_text(deep + "[[\"[[[\"]]}", limits));
    EXPECT_FALSE(load_text(deep + "[[[[]]]]}", limits));
}

TEST(bad_input, version_and_asset_are_needed)
{
    EXPECT_EQ(load_text("{}").error().place, "/");
    EXPECT_EQ(load_text(R"({"asset":{"version":"1.0"}})").error().place, "/asset/version");
    EXPECT_EQ(load_text(R"({"asset":{"version":2}})").error().place, "/asset/version");
    EXPECT_EQ(load_text(R"({"asset":{"version":"2.0","minVersion":"2.1"}})").error().place, "/asset/minVersion");
    EXPECT_EQ(load_text(R"({"asset":{"version":"2.0"},"extensionsUsed":[1]})").error().place, "/extensionsUsed/0");
}

TEST(bad_input, nan_and_infinity_in_attributes_are_errors)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, inf, -inf}) {
        Asset asset;
        asset.attribute("POSITION", asset.accessor(floats({0, 0, 0, 1, 0, 0, 0, bad, 0}), kF32, "VEC3", 3));
        EXPECT_EQ(error_of(load(asset)), "/accessors/0: component 1 of element 2 is NaN or infinite");
        Asset uv = triangle();
        uv.attribute("TEXCOORD_0", uv.accessor(floats({0, 0, 1, 0, bad, 0}), kF32, "VEC2", 3));
        EXPECT_EQ(load(uv).error().place, "/accessors/1");
    }
}

TEST(bad_input, indices_past_the_vertices_are_errors)
{
    Asset asset = triangle();
    asset.primitive = R"(,"indices":)" + std::to_string(asset.accessor(bytes_of<std::uint16_t>({0, 1, 3}), kU16, "SCALAR", 3));
    EXPECT_EQ(error_of(load(asset)), "/meshes/0/primitives/0/indices: index 3 at 2 is not below the vertex count 3");
    Asset floating = triangle();
    floating.primitive = R"(,"indices":)" + std::to_string(floating.accessor(floats({0, 1, 2}), kF32, "SCALAR", 3));
    EXPECT_EQ(error_of(load(floating)), "/meshes/0/primitives/0/indices: accessor 1 is not of unsigned integer scalars");
}

TEST(bad_input, numbers_that_do_not_fit_are_errors_at_their_place)
{
    struct Case {
        const char* accessor;
        const char* place;
    };
    const Case cases[] = {
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":4})", "/accessors/0"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":1431655766})", "/accessors/0"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":4611686018427387904})", "/accessors/0/count"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":9007199254740992})", "/accessors/0"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":0})", "/accessors/0/count"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":-1})", "/accessors/0/count"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":2.5})", "/accessors/0/count"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3"})", "/accessors/0"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"byteOffset":1})", "/accessors/0"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"byteOffset":18446744073709551615})", "/accessors/0/byteOffset"},
        {R"({"bufferView":1,"componentType":5126,"type":"VEC3","count":3})", "/accessors/0/bufferView"},
        {R"({"bufferView":-1,"componentType":5126,"type":"VEC3","count":3})", "/accessors/0/bufferView"},
        {R"({"bufferView":0,"componentType":5124,"type":"VEC3","count":3})", "/accessors/0/componentType"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC5","count":3})", "/accessors/0/type"},
        {R"({"bufferView":0,"componentType":5126,"type":"","count":3})", "/accessors/0/type"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC2","count":3})", "/meshes/0/primitives/0/attributes/POSITION"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"sparse":{"count":4,"indices":{"bufferView":0,)"
         R"("componentType":5121},"values":{"bufferView":0}}})",
         "/accessors/0/sparse/count"},
        {R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"sparse":{"count":1,"indices":{"bufferView":0,)"
         R"("componentType":5121,"byteOffset":36},"values":{"bufferView":0}}})",
         "/accessors/0/sparse/indices"},
        {R"([])", "/accessors/0"},
    };
    for (const Case& c : cases) {
        Asset asset = triangle();
        asset.accessors[0] = c.accessor;
        const Result<Scene> scene = load(asset);
        ASSERT_FALSE(scene) << c.accessor;
        EXPECT_EQ(scene.error().place, c.place) << scene.error().reason;
    }
}

TEST(bad_input, buffer_views_past_their_buffer_are_errors)
{
    for (const char* view : {R"({"buffer":0,"byteLength":37})", R"({"buffer":0,"byteOffset":1,"byteLength":36})",
                             R"({"buffer":0,"byteOffset":9007199254740992,"byteLength":9007199254740992})"}) {
        Asset asset = triangle();
        asset.views[0] = view;
        EXPECT_EQ(load(asset).error().place, "/bufferViews/0") << view;
    }
    Asset strided = triangle();
    strided.views[0] = R"({"buffer":0,"byteLength":36,"byteStride":8})";
    EXPECT_EQ(load(strided).error().place, "/accessors/0");
    strided.views[0] = R"({"buffer":0,"byteLength":36,"byteStride":18})";
    EXPECT_EQ(load(strided).error().place, "/accessors/0");
}

TEST(bad_input, data_uris_are_read_strictly)
{
    const Asset asset = triangle();
    const std::string good = base64(asset.bin);
    const auto load_uri = [&](const std::string& uri, const Limits& limits = {}) {
        return load_text(asset.json(",\"uri\":\"" + uri + "\""), limits);
    };
    EXPECT_TRUE(load_uri("data:;base64," + good));
    EXPECT_TRUE(load_uri("data:application/gltf-buffer;base64," + good));
    for (const std::string& uri :
         {"data:application/octet-stream," + good, std::string("data:"), std::string("data:;base64"), "data:;base64," + good + "=",
          "data:;base64,!" + good.substr(1), "data:;base64,=" + good.substr(1), "data:;base64," + good.substr(4)}) {
        const Result<Scene> scene = load_uri(uri);
        ASSERT_FALSE(scene) << uri;
        EXPECT_EQ(scene.error().place.substr(0, 10), "/buffers/0");
    }
    Limits limits;
    limits.data_uri_bytes = asset.bin.size();
    EXPECT_TRUE(load_uri("data:;base64," + good, limits));
    limits.data_uri_bytes -= 1;
    EXPECT_NE(load_uri("data:;base64," + good, limits).error().reason.find("Limits::data_uri_bytes"), std::string::npos);
}

TEST(bad_input, decoded_vertex_data_above_the_limit_is_refused)
{
    Limits limits;
    limits.accessor_bytes = 3 * 32 + 3 * 72;
    EXPECT_TRUE(load(triangle(), limits));
    limits.accessor_bytes -= 1;
    const Result<Scene> scene = load(triangle(), limits);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().reason.find("Limits::accessor_bytes"), std::string::npos);
}

TEST(bad_input, small_files_cannot_ask_for_gigabytes)
{
    const long before = peak_kilobytes();
    const std::string huge[] = {
        R"({"componentType":5126,"type":"VEC3","count":1000000000})",
        R"({"componentType":5126,"type":"VEC3","count":9007199254740992})",
        R"({"componentType":5126,"type":"VEC3","count":1000000000,"sparse":{"count":1,"indices":{"bufferView":0,)"
        R"("componentType":5121},"values":{"bufferView":0}}})",
    };
    for (const std::string& accessor : huge) {
        Asset asset = triangle();
        asset.accessors[0] = accessor;
        EXPECT_FALSE(load(asset)) << accessor; // as vertices
        Asset indexed = triangle();
        indexed.accessors.push_back(accessor);
        indexed.accessors[1].replace(indexed.accessors[1].find("VEC3"), 4, "SCALAR");
        indexed.accessors[1].replace(indexed.accessors[1].find("5126"), 4, "5125");
        indexed.primitive = R"(,"indices":1)";
        EXPECT_FALSE(load(indexed)) << accessor;
    }
    Asset shared = triangle(); // one large index list in very many primitives
    shared.accessors.push_back(R"({"componentType":5125,"type":"SCALAR","count":900000})");
    std::string primitives = R"({"attributes":{"POSITION":0},"indices":1})";
    for (int i = 0; i < 500; ++i)
        primitives += R"(,{"attributes":{"POSITION":0},"indices":1})";
    shared.attributes = R"("POSITION":0)";
    shared.more = R"(,"meshes":[{"primitives":[)" + primitives + "]}]"; // the later of two equal members counts
    EXPECT_NE(error_of(load(shared)).find("out of proportion"), std::string::npos);
    EXPECT_LT(peak_kilobytes() - before, 1000000);
}

TEST(bad_input, glb_chunks_must_be_in_order_and_whole)
{
    const ByteVector good = triangle().glb();
    ASSERT_TRUE(load_raw(good));
    const auto changed = [&](std::size_t at, std::uint8_t value) {
        ByteVector bytes = good;
        bytes[at] = value;
        return load_raw(bytes);
    };
    EXPECT_EQ(changed(4, 1).error().place, "byte 4");                                      // version
    EXPECT_EQ(changed(8, static_cast<std::uint8_t>(good[8] + 4)).error().place, "byte 8"); // length
    EXPECT_EQ(changed(12, static_cast<std::uint8_t>(good[12] + 1)).error().place,
              "byte 12");                                  // chunk length not a multiple of 4
    EXPECT_EQ(changed(15, 0x7f).error().place, "byte 12"); // chunk past the file
    EXPECT_EQ(changed(16, 'B').error().place, "byte 12");  // first chunk not JSON
}

TEST(bad_input, a_file_cut_at_any_byte_is_an_error)
{
    const ByteVector good = triangle().glb();
    for (std::size_t size = 0; size < good.size(); ++size) {
        const Result<Scene> scene = load_raw(ByteVector(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
        ASSERT_FALSE(scene) << size;
        ASSERT_FALSE(scene.error().place.empty()) << size;
    }
    const std::string text = triangle().gltf();
    for (std::size_t size = 0; size < text.size(); ++size)
        ASSERT_FALSE(load_text(text.substr(0, size))) << size;
}

TEST(bad_input, names_of_the_file_reach_messages_without_control_characters)
{
    const Result<Scene> scene = load_text(R"({"asset":{"version":"2.0"},"extensionsRequired":["a\nb\u001b[31m"]})");
    ASSERT_FALSE(scene);
    for (const char c : scene.error().reason)
        EXPECT_GE(static_cast<unsigned char>(c), 0x20);
    const Result<Scene> long_name = load_text(R"({"asset":{"version":"2.0"},"extensionsRequired":[")" + std::string(100000, 'x') + "\"]}");
    EXPECT_LT(long_name.error().line().size(), 400u);
}
