// OBJ texts: numbers, lines, indices, colours, normals; refusals and messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/image/colour.h"
#include "core/scene/obj/obj.h"

namespace burnish::obj_text {
namespace {

const std::string kPositions = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
const std::string kHead = kPositions + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
const std::string kFace = "f 1/1/1 2/2/1 3/3/1 4/4/1\n";

Scene scene_of(const std::string& text)
{
    Result<Scene> scene = load_obj_text(text, "label.obj", Limits{});
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().line()) << "\n" << text;
    return scene ? std::move(*scene) : Scene{};
}

std::vector<float> numbers_of(const Scene& scene)
{
    const VertexTable& v = scene.vertices;
    std::vector<float> out;
    for (const std::uint32_t index : scene.indices)
        for (const Column<float>* column : {&v.px, &v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.u0, &v.v0, &v.cr, &v.cg, &v.cb})
            out.push_back((*column)[index]);
    return out;
}

void expect_same(const std::string& text, const std::string& as)
{
    const Scene scene = scene_of(text);
    EXPECT_EQ(numbers_of(scene), numbers_of(scene_of(as))) << text;
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
}

void expect_refused(const std::string& text, const std::string& place, const std::string& needle)
{
    const Result<Scene> scene = load_obj_text(text, "label.obj", Limits{});
    ASSERT_FALSE(scene) << text;
    EXPECT_EQ(scene.error().code, ExitCode::bad_input);
    EXPECT_EQ(scene.error().file, "label.obj");
    EXPECT_EQ(scene.error().place, place) << text << scene.error().line();
    EXPECT_NE(scene.error().reason.find(needle), std::string::npos) << text << scene.error().line();
}

void expect_warned(const std::string& text, const std::string& needle)
{
    const Scene scene = scene_of(text);
    ASSERT_EQ(scene.warnings.size(), 1u) << text;
    EXPECT_NE(scene.warnings[0].find(needle), std::string::npos) << scene.warnings[0];
}

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

TEST(obj, lines_may_end_and_go_on_in_any_way)
{
    const std::string quad = kHead + kFace;
    expect_same("\xEF\xBB\xBF" + quad, quad);
    expect_same("\xEF\xBB\xBF\xEF\xBB\xBF" + quad, quad);
    expect_same(replaced(quad, "\n", "\r\n"), quad);
    expect_same(replaced(quad, "\n", "\r"), quad);
    expect_same(replaced(quad, " ", "\t "), quad);
    expect_same(replaced(quad, "\nv", " \n  v"), quad);
    expect_same(quad.substr(0, quad.size() - 1), quad);
    expect_same(replaced(quad, "2/2/1 ", "2/2/1 \\\n"), quad);
    expect_same(replaced(quad, "2/2/1 ", "\\\r\n2/2/1 \\\r\n"), quad);
    expect_same(replaced(quad, "v 1 1 0", "v 1 \\\n1 \\\n0"), quad);
    expect_same(replaced(quad, "2/2/1 ", "2/2/1 \\ \t\n"), quad);
    expect_same(quad + "\\", quad);
    expect_same(replaced(quad, "vt 0 0\n", "vt 0 0" + std::string(100000, ' ') + "\n"), quad);
}

TEST(obj, comments_stand_anywhere_and_say_nothing)
{
    const std::string quad = kHead + kFace;
    expect_same("# made by hand \\\n" + quad, quad); // a comment does not continue
    expect_same(replaced(quad, "\n", " # the whole quad 20261125143000\n"), quad);
    expect_same(replaced(quad, "4/4/1", "4/4/1#"), quad);
    expect_same(quad + "# v nan f 99999999999", quad);
    expect_same("g part#2\n" + quad, quad);
    EXPECT_EQ(scene_of("g part#2 # a comment\n" + quad).meshes[0].name, "part#2");
    EXPECT_EQ(scene_of("o two words # a comment\n" + quad).meshes[0].name, "two words");
}

TEST(obj, numbers_are_read_to_the_last_bit)
{
    const auto first = [](const std::string& word) {
        return scene_of(replaced(kPositions, "v -1 -1", "v " + word + " -1") + "f 1 2 3\n").vertices.px[0];
    };
    EXPECT_EQ(first("0.1"), 0.1f);
    EXPECT_EQ(first("+1"), 1.0f);
    EXPECT_EQ(first(".5"), 0.5f);
    EXPECT_EQ(first("-.5"), -0.5f);
    EXPECT_EQ(first("1."), 1.0f);
    EXPECT_EQ(first("1.25e+1"), 12.5f);
    EXPECT_EQ(first("1E-2"), 1e-2f);
    EXPECT_EQ(first("3.4028235e38"), 3.4028235e38f);
    EXPECT_EQ(first("0.3333333432674407958984375"), 0.3333333432674407958984375f);
    EXPECT_EQ(first("16777217.000000000000000001"), 16777218.0f);
    EXPECT_EQ(first("1e-60"), 0.0f);
}

TEST(obj, what_is_no_number_is_refused_with_its_line)
{
    for (const char* word : {"0,75", "nan", "NaN", "-nan(0)", "inf", "-Infinity", "x1", "0x10", "1.0x", "1d3", "1e", "e5", ".", "-", "+-1",
                             "--1", "1.2.3", "1_000",
                             "\xE2\x88\x92"
                             "1"}) {
        expect_refused(replaced(kHead, "v 1 1 0", "v " + std::string(word) + " 1 0") + kFace, "line 3", "position 3: '");
        expect_refused(replaced(kHead, "vt 1 1", "vt " + std::string(word) + " 1") + kFace, "line 7", "texture coordinate 3: '");
        expect_refused(replaced(kHead, "vn 0 0 1", "vn " + std::string(word) + " 0 1") + kFace, "line 9", "normal 1: '");
    }
    expect_refused(replaced(kHead, "v 1 1 0", "v 0,75 1 0") + kFace, "line 3", "'0,75' is no number; decimals follow a point");
    const Result<Scene> wide = load_obj_text(std::string("v\0 \0001\0", 6), "wide.obj", {});
    ASSERT_FALSE(wide);
    EXPECT_NE(wide.error().line().find("UTF-16"), std::string::npos) << wide.error().line();
    expect_refused(replaced(kHead, "v 1 1 0", "v \\\n1 oh 0") + kFace, "line 3", "'oh' is no number");
    for (const char* word : {"1e999", "-1e39", "3.5e38", "1e-999"})
        expect_refused(replaced(kHead, "v 1 1 0", "v " + std::string(word) + " 1 0") + kFace, "line 3", "no number that a float holds");
}

TEST(obj, statements_have_as_many_numbers_as_the_format_says)
{
    for (const char* numbers : {"", "1", "1 2", "1 2 3 4 5", "1 2 3 4 5 6 7", "1 2 3 4 5 6 7 8"})
        expect_refused(std::string("v ") + numbers + "\n" + kHead + kFace, "line 1", "position 1:");
    for (const char* numbers : {"", "1 2 3 4"})
        expect_refused(kPositions + "vt " + numbers + "\nf 1 2 3\n", "line 5", "texture coordinate 1:");
    for (const char* numbers : {"", "1 2", "1 2 3 4"})
        expect_refused(kPositions + "vn " + numbers + "\nf 1 2 3\n", "line 5", "normal 1:");
    const std::string quad = kHead + kFace;
    expect_same(replaced(quad, "v 1 1 0", "v 1 1 0 1"), quad);
    expect_warned(replaced(quad, "v 1 1 0", "v 1 1 0 0.5"), "line 3: weights");
    expect_same(replaced(replaced(quad, "vt 1 1", "vt 1 1 0.5"), "vt 1 0", "vt 1"), quad);
}

TEST(obj, indices_are_whole_and_name_what_came_before)
{
    const std::string quad = kHead + kFace;
    expect_same(kHead + "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n", quad);
    expect_same(kHead + "f +1/1/1 2/2/1 3/3/1 4/4/1\n", quad);
    expect_same(kHead + "fo 1/1/1 2/2/1 3/3/1 4/4/1\n", quad);
    expect_same(kPositions + "f 1/ 2// 3 4/\n", kPositions + "f 1 2 3 4\n");
    for (const char* face :
         {"0 1 2", "1 2 5", "1 2 -5", "2000000000 1 2", "99999999999999999999 1 2", "-9223372036854775808 1 2", "1/5 2 3", "1//2 2 3"})
        expect_refused(kHead + "f " + face + "\n", "line 10", "face 1: index");
    for (const char* face : {"a b c", "1.5 2 3", "/1 2 3", "1/x 2 3", "1,2 3 4", "1 2 3x"})
        expect_refused(kHead + "f " + face + "\n", "line 10", "is no index");
    expect_refused(kHead + "f 1/1/1/1 2 3\n", "line 10", "more than three indices");
    for (const char* face : {"", "1", "1 2"})
        expect_refused(kHead + kFace + "f " + face + "\n", "line 11", "face 2: has fewer than three corners");
    expect_refused(kFace + kHead, "line 1", "index 1 of 0 positions");
}

TEST(obj, what_is_left_out_is_said_once)
{
    const std::string quad = kHead + kFace;
    expect_warned(quad + "p 1\nl 1 2\np 2\n", "line 11: points and lines are not drawn");
    expect_warned(quad + "vp 0.5\ncstype bspline\ndeg 3\ncurv 0 1 1 2 3\nend\n", "line 11: curves and surfaces are not drawn");
    expect_warned("mtllib a b.mtl\nusemtl x#1\n" + quad, "MTL");
    expect_same("mtllib a b.mtl\n" + quad + "usemtl\n", quad);
    expect_warned(quad + "call other.obj\nfoo\nbar\n", "line 11: 'call' is not read");
    expect_warned("#MRGB ff000000\n" + quad, "MRGB");
    expect_warned("s often\n" + quad, "line 1: 'often' is no smoothing group");
    expect_same("mg 1 2\nlod 3\nbevel on\n" + quad, quad);
    for (const char* word : {"V", "VT", "Vn", "F", "UseMtl", "G"})
        expect_refused(quad + word + " 1 2 3\n", "line 11", "is no statement, which is written '");
    expect_refused("\xFF\xFEv\0", "byte 0", "UTF-16");
    expect_refused(kPositions, "", "no faces");
    expect_warned(kHead + "f 1/1 2/2 3/3\nf 1 3 4\n", "3 of 6 corners of its group '' have no texture coordinates");
}

TEST(obj, colours_of_vertices_are_srgb)
{
    const Scene scene = scene_of("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0.5 0.25 1\nf 1 2 3\n");
    ASSERT_EQ(scene.vertices.size(), 3u);
    EXPECT_TRUE(scene.primitives[0].has_color);
    const VertexTable& v = scene.vertices;
    const float wanted[3][3] = {{1, 0, 0}, {1, 1, 1}, {srgb_to_linear(0.5f), srgb_to_linear(0.25f), 1}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(v.cr[i], wanted[i][0]);
        EXPECT_EQ(v.cg[i], wanted[i][1]);
        EXPECT_EQ(v.cb[i], wanted[i][2]);
        EXPECT_EQ(v.ca[i], 1.0f);
    }
    EXPECT_NEAR(static_cast<double>(v.cr[2]), 0.21404, 1e-5);
    EXPECT_FALSE(scene_of(kHead + kFace).primitives[0].has_color);
    expect_warned("v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n", "line 1: colours of vertices lie outside 0 to 1");
    EXPECT_FALSE(scene_of("v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n").primitives[0].has_color);
}

// A roof of two slopes whose ridge is smooth or sharp.
TEST(obj, smoothing_groups_decide_where_normals_are_shared)
{
    const std::string roof = "v -1 0 1\nv -1 0 -1\nv 0 1 1\nv 0 1 -1\nv 1 0 1\nv 1 0 -1\n", left = "f 1 3 4 2\n", right = "f 3 5 6 4\n";
    const auto ridge = [](const Scene& scene) { // |x| of normals where x = 0
        float most = 0.0f;
        for (std::size_t i = 0; i < scene.vertices.size(); ++i)
            most = std::max(most, scene.vertices.px[i] == 0.0f ? std::fabs(scene.vertices.nx[i]) : 0.0f);
        return static_cast<double>(most);
    };
    const double slope = std::sqrt(0.5);
    // Shared normals weigh triangles by area. At a corner the two sides have one and two triangles.
    EXPECT_NEAR(ridge(scene_of(roof + left + right)), std::sqrt(0.1), 1e-6);
    EXPECT_NEAR(ridge(scene_of(roof + "s 1\n" + left + right)), std::sqrt(0.1), 1e-6);
    EXPECT_NEAR(ridge(scene_of(roof + "s 1\n" + left + "s 2\n" + right)), slope, 1e-6);
    EXPECT_NEAR(ridge(scene_of(roof + "s off\n" + left + right)), slope, 1e-6);
    EXPECT_NEAR(ridge(scene_of(roof + "s 0\n" + left + "s 0\n" + right)), slope, 1e-6);
    EXPECT_NEAR(ridge(scene_of(roof + "vn 0 1 0\ns off\n" + "f 1//1 3//1 4//1 2//1\nf 3//1 5//1 6//1 4//1\n")), 0.0, 1e-6);
}

TEST(obj, is_told_by_its_ending)
{
    for (const char* name : {"a.obj", "a.OBJ", "a.Obj", ".obj"})
        EXPECT_TRUE(is_obj(name)) << name;
    for (const char* name : {"obj", "a.object", "a.objx", "", "a.gltf"})
        EXPECT_FALSE(is_obj(name)) << name;
}

} // namespace
} // namespace burnish::obj_text
