// Places names beside curves, each where it covers the least.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace burnish {

struct PlacedLabel {
    double x = 0.0, y = 0.0; // baseline
    bool end = false;        // the text ends at x instead of starting there
};

class LabelPlacer {
  public:
    // The area open to names, px.
    LabelPlacer(double left, double top, double right, double bottom) : area_{left, top, right, bottom} {}
    void add_mark(double x, double y);
    // Places the text beside one of a curve's points; prefers points near the end.
    PlacedLabel place(const std::string& text, const std::vector<std::pair<double, double>>& points);

  private:
    struct Box {
        double left, top, right, bottom;
    };
    double cost(const Box& box) const;

    Box area_;
    std::vector<Box> marks_, labels_;
};

} // namespace burnish
