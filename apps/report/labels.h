// Names beside curves: each goes where it covers the least.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace burnish {

struct PlacedLabel {
    double x = 0.0, y = 0.0; // baseline
    bool end = false;        // the text ends at x instead of beginning there
};

class LabelPlacer {
  public:
    // The area that names may cover, px.
    LabelPlacer(double left, double top, double right, double bottom) : area_{left, top, right, bottom} {}
    void add_mark(double x, double y);
    // Beside one of a curve's points, the last ones first.
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
