// A chart as a list of shapes and texts, from back to front, of which SVG text (svg.h) is made. Places are px from the top left corner, y
// down. Looks go by classes, which apps/report/chart_style.h gives colours and widths; a group's classes hold for all in it.
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
    std::string classes;         // the item's own, with blanks between
    Points points;               // text: start of its line; disc: its centre; rectangle: two opposite corners
    double radius = 0.0;         // disc
    double turn_deg = 0.0;       // text: clockwise, about its position
    std::string text{};          // group: the tooltip in viewers
    std::optional<Paint> fill{}; // overrides the fill of the classes
    Attributes attributes{};     // group: data for scripts, not drawn
};

class Drawing {
  public:
    Drawing() = default; // an empty chart
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
    // Draws one of a few outlines about a centre. Techniques differ by outline as well as by colour.
    void mark(int shape, double x, double y, double radius, const std::string& css_class);

    bool empty() const { return width == 0.0; }

    double width = 0.0, height = 0.0;
    std::string classes, name;
    std::vector<DrawnItem> items;
};

inline constexpr int kShapes = 12;
Points shape_outline(int shape, double x, double y, double radius); // closed: the first point is not repeated

} // namespace burnish
