// A chart as a list of what is drawn, from back to front: SVG text (svg.h) and pixels (png.h) are both made of it. Places are px from the
// top left corner, y down. Looks go by classes, which apps/report/looks.h gives colours and widths; a group's classes hold for all in it.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace burnish {

using Points = std::vector<std::pair<double, double>>;
using Paint = std::array<double, 3>; // sRGB, [0,255]
using Attributes = std::vector<std::pair<std::string, std::string>>;

struct DrawnItem {
    enum class Kind { group, end, text, line, outline, disc, rectangle };
    Kind kind = Kind::group;
    std::string classes;         // its own, with blanks between
    Points points;               // of text: where its line begins; of a disc: the centre; of a rectangle: two opposite corners
    double radius = 0.0;         // of a disc
    double turn_deg = 0.0;       // of text: clockwise, about its place
    std::string text{};          // of a group: what viewers show when it is pointed at
    std::optional<Paint> fill{}; // instead of the classes' one
    Attributes attributes{};     // of a group: for programs, not drawn
};

class Drawing {
  public:
    Drawing() = default; // nothing at all
    Drawing(double width_px, double height_px, std::string css_class, std::string what)
        : width(width_px), height(height_px), classes(std::move(css_class)), name(std::move(what))
    {
    }
    void open(const std::string& css_class, const Attributes& attributes = {}, const std::string& title = "");
    void close();
    void text(double x, double y, const std::string& css_class, const std::string& text, double turn_deg = 0.0);
    void line(const Points& points, const std::string& css_class);
    void disc(double x, double y, double radius, const std::string& css_class);
    void rectangle(double x, double y, double width, double height, const std::string& css_class, std::optional<Paint> fill = {});
    // One of a few outlines about a centre, which techniques differ by beside their colours.
    void mark(int shape, double x, double y, double radius, const std::string& css_class);

    bool empty() const { return width == 0.0; }

    double width = 0.0, height = 0.0;
    std::string classes, name;
    std::vector<DrawnItem> items;
};

inline constexpr int kShapes = 12;
Points shape_outline(int shape, double x, double y, double radius); // closed: the first place is not repeated

bool has_class(const std::string& classes, const std::string& wanted);

} // namespace burnish
