#include "apps/report/svg.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/report/html.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

std::string px(double value)
{
    return fmt::format("{:g}", std::round(value * 100.0) / 100.0);
}

using Attributes = std::vector<std::pair<std::string, std::string>>;

std::string start(const std::string& element, const Attributes& attributes)
{
    std::string out = "<" + element;
    for (const auto& [name, value] : attributes)
        out += fmt::format(" {}=\"{}\"", name, escaped(value));
    return out;
}

} // namespace

Svg::Svg(double width, double height, const std::string& css_class, const std::string& name)
{
    open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                 {"class", css_class},
                 {"viewBox", fmt::format("0 0 {} {}", px(width), px(height))},
                 {"width", px(width)},
                 {"height", px(height)},
                 {"role", "group"},
                 {"aria-label", name}});
    out_ += "\n";
}

void Svg::open(const std::string& element, const Attributes& attributes)
{
    out_ += start(element, attributes) + ">";
    open_.push_back(element);
}

void Svg::close()
{
    out_ += "</" + open_.back() + ">\n";
    open_.pop_back();
}

void Svg::leaf(const std::string& element, const Attributes& attributes)
{
    out_ += start(element, attributes) + "/>";
}

void Svg::text(double x, double y, const std::string& css_class, const std::string& text, double turn_deg)
{
    Attributes attributes = {{"x", px(x)}, {"y", px(y)}, {"class", css_class}};
    if (turn_deg != 0.0)
        attributes.emplace_back("transform", fmt::format("rotate({} {} {})", px(turn_deg), px(x), px(y)));
    out_ += start("text", attributes) + ">" + escaped(text) + "</text>\n";
}

void Svg::line(double x0, double y0, double x1, double y1, const std::string& css_class)
{
    leaf("line", {{"x1", px(x0)}, {"y1", px(y0)}, {"x2", px(x1)}, {"y2", px(y1)}, {"class", css_class}});
}

void Svg::path(const std::vector<std::pair<double, double>>& points, const std::string& css_class)
{
    std::string d;
    for (const auto& [x, y] : points)
        d += fmt::format("{}{} {}", d.empty() ? "M" : "L", px(x), px(y));
    leaf("path", {{"d", d}, {"class", css_class}});
    out_ += "\n";
}

void Svg::title(const std::string& text)
{
    out_ += "<title>" + escaped(text) + "</title>";
}

std::string Svg::done()
{
    while (!open_.empty())
        close();
    return std::move(out_);
}

std::string number(double value)
{
    if (!std::isfinite(value))
        return "none";
    if (value != 0.0 && std::abs(value) < 1e-4)
        return fmt::format("{:.1e}", value);
    const double size = std::abs(value);
    const int digits = size >= 100.0 ? 0 : size >= 10.0 ? 1 : size >= 1.0 ? 2 : size >= 0.1 ? 3 : 4;
    std::string text = fmt::format("{:.{}f}", value, digits);
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.')
            text.pop_back();
    }
    return text;
}

double Axis::at(double value) const
{
    const double t = (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
    return from_px + t * (to_px - from_px);
}

Axis log_axis(double low, double high, double from_px, double to_px)
{
    constexpr double kMargin = 1.15, kLeastRange = 2.0;
    const double widen = std::max(kMargin, std::sqrt(kLeastRange / std::max(1.0, high / low)));
    return {low / widen, high * widen, from_px, to_px};
}

std::vector<double> log_ticks(const Axis& axis, std::size_t most)
{
    const std::vector<std::vector<double>> sets = {{1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 5, 7}, {1, 2, 5}, {1, 3}, {1}};
    std::vector<double> ticks;
    for (const std::vector<double>& set : sets) {
        std::vector<double> found;
        for (int decade = static_cast<int>(std::floor(std::log10(axis.low))); decade <= std::log10(axis.high); ++decade)
            for (const double step : set) {
                const double value = step * std::pow(10.0, decade);
                if (value >= axis.low && value <= axis.high)
                    found.push_back(value);
            }
        if (found.size() < 2)
            break;
        ticks = found;
        if (ticks.size() <= most)
            break;
    }
    return ticks;
}

std::vector<double> doubling_ticks(const Axis& axis, std::size_t most)
{
    for (double factor = 2.0;; factor *= 2.0) {
        std::vector<double> ticks;
        for (double value = 1.0; value <= axis.high; value *= factor)
            if (value >= axis.low)
                ticks.push_back(value);
        if (ticks.size() <= most)
            return ticks;
    }
}

std::string shape_path(int shape, double x, double y, double radius)
{
    const auto polygon = [&](int corners, double turn, double inner) {
        std::string d;
        const int steps = inner > 0.0 ? 2 * corners : corners;
        for (int i = 0; i < steps; ++i) {
            const double angle = turn + 2.0 * kPi * i / steps, r = inner > 0.0 && i % 2 ? radius * inner : radius;
            d += fmt::format("{}{} {}", i ? "L" : "M", px(x + r * std::sin(angle)), px(y - r * std::cos(angle)));
        }
        return d + "Z";
    };
    switch (shape % kShapes) {
    case 0:
        return fmt::format("M{0} {1}a{2} {2} 0 1 0 {3} 0a{2} {2} 0 1 0 -{3} 0Z", px(x - radius), px(y), px(radius), px(2.0 * radius));
    case 1:
        return polygon(4, kPi / 4.0, 0.0); // square
    case 2:
        return polygon(3, 0.0, 0.0); // triangle
    case 3:
        return polygon(4, 0.0, 0.0); // diamond
    case 4:
        return polygon(3, kPi, 0.0); // triangle, point down
    case 5:
        return polygon(4, 0.0, 0.35); // plus-like star
    case 6:
        return polygon(6, 0.0, 0.0); // hexagon
    default:
        return polygon(5, 0.0, 0.42); // star
    }
}

} // namespace burnish
