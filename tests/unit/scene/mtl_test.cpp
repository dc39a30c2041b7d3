// Materials of OBJ files: MTL libraries.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>

#include "core/image/io/image_io.h"
#include "core/scene/obj/mtl.h"
#include "core/scene/obj/obj.h"
#include "tests/unit/temp_folder.h"

using namespace burnish;
using namespace burnish::test;

namespace {

const std::string kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string kFirst = "f 1/1 2/2 3/3\n", kSecond = "f 1/1 3/3 4/4\n";

void write_picture(const std::string& path, int width, int height, std::vector<int> rgb)
{
    Image image = make_image(width, height, 3, PixelType::u8);
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
        image.bytes[i] = static_cast<std::byte>(rgb[i % rgb.size()]);
    ASSERT_TRUE(write_image(path, image));
}

// Loads an OBJ file whose triangles wear `a` and `b` of a library.
Result<Scene> load_wearing(const TempFolder& folder, const std::string& library, const std::string& more = "")
{
    folder.write("a.mtl", library);
    folder.write("a.obj", "mtllib a.mtl\n" + kQuad + more + "usemtl a\n" + kFirst + "usemtl b\n" + kSecond);
    return load_obj(folder.path("a.obj"), Limits());
}

Material material_of(const std::string& lines)
{
    const TempFolder folder;
    const Result<Scene> scene = load_wearing(folder, "newmtl a\n" + lines + "\nnewmtl b\n");
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().line());
    return scene ? scene->materials[static_cast<std::size_t>(scene->primitives[0].material)] : Material();
}

std::string warnings_of(const std::string& lines)
{
    const TempFolder folder;
    const Result<Scene> scene = load_wearing(folder, "newmtl a\n" + lines + "\nnewmtl b\n");
    std::string all;
    for (const std::string& warning : scene ? scene->warnings : std::vector<std::string>{"error: " + scene.error().line()})
        all += warning + "\n";
    return all;
}

TEST(mtl, groups_wear_what_they_name)
{
    const TempFolder folder;
    const Result<Scene> scene = load_wearing(folder, "# a comment\nnewmtl b\nKd 0 0 1\nnewmtl a\nKd 1 .5 .25 # warm\n");
    ASSERT_TRUE(scene) << scene.error().line();
    ASSERT_EQ(scene->primitives.size(), 2u);
    const auto worn = [&](std::size_t p) { return scene->materials[static_cast<std::size_t>(scene->primitives[p].material)]; };
    EXPECT_EQ(worn(0).name, "a");
    EXPECT_EQ(worn(0).base_color, glm::vec4(1.0f, 0.5f, 0.25f, 1.0f));
    EXPECT_EQ(worn(1).base_color, glm::vec4(0.0f, 0.0f, 1.0f, 1.0f));
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0];
    EXPECT_EQ(scene->files.size(), 2u);
}

TEST(mtl, numbers_become_a_material)
{
    const Material phong = material_of("Kd 0.5\nKs 0.5 0.5 0.5\nNs 98\nNi 1.33\nd 0.25\nKe 2 4 0\nillum 2\nKa 1 1 1");
    EXPECT_EQ(phong.base_color, glm::vec4(0.5f, 0.5f, 0.5f, 0.25f));
    EXPECT_EQ(phong.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(phong.metallic, 0.0f);
    EXPECT_NEAR(phong.roughness, std::sqrt(std::sqrt(2.0f / 100.0f)), 1e-6f);
    EXPECT_EQ(phong.specular_color, glm::vec3(1.0f));
    EXPECT_EQ(phong.ior, 1.33f);
    EXPECT_EQ(phong.emissive, glm::vec3(0.5f, 1.0f, 0.0f));
    EXPECT_EQ(phong.emissive_strength, 4.0f);
    const Material brushed = material_of("Kd 1 1 1\nPr 0.4\nPm 1\naniso 0.8\nanisor 0.25\nPc 1\nPcr 0.1\nTr 0.25");
    EXPECT_EQ(brushed.roughness, 0.4f);
    EXPECT_EQ(brushed.metallic, 1.0f);
    EXPECT_EQ(brushed.anisotropy_strength, 0.8f);
    EXPECT_NEAR(brushed.anisotropy_rotation, 1.5707964f, 1e-6f);
    EXPECT_EQ(brushed.clearcoat, 1.0f);
    EXPECT_EQ(brushed.clearcoat_roughness, 0.1f);
    EXPECT_EQ(brushed.base_color.a, 0.75f);
    const Material across = material_of("Pr 0.4\nPm 1\naniso -0.5");
    EXPECT_EQ(across.anisotropy_strength, 0.5f);
    EXPECT_NEAR(across.anisotropy_rotation, 1.5707964f, 1e-6f);
    const Material plain = material_of("Ni 1.0");
    EXPECT_EQ(plain.roughness, 1.0f);
    EXPECT_EQ(plain.ior, 1.5f); // 1 says nothing
}

TEST(mtl, pictures_become_textures)
{
    const TempFolder folder;
    write_picture(folder.path("colour.png"), 2, 2, {255, 0, 0});
    write_picture(folder.path("rough.png"), 4, 2, {51, 0, 0});
    write_picture(folder.path("metal.png"), 2, 4, {255, 0, 0});
    write_picture(folder.path("normal map.png"), 2, 2, {128, 128, 255});
    const Result<Scene> scene = load_wearing(
        folder,
        "newmtl a\nKd 1 1 1\nmap_Kd -s 2 3 1 -o 0.25 0.5 colour.png\nmap_Pr rough.png\nmap_Pm metal.png\nnorm -bm 0.5 normal map.png\n"
        "newmtl b\nmap_Kd -clamp on textures\\colour.png\nmap_Ke colour.png\n");
    ASSERT_TRUE(scene) << scene.error().line();
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0];
    const Material& a = scene->materials[static_cast<std::size_t>(scene->primitives[0].material)];
    const Material& b = scene->materials[static_cast<std::size_t>(scene->primitives[1].material)];
    // A place at (u, v), v down, shows the file's (2u + .25, 3(1-v) + .5)
    const glm::vec2 at = a.base_color_tex.uv_transform * glm::vec3(0.5f, 0.25f, 1.0f);
    EXPECT_NEAR(at.x, 2.0f * 0.5f + 0.25f, 1e-6f);
    EXPECT_NEAR(1.0f - at.y, 3.0f * 0.75f + 0.5f, 1e-6f);
    EXPECT_EQ(a.normal_scale, 0.5f);
    EXPECT_EQ(a.roughness, 1.0f);
    EXPECT_EQ(a.metallic, 1.0f);
    const auto image_of = [&](const TextureRef& ref) {
        return scene->images[static_cast<std::size_t>(scene->textures[static_cast<std::size_t>(ref.texture)].image)];
    };
    const Image packed = image_of(a.metallic_roughness_tex);
    EXPECT_EQ(packed.width, 4);
    EXPECT_EQ(packed.height, 4);
    EXPECT_EQ(std::to_integer<int>(packed.bytes[1]), 51);
    EXPECT_EQ(std::to_integer<int>(packed.bytes[2]), 255);
    EXPECT_EQ(scene->textures[static_cast<std::size_t>(b.base_color_tex.texture)].wrap_s, WrapMode::clamp);
    EXPECT_EQ(b.emissive, glm::vec3(1.0f));
    EXPECT_EQ(std::count(scene->files.begin(), scene->files.end(), folder.path("colour.png")), 1);
}

TEST(mtl, specular_pictures_and_exponents_become_textures)
{
    const TempFolder folder;
    write_picture(folder.path("colour.png"), 2, 2, {255, 0, 0});
    write_picture(folder.path("exponents.png"), 2, 2, {51, 0, 0}); // a fifth
    const Result<Scene> scene = load_wearing(
        folder, "newmtl a\nNs 490\nmap_Ks colour.png\nmap_Ns exponents.png\nnewmtl b\nKs .25 .25 .25\nmap_Ks colour.png\nPr .3\n");
    ASSERT_TRUE(scene) << scene.error().line();
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0];
    const Material& a = scene->materials[static_cast<std::size_t>(scene->primitives[0].material)];
    const Material& b = scene->materials[static_cast<std::size_t>(scene->primitives[1].material)];
    EXPECT_EQ(a.specular_color, glm::vec3(2.0f));
    EXPECT_EQ(b.specular_color, glm::vec3(0.5f));
    EXPECT_TRUE(a.specular_color_tex.used() && b.specular_color_tex.used());
    EXPECT_EQ(a.roughness, 1.0f);
    const auto& texture = scene->textures[static_cast<std::size_t>(a.metallic_roughness_tex.texture)];
    const Image& packed = scene->images[static_cast<std::size_t>(texture.image)];
    ASSERT_EQ(packed.type, PixelType::u16);
    const float green = static_cast<float>(reinterpret_cast<const std::uint16_t*>(packed.bytes.data())[1]) / 65535.0f;
    EXPECT_NEAR(green, std::pow(2.0f / (98.0f + 2.0f), 0.25f), 1e-4f);
    EXPECT_NE(warnings_of("Pr .5\nmap_Ns exponents.png").find("map_Ns is not read"), std::string::npos);
}

TEST(mtl, wrong_numbers_are_errors_with_their_line)
{
    for (const auto& [line, words] : {std::pair<std::string, std::string>{"Kd red", "'red' is no number"},
                                      {"Ns", "a number is missing"},
                                      {"Pr nan", "'nan' is no number"},
                                      {"Ke 1e99 0 0", "'1e99' is no number"},
                                      {"map_Kd -s x a.png", "a number is missing"}}) {
        const TempFolder folder;
        const Result<Scene> scene = load_wearing(folder, "newmtl a\n" + line + "\n");
        ASSERT_FALSE(scene) << line;
        EXPECT_EQ(scene.error().place, "line 2") << scene.error().line();
        EXPECT_NE(scene.error().reason.find(words), std::string::npos) << scene.error().line();
        EXPECT_NE(scene.error().file.find("a.mtl"), std::string::npos);
    }
    EXPECT_TRUE(obj::parse_mtl("x", std::string("newmtl a\0", 9)).wrong);
}

TEST(mtl, what_is_not_drawn_is_said)
{
    EXPECT_EQ(warnings_of("illum 2\nKa 1 1 1\nsharpness 60"), "");
    for (const auto& [line, words] : {std::pair<std::string, std::string>{"Pr 3", "Pr 3 is taken as 1"},
                                      {"map_Kd", "a picture's name is missing"},
                                      {"Pz 0.5", "'Pz' is not read"},
                                      {"Kd spectral a.rfl", "Kd spectral is not read"},
                                      {"map_Kd missing.png", "missing.png is not found"},
                                      {"map_d alpha.png", "map_d is read only where it is map_Kd"},
                                      {"newmtl a", "stands here again"}})
        EXPECT_NE(warnings_of(line).find(words), std::string::npos) << line << ": " << warnings_of(line);
    EXPECT_NE(warnings_of("Pz 0.5\nbump a.png").find("a.png is not found"), std::string::npos);
    const std::string twice = warnings_of("Pz 0.5\nPz 0.6");
    EXPECT_EQ(std::count(twice.begin(), twice.end(), '\n'), 1) << twice;
}

TEST(mtl, sheen_is_white_and_half_rough)
{
    const Material cloth = material_of("Kd .2 .1 .1\nPs .4");
    EXPECT_EQ(cloth.sheen_color, glm::vec3(0.4f));
    EXPECT_EQ(cloth.sheen_roughness, 0.5f);
    EXPECT_EQ(material_of("Kd 1 1 1").sheen_color, glm::vec3(0.0f));
}

TEST(mtl, sheen_maps_hold_amounts)
{
    const TempFolder folder;
    write_picture(folder.path("s.png"), 2, 2, {128, 0, 0});
    const Result<Scene> scene = load_wearing(folder, "newmtl a\nmap_Ps s.png\nnewmtl b\nPs .5\nmap_Ps s.png\nmap_Kd s.png\n");
    ASSERT_TRUE(scene) << scene.error().line();
    ASSERT_EQ(scene->materials.size(), 3u);
    for (std::size_t k = 1; k < 3; ++k) {
        const Material& m = scene->materials[k];
        ASSERT_TRUE(m.sheen_color_tex.used());
        const Image& image =
            scene->images[static_cast<std::size_t>(scene->textures[static_cast<std::size_t>(m.sheen_color_tex.texture)].image)];
        ASSERT_EQ(image.type, PixelType::f32);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.f32()[c], 128.0f / 255.0f, 1e-4f);
        EXPECT_EQ(m.sheen_roughness, 0.5f);
    }
    EXPECT_EQ(scene->materials[1].sheen_color, glm::vec3(1.0f));
    EXPECT_EQ(scene->materials[2].sheen_color, glm::vec3(0.5f));
    EXPECT_NE(scene->materials[2].base_color_tex.texture, scene->materials[2].sheen_color_tex.texture);
}

TEST(mtl, bump_maps_of_normals_are_normal_maps)
{
    const TempFolder folder;
    write_picture(folder.path("n.png"), 2, 2, {128, 128, 255, 180, 128, 240});
    write_picture(folder.path("h.png"), 2, 2, {128, 128, 128, 200, 200, 200, 190, 190, 190, 211, 211, 211});
    for (const char* word : {"bump", "map_Bump", "map_bump"}) {
        const Result<Scene> scene =
            load_wearing(folder, std::string("newmtl a\n") + word + " -bm 0.5 n.png\nnewmtl b\n" + word + " h.png\n");
        ASSERT_TRUE(scene) << scene.error().line();
        EXPECT_TRUE(scene->materials[1].normal_tex.used()) << word;
        EXPECT_EQ(scene->materials[1].normal_scale, 0.5f);
        EXPECT_FALSE(scene->materials[2].normal_tex.used());
        EXPECT_EQ(scene->materials[2].normal_scale, 1.0f);
        ASSERT_EQ(scene->warnings.size(), 1u);
        EXPECT_NE(scene->warnings[0].find("holds heights"), std::string::npos) << scene->warnings[0];
    }
    EXPECT_NE(warnings_of("norm n.png\nbump h.png").find("not read beside norm"), std::string::npos);
    const TempFolder light;
    write_picture(light.path("h.png"), 2, 2, {200, 200, 200});
    light.write("b.tga", "no picture");
    const Result<Scene> scene = load_wearing(light, "newmtl a\nbump h.png\nnewmtl b\nbump b.tga\n");
    ASSERT_TRUE(scene) << scene.error().line();
    EXPECT_FALSE(scene->materials[1].normal_tex.used() || scene->materials[2].normal_tex.used());
    ASSERT_EQ(scene->warnings.size(), 2u);
    EXPECT_NE(scene->warnings[1].find("is left out"), std::string::npos) << scene->warnings[1];
}

TEST(mtl, missing_pictures_change_nothing)
{
    const Material metal = material_of("Pm 1\nPr .3\nmap_Pm none.png\nmap_Pr none.png\nmap_Kd none.png\nmap_d none.png\nd .3");
    EXPECT_EQ(metal.metallic, 1.0f);
    EXPECT_EQ(metal.roughness, 0.3f);
    EXPECT_EQ(metal.alpha_mode, AlphaMode::blend);
    const Material plain = material_of("Ns 98\nmap_Pm none.png\nmap_Pr none.png\nmap_Ke none.png");
    EXPECT_EQ(plain.metallic, 0.0f);
    EXPECT_LT(plain.roughness, 0.4f);
    EXPECT_EQ(plain.emissive, glm::vec3(0.0f));
}

TEST(mtl, options_of_pictures_are_read_in_any_order)
{
    for (const std::string options :
         {"-clamp on -blendu on", "-blendu on -clamp on", "-bm 1 -clamp on -mm 0 1", "-clamp on -type sphere"}) {
        const obj::MtlLibrary library = obj::parse_mtl("x", "newmtl a\nmap_Kd " + options + " 2 b.png\n");
        ASSERT_FALSE(library.wrong) << options;
        EXPECT_TRUE(library.materials[0].diffuse_map.clamps) << options;
        EXPECT_EQ(library.materials[0].diffuse_map.file, "2 b.png") << options;
    }
    EXPECT_FALSE(obj::parse_mtl("x", "newmtl a\nmap_Kd -clamp off -blendu on b.png\n").materials[0].diffuse_map.clamps);
    const Material turned = material_of("Pm 1\naniso 1\nanisor 1e30");
    EXPECT_TRUE(std::isfinite(turned.anisotropy_rotation));
    const obj::MtlLibrary far = obj::parse_mtl("x", "newmtl a\nmap_Kd -s 1 -3e38 b.png\n");
    EXPECT_EQ(far.materials[0].diffuse_map.scale.y, -1e6f);
    EXPECT_EQ(far.warnings.size(), 1u);
}

TEST(mtl, alpha_cuts_out_whatever_d_says)
{
    const TempFolder folder;
    write_picture(folder.path("leaf.png"), 2, 2, {255, 0, 0});
    const Result<Scene> scene = load_wearing(folder, "newmtl a\nd 0.3\nmap_Kd leaf.png\nmap_d leaf.png\nnewmtl b\n");
    ASSERT_TRUE(scene);
    const Material& m = scene->materials[static_cast<std::size_t>(scene->primitives[0].material)];
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.base_color.a, 1.0f);
}

TEST(mtl, names_without_a_material_are_said)
{
    const TempFolder folder;
    folder.write("a.obj", "mtllib none.mtl\n" + kQuad + "usemtl a\n" + kFirst);
    const Result<Scene> missing = load_obj(folder.path("a.obj"), Limits());
    ASSERT_TRUE(missing);
    ASSERT_EQ(missing->warnings.size(), 2u);
    EXPECT_NE(missing->warnings[0].find("none.mtl is not found"), std::string::npos);
    EXPECT_NE(missing->warnings[1].find("no library has material 'a'"), std::string::npos);
    EXPECT_EQ(missing->materials[static_cast<std::size_t>(missing->primitives[0].material)].name, "white");
    folder.write("b.obj", kQuad + "usemtl a\n" + kFirst);
    EXPECT_EQ(load_obj(folder.path("b.obj"), Limits())->warnings.size(), 1u);
    const Result<Scene> in_memory = load_obj_text("mtllib a.mtl\n" + kQuad + "usemtl a\n" + kFirst, folder.path("a.obj"), Limits());
    ASSERT_TRUE(in_memory);
    EXPECT_EQ(in_memory->files.size(), 1u); // reads no further file
}

TEST(mtl, files_lie_below_the_scene_s_folder)
{
    const TempFolder folder;
    std::filesystem::create_directories(folder.path("inner"));
    folder.write("outer.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("inner/a.obj", "mtllib ../outer.mtl\n" + kQuad + "usemtl a\n" + kFirst);
    Limits limits;
    const Result<Scene> kept = load_obj(folder.path("inner/a.obj"), limits);
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->materials.size(), 1u);
    EXPECT_NE(kept->warnings[0].find("not found"), std::string::npos);
    limits.uris_outside = true;
    const Result<Scene> outside = load_obj(folder.path("inner/a.obj"), limits);
    ASSERT_TRUE(outside);
    EXPECT_EQ(outside->materials.size(), 2u);
    std::filesystem::create_symlink(folder.path("outer.mtl"), folder.path("inner/outer.mtl"));
    EXPECT_EQ(load_obj(folder.path("inner/a.obj"), Limits())->materials.size(), 1u);
}

TEST(mtl, pictures_count_against_the_limits)
{
    const TempFolder folder;
    write_picture(folder.path("colour.png"), 64, 64, {255, 0, 0});
    folder.write("a.mtl", "newmtl a\nmap_Kd colour.png\n");
    folder.write("a.obj", "mtllib a.mtl\n" + kQuad + "usemtl a\n" + kFirst);
    Limits limits;
    limits.texture_bytes = 4096;
    const Result<Scene> refused = load_obj(folder.path("a.obj"), limits);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ExitCode::bad_input);
    // Long maps packed together are as large as both
    write_picture(folder.path("wide.png"), 512, 1, {255, 0, 0});
    write_picture(folder.path("high.png"), 1, 512, {255, 0, 0});
    limits.texture_bytes = 100000;
    folder.write("a.mtl", "newmtl a\nmap_Pm wide.png\nmap_Pr high.png\n");
    ASSERT_FALSE(load_obj(folder.path("a.obj"), limits));
    std::string many;
    for (int i = 0; i < 40; ++i)
        many += "newmtl m" + std::to_string(i) + "\nmap_Pm wide.png\nmap_Pr ./high.png\n";
    folder.write("a.mtl", many);
    const Result<Scene> shared = load_obj(folder.path("a.obj"), Limits());
    ASSERT_TRUE(shared);
    EXPECT_EQ(shared->textures.size(), 1u);
    folder.write("a.mtl", "newmtl a\nmap_Kd colour.png\n");
    folder.write("colour.png", "no picture");
    EXPECT_FALSE(load_obj(folder.path("a.obj"), Limits()));
}

} // namespace
