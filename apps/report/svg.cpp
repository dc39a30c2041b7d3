#include "apps/report/svg.h"

#include <cmath>
#include <fmt/core.h>

#include "apps/report/html.h"

namespace burnish {
namespace {

std::string px(double value)
{
    return fmt::format("{:g}", std::round(value * 100.0) / 100.0);
}

// Returns "<element a="..." b="..."" without the closing bracket. Leaves out empty attributes.
std::string start(const std::string& element, const Attributes& attributes)
{
    std::string out = "<" + element;
    for (const auto& [name, value] : attributes)
        if (!value.empty())
            out += fmt::format(" {}=\"{}\"", name, escaped(value));
    return out;
}

std::string path_of(const Points& points, bool closed)
{
    std::string d;
    for (const auto& [x, y] : points)
        d += fmt::format("{}{} {}", d.empty() ? "M" : "L", px(x), px(y));
    return d + (closed ? "Z" : "");
}

std::string rgb_of(const std::optional<Paint>& fill)
{
    return fill ? fmt::format("rgb({:.0f},{:.0f},{:.0f})", (*fill)[0], (*fill)[1], (*fill)[2]) : "";
}

std::string group_of(const DrawnItem& item)
{
    Attributes attributes = {{"class", item.classes}};
    attributes.insert(attributes.end(), item.attributes.begin(), item.attributes.end());
    return start("g", attributes) + ">" + (item.text.empty() ? "" : "<title>" + escaped(item.text) + "</title>");
}

std::string element_of(const DrawnItem& item)
{
    const auto [x, y] = item.points.empty() ? std::pair{0.0, 0.0} : item.points.front();
    switch (item.kind) {
    case DrawnItem::Kind::group:
        return group_of(item);
    case DrawnItem::Kind::end:
        return "</g>\n";
    case DrawnItem::Kind::text:
        return start("text",
                     {{"x", px(x)},
                      {"y", px(y)},
                      {"class", item.classes},
                      {"transform", item.turn_deg != 0.0 ? fmt::format("rotate({} {} {})", px(item.turn_deg), px(x), px(y)) : ""}}) +
               ">" + escaped(item.text) + "</text>\n";
    case DrawnItem::Kind::line:
    case DrawnItem::Kind::outline:
        return start("path", {{"d", path_of(item.points, item.kind == DrawnItem::Kind::outline)}, {"class", item.classes}}) + "/>\n";
    case DrawnItem::Kind::disc:
        return start("circle", {{"cx", px(x)}, {"cy", px(y)}, {"r", px(item.radius)}, {"class", item.classes}}) + "/>";
    case DrawnItem::Kind::rectangle:
        return start("rect", {{"x", px(x)},
                              {"y", px(y)},
                              {"width", px(item.points[1].first - x)},
                              {"height", px(item.points[1].second - y)},
                              {"fill", rgb_of(item.fill)},
                              {"class", item.classes}}) +
               "/>";
    }
    return "";
}

} // namespace

std::string svg_of(const Drawing& drawing, const std::string& style)
{
    std::string out = start("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                                    {"class", drawing.classes},
                                    {"viewBox", fmt::format("0 0 {} {}", px(drawing.width), px(drawing.height))},
                                    {"width", px(drawing.width)},
                                    {"height", px(drawing.height)},
                                    {"role", "group"},
                                    {"aria-label", drawing.name}}) +
                      ">\n";
    if (!style.empty())
        out += "<style>" + escaped(style) + "</style>\n";
    for (const DrawnItem& item : drawing.items)
        out += element_of(item);
    return out + "</svg>\n";
}

} // namespace burnish
