#include "apps/report/png.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/core.h>
#include <map>
#include <sstream>
#include <vector>

#include "apps/report/assets.h"
#include "apps/report/canvas.h"
#include "core/base/check.h"
#include "core/image/io/image_io.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

struct Element {
    std::string name; // with a leading '/' where it ends
    std::map<std::string, std::string> attributes;
    bool empty = false; // <.../>
};

std::string unescaped(std::string text)
{
    const std::pair<const char*, const char*> names[] = {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}};
    for (const auto& [name, letter] : names)
        for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
            text.replace(at, std::string(name).size(), letter);
    return text;
}

// The element that begins at svg[at] == '<'; `at` moves behind it.
Element read_element(const std::string& svg, std::size_t& at)
{
    const std::size_t end = svg.find('>', at); // '>' in values is escaped
    BN_CHECK(end != std::string::npos);
    const std::string text = svg.substr(at + 1, end - at - 1);
    at = end + 1;
    Element e;
    std::size_t i = std::min(text.find_first_of(" /", 1), text.size());
    e.name = text.substr(0, i);
    e.empty = text.back() == '/';
    for (std::size_t equals; (equals = text.find("=\"", i)) != std::string::npos;) {
        const std::size_t begin = text.find_first_not_of(' ', i), close = text.find('"', equals + 2);
        e.attributes[text.substr(begin, equals - begin)] = unescaped(text.substr(equals + 2, close - equals - 2));
        i = close + 1;
    }
    return e;
}

bool has_class(const std::string& classes, const std::string& wanted)
{
    return fmt::format(" {} ", classes).find(fmt::format(" {} ", wanted)) != std::string::npos;
}

// A colour of marks.css by its name there; the first is that of light paper.
Paint named(const std::string& name)
{
    const std::string style = kChartMarksStyle;
    const std::size_t at = style.find(fmt::format("--{}: #", name));
    BN_CHECK(at != std::string::npos);
    std::string digits = style.substr(at + name.size() + 5);
    digits = digits.substr(0, digits.find(';'));
    if (digits.size() == 3)
        digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
    const unsigned long rgb = std::strtoul(digits.c_str(), nullptr, 16);
    return {static_cast<double>(rgb >> 16 & 255u), static_cast<double>(rgb >> 8 & 255u), static_cast<double>(rgb & 255u)};
}

// The colour of a technique's family, which classes c0, c1... give.
Paint family(const std::string& classes)
{
    for (int i = 0; i < 10; ++i)
        if (has_class(classes, fmt::format("c{}", i)))
            return named(fmt::format("c{}", i));
    return named("ink");
}

class Painter {
  public:
    Painter(double width, double height)
        : canvas_(static_cast<int>(std::lround(width * kPngScale)), static_cast<int>(std::lround(height * kPngScale)), named("paper"))
    {
    }
    void draw(const Element& e, const std::string& classes, const std::string& text);
    Image image() const { return canvas_.image(); }

  private:
    void line(const Points& points, const std::string& classes);
    void mark(const Points& outline, const std::string& classes);
    void write(const Element& e, const std::string& classes, const std::string& text);

    Canvas canvas_;
};

double number_of(const Element& e, const char* name)
{
    const auto found = e.attributes.find(name);
    BN_CHECK(found != e.attributes.end());
    return std::strtod(found->second.c_str(), nullptr);
}

std::string text_of(const Element& e, const char* name)
{
    const auto found = e.attributes.find(name);
    return found == e.attributes.end() ? "" : found->second;
}

// M, L, a (half circles) and Z.
Points path_points(const std::string& d, bool& closed)
{
    Points points;
    const char* at = d.c_str();
    const auto number = [&at] {
        char* end = nullptr;
        const double value = std::strtod(at, &end);
        at = end;
        return value * kPngScale;
    };
    closed = false;
    while (*at) {
        const char command = *at++;
        if (command == 'M' || command == 'L') {
            const double x = number(), y = number();
            points.emplace_back(x, y);
        } else if (command == 'a') {
            for (int i = 0; i < 5; ++i) // radii, turn, flags
                number();
            const double dx = number(), dy = number();
            const auto [x, y] = points.back();
            const double cx = x + dx / 2.0, cy = y + dy / 2.0;
            constexpr int kSteps = 12;
            for (int i = 1; i <= kSteps; ++i) {
                const double angle = kPi * i / kSteps, c = std::cos(angle), s = std::sin(angle);
                points.emplace_back(cx - dx / 2.0 * c - dy / 2.0 * s, cy + dx / 2.0 * s - dy / 2.0 * c);
            }
        } else {
            BN_CHECK(command == 'Z');
            closed = true;
            points.push_back(points.front());
        }
    }
    return points;
}

// Widths and opacities as marks.css has them.
void Painter::line(const Points& points, const std::string& classes)
{
    if (has_class(classes, "grid"))
        canvas_.stroke(points, 1.0 * kPngScale, named("grid"));
    else if (has_class(classes, "front"))
        canvas_.stroke(points, 5.0 * kPngScale, named("soft"), 0.35);
    else if (has_class(classes, "whisker"))
        canvas_.stroke(points, 1.0 * kPngScale, family(classes), 0.6);
    else if (has_class(classes, "level"))
        canvas_.dash(points, 1.3 * kPngScale, 5.0 * kPngScale, 4.0 * kPngScale, family(classes), 0.75);
    else if (has_class(classes, "curve"))
        canvas_.stroke(points, 1.3 * kPngScale, family(classes), 0.75);
}

void Painter::mark(const Points& outline, const std::string& classes)
{
    canvas_.fill(outline, has_class(classes, "best") ? family(classes) : named("paper"));
    canvas_.stroke(outline, 1.6 * kPngScale, family(classes));
}

void Painter::write(const Element& e, const std::string& classes, const std::string& text)
{
    TextStyle style;
    style.size = (has_class(classes, "tick") || has_class(classes, "value") ? 12.0 : 13.0) * kPngScale;
    style.anchor = has_class(classes, "middle") ? 0.5 : has_class(classes, "end") ? 1.0 : 0.0;
    style.bold = has_class(classes, "name");
    style.halo = style.bold ? 2.0 * kPngScale : 0.0;
    style.slanted = has_class(classes, "note");
    if (const std::string turn = text_of(e, "transform"); !turn.empty())
        style.turn_deg = std::strtod(turn.c_str() + turn.find('(') + 1, nullptr);
    const Paint paint = has_class(classes, "on-dark")                              ? Paint{255.0, 255.0, 255.0}
                        : has_class(classes, "on-pale")                            ? Paint{17.0, 17.0, 17.0}
                        : has_class(classes, "tick") || has_class(classes, "note") ? named("soft")
                                                                                   : family(classes);
    canvas_.text(number_of(e, "x") * kPngScale, number_of(e, "y") * kPngScale, text, style, paint);
}

void Painter::draw(const Element& e, const std::string& classes, const std::string& text)
{
    const auto at = [&e](const char* name) { return number_of(e, name) * kPngScale; };
    if (e.name == "text") {
        write(e, classes, text);
    } else if (e.name == "line") {
        line({{at("x1"), at("y1")}, {at("x2"), at("y2")}}, classes);
    } else if (e.name == "path") {
        bool closed = false;
        const Points points = path_points(text_of(e, "d"), closed);
        closed ? mark(points, classes) : line(points, classes);
    } else if (e.name == "rect") {
        int r = 0, g = 0, b = 0;
        BN_CHECK(std::sscanf(text_of(e, "fill").c_str(), "rgb(%d,%d,%d)", &r, &g, &b) == 3);
        const double x = at("x"), y = at("y"), w = at("width"), h = at("height");
        canvas_.fill({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}},
                     {static_cast<double>(r), static_cast<double>(g), static_cast<double>(b)});
    }
}

} // namespace

Image draw_svg(const std::string& svg)
{
    std::size_t at = svg.find('<');
    const Element root = read_element(svg, at);
    Painter painter(number_of(root, "width"), number_of(root, "height"));
    std::vector<std::string> classes = {""}; // of the open elements, each with those around it
    while ((at = svg.find('<', at)) != std::string::npos) {
        const Element e = read_element(svg, at);
        if (e.name[0] == '/') {
            classes.pop_back();
            continue;
        }
        const std::string own = classes.back() + " " + text_of(e, "class");
        const std::string text = e.empty ? "" : unescaped(svg.substr(at, svg.find('<', at) - at));
        painter.draw(e, own, text);
        if (!e.empty)
            classes.push_back(own);
        if (classes.empty())
            break;
    }
    return painter.image();
}

Result<std::string> chart_png(const std::string& svg)
{
    return encode_png(draw_svg(svg));
}

} // namespace burnish
