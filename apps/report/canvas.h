// A raster canvas for charts: antialiased strokes, areas and text. Positions are pixels from the top left corner, y down.
#pragma once
#include <string>
#include <vector>

#include "apps/report/drawing.h"
#include "core/image/image.h"

namespace burnish {

// Size and setting of a text. Letters are strokes (apps/report/stroke_font.jhf); non-ASCII characters are drawn as '?'.
struct TextStyle {
    double size = 13.0;    // em size, px
    double anchor = 0.0;   // 0: starts at the position, 0.5: centred, 1: ends there
    double turn_deg = 0.0; // clockwise, about the position
    bool bold = false, slanted = false;
    double halo = 0.0; // px of paper around the letters, to separate them from lines behind
};

class Canvas {
  public:
    Canvas(int width, int height, const Paint& paper);
    void stroke(const Points& line, double width, const Paint& paint, double opacity = 1.0); // round ends and corners
    void dash(const Points& line, double width, double on, double off, const Paint& paint, double opacity = 1.0);
    void fill(const Points& outline, const Paint& paint);                                               // closed outline, even-odd rule
    void text(double x, double y, const std::string& text, const TextStyle& style, const Paint& paint); // y: baseline
    Image image() const;                                                                                // u8 sRGB

  private:
    struct Box {
        int x0, y0, x1, y1; // [x0, x1) x [y0, y1)
    };
    Box box_of(const Points& points, double margin) const;
    void blend(const Box& box, const std::vector<float>& cover, const Paint& paint, double opacity);
    void strokes(const std::vector<Points>& lines, double width, const Paint& paint, double opacity); // one layer: crossings do not add up

    int width_, height_;
    Paint paper_;
    std::vector<float> pixels_; // RGB
};

double text_width(const std::string& text, double size); // px

} // namespace burnish
