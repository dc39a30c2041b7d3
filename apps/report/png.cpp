#include "apps/report/png.h"

#include <cmath>

#include "apps/report/canvas.h"
#include "apps/report/chart_style.h"
#include "core/image/io/image_io.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

Points scaled(Points points)
{
    for (auto& [x, y] : points)
        x *= kPngScale, y *= kPngScale;
    return points;
}

Points circle(const std::pair<double, double>& centre, double radius)
{
    constexpr int kSteps = 32;
    Points points;
    for (int i = 0; i < kSteps; ++i)
        points.emplace_back(centre.first + radius * std::sin(2.0 * kPi * i / kSteps),
                            centre.second - radius * std::cos(2.0 * kPi * i / kSteps));
    return points;
}

void paint_line(Canvas& canvas, const Points& points, const std::string& classes)
{
    const ChartLineStyle* look = chart_line_style(classes);
    if (!look)
        return;
    const Paint colour = look->tint ? tint(look->tint) : family(classes);
    if (look->on > 0.0)
        canvas.dash(points, look->width * kPngScale, look->on * kPngScale, look->off * kPngScale, colour, look->opacity);
    else
        canvas.stroke(points, look->width * kPngScale, colour, look->opacity);
}

void paint_mark(Canvas& canvas, Points outline, const std::string& classes)
{
    canvas.fill(outline, has_class(classes, "best") ? family(classes) : tint("paper"));
    outline.push_back(outline.front());
    canvas.stroke(outline, kMarkWidth * kPngScale, family(classes));
}

void paint_text(Canvas& canvas, const DrawnItem& item, const std::string& classes)
{
    const ChartTextStyle look = chart_text_style(classes);
    const double anchor = has_class(classes, "middle") ? 0.5 : has_class(classes, "end") ? 1.0 : 0.0;
    canvas.text(item.points[0].first * kPngScale, item.points[0].second * kPngScale, item.text,
                {look.size * kPngScale, anchor, item.turn_deg, look.bold, look.slanted, look.halo * kPngScale}, look.paint);
}

void paint_item(Canvas& canvas, const DrawnItem& item, const std::string& classes)
{
    switch (item.kind) {
    case DrawnItem::Kind::text:
        return paint_text(canvas, item, classes);
    case DrawnItem::Kind::line:
        return paint_line(canvas, scaled(item.points), classes);
    case DrawnItem::Kind::outline:
        return paint_mark(canvas, scaled(item.points), classes);
    case DrawnItem::Kind::disc:
        if (has_class(classes, "mark"))
            paint_mark(canvas, scaled(circle(item.points[0], item.radius)), classes);
        return;
    case DrawnItem::Kind::rectangle: {
        const Points p = scaled(item.points);
        return canvas.fill({p[0], {p[1].first, p[0].second}, p[1], {p[0].first, p[1].second}}, item.fill ? *item.fill : family(classes));
    }
    case DrawnItem::Kind::group:
    case DrawnItem::Kind::end:
        return;
    }
}

} // namespace

Image paint(const Drawing& drawing)
{
    Canvas canvas(static_cast<int>(std::lround(drawing.width * kPngScale)), static_cast<int>(std::lround(drawing.height * kPngScale)),
                  tint("paper"));
    std::vector<std::string> classes = {drawing.classes}; // of the open groups, each with its parents' classes
    for (const DrawnItem& item : drawing.items) {
        const std::string own = classes.back() + " " + item.classes;
        paint_item(canvas, item, own);
        if (item.kind == DrawnItem::Kind::group)
            classes.push_back(own);
        else if (item.kind == DrawnItem::Kind::end)
            classes.pop_back();
    }
    return canvas.image();
}

Result<std::string> png_of(const Drawing& drawing)
{
    return encode_png(paint(drawing));
}

} // namespace burnish
