#include "apps/report/drawing.h"

#include <cmath>

#include "core/math/scalar_math.h"

namespace burnish {

using Kind = DrawnItem::Kind;

void Drawing::open(const std::string& css_class, const Attributes& attributes, const std::string& title)
{
    DrawnItem item{Kind::group, css_class, {}};
    item.text = title, item.attributes = attributes;
    items.push_back(std::move(item));
}

void Drawing::close()
{
    items.push_back({Kind::end, "", {}});
}

void Drawing::text(double x, double y, const std::string& css_class, const std::string& text, double turn_deg)
{
    DrawnItem item{Kind::text, css_class, {{x, y}}};
    item.text = text, item.turn_deg = turn_deg;
    items.push_back(std::move(item));
}

void Drawing::line(const Points& points, const std::string& css_class)
{
    items.push_back({Kind::line, css_class, points});
}

void Drawing::disc(double x, double y, double radius, const std::string& css_class)
{
    items.push_back({Kind::disc, css_class, {{x, y}}, radius});
}

void Drawing::rectangle(double x, double y, double w, double h, const std::string& css_class, std::optional<Paint> fill)
{
    DrawnItem item{Kind::rectangle, css_class, {{x, y}, {x + w, y + h}}};
    item.fill = fill;
    items.push_back(std::move(item));
}

void Drawing::mark(int shape, double x, double y, double radius, const std::string& css_class)
{
    const Points outline = shape_outline(shape, x, y, radius);
    if (outline.empty())
        disc(x, y, radius, css_class);
    else
        items.push_back({Kind::outline, css_class, outline});
}

Points shape_outline(int shape, double x, double y, double radius)
{
    // `inner`: radius of every other corner, relative to the outer radius; 0: no such corners.
    struct Shape {
        int corners;
        double turn, inner;
    };
    constexpr Shape kOutlines[kShapes] = {
        {0, 0.0, 0.0},       // disc
        {4, kPi / 4.0, 0.0}, // square
        {3, 0.0, 0.0},       // triangle
        {4, 0.0, 0.0},       // diamond
        {3, kPi, 0.0},       // triangle, point down
        {4, 0.0, 0.35},      // four-pointed star
        {6, 0.0, 0.0},       // hexagon
        {5, 0.0, 0.42},      // five-pointed star
        {3, -kPi / 2, 0.0},  // triangle, point to the left
        {4, kPi / 4.0, 0.4}, // diagonal cross
        {3, kPi / 2, 0.0},   // triangle, point to the right
        {6, 0.0, 0.5},       // six-pointed star
    };
    const Shape& s = kOutlines[shape % kShapes];
    const int steps = s.inner > 0.0 ? 2 * s.corners : s.corners;
    Points outline;
    for (int i = 0; i < steps; ++i) {
        const double angle = s.turn + 2.0 * kPi * i / steps, r = s.inner > 0.0 && i % 2 ? radius * s.inner : radius;
        outline.emplace_back(x + r * std::sin(angle), y - r * std::cos(angle));
    }
    return outline;
}

} // namespace burnish
