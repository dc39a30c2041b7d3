// Pictures of materials by several threads: scenes, warnings, files and errors equal one thread's.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <stop_token>
#include <tuple>

#include "core/image/io/image_io.h"
#include "core/jobs/control.h"
#include "core/jobs/jobs.h"
#include "core/scene/builtin/builtin.h"
#include "core/scene/gltf/gltf.h"
#include "core/scene/material_overrides.h"
#include "core/scene/mtlx/mtlx.h"
#include "core/scene/obj/obj.h"
#include "core/scene/pictures_ahead.h"
#include "tests/unit/temp_folder.h"

using namespace burnish;
using namespace burnish::test;

namespace {

// Writes a picture with texels of its own. OpenEXR gets channels without usual names, and some negative values: both give warnings.
void write_speckled(const std::string& path, int width, int height)
{
    const bool floats = stores_floats(path);
    Image image = make_image(width, height, 3, floats ? PixelType::f32 : PixelType::u8);
    for (std::size_t k = 0; k < static_cast<std::size_t>(3 * width * height); ++k) {
        const std::size_t code = (k * k + 7 * k + static_cast<std::size_t>(13 * width + height)) % 256;
        if (floats)
            image.f32()[k] = static_cast<float>(code) / 255.0f - 0.1f;
        else
            image.bytes[k] = static_cast<std::byte>(code);
    }
    ASSERT_TRUE(floats ? write_channels(path, image, {"u", "v", "w"}) : write_image(path, image));
}

void cut_in_half(const std::string& path)
{
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
}

// Reads by one thread and by four, and compares. Returns the result of one.
using SceneReader = std::function<Result<Scene>(const Limits&, const Jobs*)>;
Result<Scene> read_alike(const SceneReader& read, const Limits& limits, const std::string& what)
{
    const Jobs four(4);
    Result<Scene> one = read(limits, nullptr);
    const Result<Scene> many = read(limits, &four);
    EXPECT_EQ(one ? "" : one.error().line(), many ? "" : many.error().line()) << what;
    if (!one || !many)
        return one;
    EXPECT_EQ(one->warnings, many->warnings) << what;
    EXPECT_EQ(one->files, many->files) << what;
    EXPECT_EQ(one->textures.size(), many->textures.size()) << what;
    EXPECT_EQ(one->images.size(), many->images.size()) << what;
    for (std::size_t i = 0; i < std::min(one->images.size(), many->images.size()); ++i)
        EXPECT_EQ(one->images[i].bytes, many->images[i].bytes) << what << i;
    return one;
}

// Compares the threads with all pictures, with limits around what these need, and with faults in the second picture and a later one.
void expect_same_by_threads(const SceneReader& read, const std::string& second, const std::string& later)
{
    const Result<Scene> whole = read_alike(read, {}, "all");
    ASSERT_TRUE(whole) << whole.error().line();
    EXPECT_GE(whole->images.size(), 3u);
    EXPECT_GE(whole->warnings.size(), 2u);
    std::uint64_t bytes = 0;
    for (const Image& image : whole->images)
        bytes += image.bytes.size();
    for (const std::uint64_t limit : {bytes, bytes - 1, bytes / 2, std::uint64_t{1}}) {
        Limits limits;
        limits.texture_bytes = limit;
        EXPECT_EQ(static_cast<bool>(read_alike(read, limits, "a limit of " + std::to_string(limit))), limit == bytes) << limit;
    }
    cut_in_half(later);
    EXPECT_FALSE(read_alike(read, {}, "a later picture with a fault"));
    cut_in_half(second);
    const Result<Scene> faulty = read_alike(read, {}, "two pictures with faults");
    ASSERT_FALSE(faulty);
    EXPECT_EQ(faulty.error().file, second);
}

TEST(pictures_ahead, materials_of_obj_files_are_the_same_by_any_number_of_threads)
{
    const TempFolder folder;
    int side = 5;
    for (const char* name : {"heights.png", "colour.png", "light.exr", "specular.png", "normals.png", "sheen.png", "metal.png", "rough.png",
                             "exponents.png", "lamp.png", "gloss.png"})
        write_speckled(folder.path(name), side, 20 - side), ++side;
    folder.write("a.mtl",
                 "newmtl a\nmap_Kd colour.png\nmap_Ke light.exr\nmap_Ks specular.png\nnorm normals.png\nmap_Ps sheen.png\n"
                 "map_Pm metal.png\nmap_Pr rough.png\nnewmtl b\nmap_Kd none.png\nbump heights.png\nNs 490\nmap_Ns exponents.png\n");
    folder.write("b.mtl", "newmtl c\nmap_Kd colour.png\nmap_Ke lamp.png\nmap_Ks gloss.png\n");
    folder.write("a.obj", "mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/3\n");
    const auto read = [&](const Limits& limits, const Jobs* jobs) { return load_scene(folder.path("a.obj"), limits, {}, jobs); };
    expect_same_by_threads(read, folder.path("light.exr"), folder.path("lamp.png"));
}

// A bump map that cannot be read is left out, and no error.
TEST(pictures_ahead, a_bump_map_with_a_fault_is_left_out_by_any_number_of_threads)
{
    const TempFolder folder;
    for (const char* name : {"colour.png", "heights.png", "light.png"})
        write_speckled(folder.path(name), 9, 8);
    cut_in_half(folder.path("heights.png"));
    folder.write("a.mtl", "newmtl a\nmap_Kd colour.png\nbump heights.png\nmap_Ke light.png\n");
    folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/3\n");
    const Result<Scene> scene =
        read_alike([&](const Limits& limits, const Jobs* jobs) { return load_obj(folder.path("a.obj"), limits, jobs); }, {}, "bump");
    ASSERT_TRUE(scene) << scene.error().line();
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_NE(scene->warnings[0].find("is left out"), std::string::npos) << scene->warnings[0];
}

TEST(pictures_ahead, materialx_files_are_the_same_by_any_number_of_threads)
{
    const TempFolder folder;
    std::string graph, inputs;
    int side = 5;
    for (const auto& [input, file, stored, type, space] :
         {std::tuple{"base_color", "base.png", "color3", "color3", "srgb_texture"},
          std::tuple{"emissive", "light.exr", "color3", "color3", "lin_rec709"},
          std::tuple{"occlusion", "shade.png", "vector3", "float", "raw"}, std::tuple{"normal", "normals.png", "vector3", "vector3", "raw"},
          std::tuple{"metallic", "metal.png", "vector3", "float", "raw"},
          std::tuple{"roughness", "rough.png", "vector3", "float", "raw"}}) {
        const std::string name = input, node = name == "normal" ? "mapped" : name + "_picture";
        write_speckled(folder.path(file), side, 3 + side), ++side;
        graph += "<image name=\"" + name + "_picture\" type=\"" + stored + "\"><input name=\"file\" type=\"filename\" value=\"" + file +
                 "\" colorspace=\"" + space + "\"/></image><output name=\"" + name + "_out\" type=\"" + type + "\" nodename=\"" + node +
                 "\"/>";
        inputs += "<input name=\"" + name + "\" type=\"" + type + "\" nodegraph=\"G\" output=\"" + name + "_out\"/>";
    }
    graph += "<normalmap name=\"mapped\" type=\"vector3\"><input name=\"in\" type=\"vector3\" nodename=\"normal_picture\"/></normalmap>";
    folder.write("a.mtlx", "<?xml version=\"1.0\"?><materialx version=\"1.39\"><nodegraph name=\"G\">" + graph +
                               "</nodegraph><gltf_pbr name=\"S\" type=\"surfaceshader\">" + inputs +
                               "</gltf_pbr><surfacematerial name=\"M\" type=\"material\"><input name=\"surfaceshader\" "
                               "type=\"surfaceshader\" nodename=\"S\"/></surfacematerial></materialx>");
    const auto read = [&](const Limits& limits, const Jobs* jobs) -> Result<Scene> {
        Scene scene = *make_builtin_scene("sphere");
        BN_TRY(apply_mtlx(scene, folder.path("a.mtlx"), limits, jobs));
        return scene;
    };
    expect_same_by_threads(read, folder.path("light.exr"), folder.path("rough.png"));
}

TEST(pictures_ahead, overrides_of_materials_are_the_same_by_any_number_of_threads)
{
    const TempFolder folder;
    int side = 5;
    for (const char* name : {"folder/albedo.exr", "folder/ao.png", "folder/metallic.png", "folder/roughness.png", "folder/normal.png",
                             "folder/rotation.png", "folder/height.png", "folder/other.png", "maps/r.png", "maps/n.png", "maps/h.png"}) {
        std::filesystem::create_directories(std::filesystem::path(folder.path(name)).parent_path());
        write_speckled(folder.path(name), side, 20 - side), ++side;
    }
    MaterialOverrides with;
    with.material = folder.path("folder");
    with.roughness = folder.path("maps/r.png"), with.normal = folder.path("maps/n.png"), with.height = folder.path("maps/h.png");
    const auto read = [&](const Limits& limits, const Jobs* jobs) -> Result<Scene> {
        Scene scene = *make_builtin_scene("sphere");
        BN_TRY(apply_material_overrides(scene, with, limits, jobs));
        return scene;
    };
    expect_same_by_threads(read, folder.path("folder/ao.png"), folder.path("maps/n.png"));
    // One file for two parts
    with = MaterialOverrides();
    with.roughness = folder.path("maps/r.png"), with.normal = with.height = folder.path("maps/h.png");
    const Result<Scene> shared = read_alike(read, {}, "one file");
    ASSERT_TRUE(shared) << shared.error().line();
    EXPECT_EQ(shared->files.size(), 3u);
}

// Three pictures of 300 bytes.
struct ThreePictures {
    TempFolder folder;
    Limits limits{};
    Jobs jobs{4};
    std::vector<PicturesAhead::Wanted> wanted{};

    ThreePictures()
    {
        for (const char* name : {"a.png", "b.png", "c.png"}) {
            write_speckled(folder.path(name), 10, 10);
            wanted.push_back({folder.path(name), false});
        }
    }
    void remove_files() const
    {
        for (const PicturesAhead::Wanted& each : wanted)
            std::filesystem::remove(each.path);
    }
    int held_by(PicturesAhead& ahead) const
    {
        int held = 0;
        for (const PicturesAhead::Wanted& each : wanted) {
            PictureNotes notes;
            held += static_cast<bool>(ahead.read(each.path, each.colours, limits, notes));
        }
        return held;
    }
};

TEST(pictures_ahead, each_is_held_once)
{
    ThreePictures three;
    if (three.jobs.threads() < 2)
        GTEST_SKIP() << "the system gives no threads";
    write_speckled(three.folder.path("d.exr"), 4, 4);
    for (const bool colours : {false, true, true})
        three.wanted.push_back({three.folder.path("d.exr"), colours});
    PictureNotes now, ahead_of_time, unread;
    const Result<Image> image = read_colours(three.folder.path("d.exr"), three.limits, now);
    ASSERT_TRUE(image) << image.error().line();
    EXPECT_EQ(now.warnings.size(), 1u);
    PicturesAhead ahead(three.wanted, three.limits, &three.jobs);
    three.remove_files();
    const Result<Image> held = ahead.read(three.folder.path("d.exr"), true, three.limits, ahead_of_time);
    ASSERT_TRUE(held) << held.error().line();
    EXPECT_EQ(held->bytes, image->bytes);
    EXPECT_EQ(ahead_of_time.warnings, now.warnings);
    EXPECT_FALSE(ahead.read(three.folder.path("d.exr"), true, three.limits, unread)) << "it was handed out";
    EXPECT_EQ(three.held_by(ahead), 4); // three pictures, and the fourth as data
    EXPECT_EQ(three.held_by(ahead), 0);
}

TEST(pictures_ahead, nothing_is_held_without_threads_or_for_one_picture)
{
    ThreePictures three;
    const Jobs one(1);
    PicturesAhead none(three.wanted, three.limits, nullptr), single(three.wanted, three.limits, &one),
        lone({three.wanted[0], three.wanted[0]}, three.limits, &three.jobs), empty({}, three.limits, &three.jobs);
    three.remove_files();
    for (PicturesAhead* ahead : {&none, &single, &lone, &empty})
        EXPECT_EQ(three.held_by(*ahead), 0);
}

TEST(pictures_ahead, what_is_held_fits_into_the_limits)
{
    ThreePictures three;
    if (three.jobs.threads() < 2)
        GTEST_SKIP() << "the system gives no threads";
    Limits of_one, of_files;
    of_one.texture_bytes = 599;
    of_files.input_bytes = std::filesystem::file_size(three.wanted[0].path) + std::filesystem::file_size(three.wanted[1].path);
    PicturesAhead all(three.wanted, three.limits, &three.jobs), first(three.wanted, of_one, &three.jobs),
        two(three.wanted, of_files, &three.jobs);
    // A picture that no longer fits is read again, and reading gives the error
    Limits rest;
    rest.texture_bytes = 299;
    PictureNotes notes;
    const Result<Image> late = all.read(three.wanted[0].path, false, rest, notes), now = read_image(three.wanted[0].path, rest);
    ASSERT_FALSE(late);
    ASSERT_FALSE(now);
    EXPECT_EQ(late.error().line(), now.error().line());
    three.remove_files();
    EXPECT_EQ(three.held_by(all), 2);
    EXPECT_EQ(three.held_by(first), 1);
    EXPECT_EQ(three.held_by(two), 2);
}

TEST(pictures_ahead, a_stop_is_an_error)
{
    ThreePictures three;
    three.folder.write("a.mtl", "newmtl a\nbump a.png\n");
    three.folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl a\nf 1/1 2/2 3/3\n");
    const auto stop = std::make_unique<std::stop_source>(); // g++ 12 warns of a local one
    stop->request_stop();
    const Controlled controlled({stop->get_token(), {}});
    PicturesAhead ahead(three.wanted, three.limits, &three.jobs);
    PictureNotes notes;
    const Result<Image> image = ahead.read(three.wanted[0].path, false, three.limits, notes);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, ExitCode::stopped);
    for (const Jobs* jobs : {static_cast<const Jobs*>(nullptr), static_cast<const Jobs*>(&three.jobs)}) {
        const Result<Scene> scene = load_obj(three.folder.path("a.obj"), {}, jobs);
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().code, ExitCode::stopped);
    }
}

} // namespace
