// Charts as pixels: strokes, areas and letters at their places.
#include <cmath>
#include <gtest/gtest.h>

#include "apps/report/canvas.h"
#include "apps/report/chart_style.h"
#include "apps/report/png.h"

namespace burnish {
namespace {

constexpr Paint kWhite = {255, 255, 255}, kBlack = {0, 0, 0};

int gray(const Image& image, int x, int y)
{
    return static_cast<int>(image.bytes[static_cast<std::size_t>(3 * (y * image.width + x))]);
}

// Ink of an image in pixels, and its bounding box.
struct Ink {
    double sum = 0.0;
    int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};
Ink ink_of(const Image& image)
{
    Ink ink;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double part = 1.0 - gray(image, x, y) / 255.0;
            ink.sum += part;
            if (part < 0.25)
                continue;
            ink.left = std::min(ink.left, x), ink.right = std::max(ink.right, x);
            ink.top = std::min(ink.top, y), ink.bottom = std::max(ink.bottom, y);
        }
    return ink;
}

TEST(chart_canvas, a_stroke_has_its_width_and_its_opacity_once)
{
    Canvas canvas(100, 40, kWhite);
    canvas.stroke({{10, 20}, {50, 20}, {90, 20}, {50, 20}}, 6.0, kBlack, 0.5); // over itself
    const Image image = canvas.image();
    for (const int x : {12, 50, 70})
        EXPECT_NEAR(gray(image, x, 20), 128, 1) << x;
    EXPECT_EQ(gray(image, 50, 15), 255);
    EXPECT_EQ(gray(image, 50, 24), 255);
    EXPECT_NEAR(ink_of(image).sum, 0.5 * (80.0 * 6.0 + 3.14159 * 9.0), 3.0);
    Canvas dashed(100, 40, kWhite);
    dashed.dash({{0, 20}, {100, 20}}, 2.0, 6.0, 14.0, kBlack);
    EXPECT_EQ(gray(dashed.image(), 23, 20), 0);
    EXPECT_EQ(gray(dashed.image(), 33, 20), 255);
}

TEST(chart_canvas, an_area_covers_its_pixels_and_parts_of_those_at_its_edge)
{
    Canvas canvas(20, 20, kWhite);
    canvas.fill({{2.5, 3.0}, {10.0, 3.0}, {10.0, 8.0}, {2.5, 8.0}}, kBlack);
    const Image image = canvas.image();
    EXPECT_EQ(gray(image, 5, 5), 0);
    EXPECT_NEAR(gray(image, 2, 5), 128, 1);
    EXPECT_EQ(gray(image, 10, 5), 255);
    EXPECT_NEAR(ink_of(image).sum, 7.5 * 5.0, 0.2);
    Canvas outside(20, 20, kWhite); // nothing is visible, nothing breaks
    outside.fill({{-30, -30}, {-20, -30}, {-20, -20}}, kBlack);
    outside.stroke({{200, 5}, {300, 5}}, 3.0, kBlack);
    EXPECT_EQ(ink_of(outside.image()).sum, 0.0);
}

TEST(chart_canvas, letters_stand_on_their_line_and_are_anchored_and_turned)
{
    const auto write = [](const std::string& text, double anchor, double turn) {
        Canvas canvas(400, 400, kWhite);
        canvas.text(200.0, 200.0, text, {40.0, anchor, turn, false, false, 0.0}, kBlack);
        return ink_of(canvas.image());
    };
    const Ink start = write("HEI", 0.0, 0.0), middle = write("HEI", 0.5, 0.0), end = write("HEI", 1.0, 0.0),
              turned = write("HEI", 0.0, -90.0);
    EXPECT_NEAR(start.bottom, 200, 3);
    EXPECT_NEAR(start.bottom - start.top, 0.72 * 40.0 + 3.0, 3);
    EXPECT_GE(start.left, 200);
    EXPECT_LE(end.right, 200);
    EXPECT_NEAR(middle.left + middle.right, 400, 6);
    EXPECT_NEAR(turned.right - turned.left, start.bottom - start.top, 2);
    EXPECT_LE(turned.bottom, 200);
    EXPECT_GT(write("g", 0.0, 0.0).bottom, 205);
    EXPECT_NEAR(start.right - start.left, text_width("HEI", 40.0), 16.0);
    for (char c = '!'; c <= '~'; ++c) { // every letter exists
        const Ink ink = write(std::string(1, c), 0.0, 0.0);
        EXPECT_GT(ink.sum, 5.0) << c;
    }
    EXPECT_EQ(write(" ", 0.0, 0.0).sum, 0.0);
    EXPECT_EQ(write("\xc3\xa9", 0.0, 0.0).sum, write("??", 0.0, 0.0).sum); // not ASCII
}

TEST(chart_canvas, a_halo_keeps_lines_out_of_letters)
{
    const auto paper_beside_the_letter = [](double halo) {
        Canvas canvas(100, 60, kWhite);
        canvas.stroke({{-10, 30}, {110, 30}}, 100.0, kBlack); // black everywhere
        canvas.text(50.0, 45.0, "I", {40.0, 0.5, 0.0, true, false, halo}, kBlack);
        return 100.0 * 60.0 - ink_of(canvas.image()).sum;
    };
    EXPECT_EQ(paper_beside_the_letter(0.0), 0.0);
    EXPECT_NEAR(paper_beside_the_letter(3.0), 3.0 * 2.0 * (0.72 * 40.0 + 6.0), 70.0); // three pixels wide, around an upright stroke
}

TEST(chart_canvas, drawings_are_painted_with_the_looks_of_their_classes)
{
    Drawing drawing(100, 50, "chart wide", "a \"chart\" <of> something");
    drawing.line({{10, 10}, {90, 10}}, "grid");
    drawing.line({{10, 20}, {90, 20}}, "of no look");
    drawing.open("point c1 best", {{"aria-label", "1 > 0"}}, "nothing of this is painted");
    drawing.disc(50.0, 30.0, 11.0, "hit");
    drawing.mark(0, 50.0, 30.0, 8.0, "mark");
    drawing.close();
    drawing.open("point c2 c2a");
    drawing.mark(1, 20.0, 30.0, 8.0, "mark");
    drawing.close();
    drawing.rectangle(75, 25, 10, 10, "mark", Paint{1, 2, 3});
    drawing.text(60, 45, "tick", "");
    const Image image = paint(drawing);
    ASSERT_EQ(image.width, 100 * kPngScale);
    ASSERT_EQ(image.height, 50 * kPngScale);
    const auto at = [&image](double x, double y) {
        const std::size_t i = 3 * static_cast<std::size_t>(static_cast<int>(y * kPngScale) * image.width + static_cast<int>(x * kPngScale));
        return std::array<int, 3>{static_cast<int>(image.bytes[i]), static_cast<int>(image.bytes[i + 1]),
                                  static_cast<int>(image.bytes[i + 2])};
    };
    using Rgb = std::array<int, 3>;
    const auto rgb = [](const Paint& p) { return Rgb{static_cast<int>(p[0]), static_cast<int>(p[1]), static_cast<int>(p[2])}; };
    EXPECT_EQ(at(50, 10), rgb(tint("grid")));
    EXPECT_EQ(at(50, 20), (Rgb{255, 255, 255}));
    EXPECT_EQ(at(50, 30), (Rgb{0x00, 0x67, 0xa8})); // c1, filled
    EXPECT_EQ(at(50, 24), (Rgb{0x00, 0x67, 0xa8}));
    EXPECT_EQ(at(50, 36), (Rgb{0x00, 0x67, 0xa8}));
    EXPECT_EQ(at(50, 40.5), (Rgb{255, 255, 255})); // the area that answers to pointers is invisible
    EXPECT_EQ(at(20, 30), (Rgb{255, 255, 255}));   // hollow
    EXPECT_EQ(at(20 - 8 * std::sqrt(0.5), 30), rgb(tint("c2a")));
    EXPECT_EQ(at(80, 30), (Rgb{1, 2, 3}));
    EXPECT_EQ(at(5, 45), (Rgb{255, 255, 255}));
}

} // namespace
} // namespace burnish
