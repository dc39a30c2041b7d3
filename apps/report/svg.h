// Pieces of charts as SVG text. Colours and shapes are classes that apps/report/marks.css gives their looks, in the page and in
// files.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace burnish {

// Written from outside to inside; every text and attribute value is escaped here, numbers are short.
class Svg {
  public:
    Svg(double width, double height, const std::string& css_class, const std::string& name);
    void open(const std::string& element, const std::vector<std::pair<std::string, std::string>>& attributes = {});
    void close();
    void leaf(const std::string& element, const std::vector<std::pair<std::string, std::string>>& attributes);
    void text(double x, double y, const std::string& css_class, const std::string& text, double turn_deg = 0.0);
    void line(double x0, double y0, double x1, double y1, const std::string& css_class);
    void path(const std::vector<std::pair<double, double>>& points, const std::string& css_class);
    void title(const std::string& text); // of the open element, shown by viewers when pointed at
    std::string done();                  // closes what is open

  private:
    std::string out_;
    std::vector<std::string> open_;
};

std::string number(double value); // at most 4 digits, as people write it

struct Axis {
    double low = 0.0, high = 1.0; // of what is shown, widened to fit the data
    double from_px = 0.0, to_px = 1.0;
    double at(double value) const; // px; logarithmic
};
Axis log_axis(double low, double high, double from_px, double to_px); // a little wider than the values
std::vector<double> log_ticks(const Axis& axis, std::size_t most);    // round numbers, at least two, not more than asked if that can be

std::vector<double> doubling_ticks(const Axis& axis, std::size_t most); // powers of two, or of four and so on

// Marks: one of a few outlines about a centre, which techniques differ by beside their colours.
inline constexpr int kShapes = 8;
std::string shape_path(int shape, double x, double y, double radius);

} // namespace burnish
