#include "apps/report/labels.h"

#include <algorithm>

namespace burnish {
namespace {

constexpr double kCharacter = 7.3, kHeight = 15.0, kGap = 10.0; // px of the charts' font

} // namespace

void LabelPlacer::add_mark(double x, double y)
{
    marks_.push_back({x - 6.0, y - 6.0, x + 6.0, y + 6.0});
}

double LabelPlacer::cost(const Box& box) const
{
    const auto overlap = [&box](const Box& other) {
        const double w = std::min(box.right, other.right) - std::max(box.left, other.left);
        const double h = std::min(box.bottom, other.bottom) - std::max(box.top, other.top);
        return w > 0.0 && h > 0.0 ? w * h : 0.0;
    };
    double sum = 0.0;
    for (const Box& label : labels_)
        sum += 20.0 * overlap(label);
    for (const Box& mark : marks_)
        sum += 4.0 * overlap(mark);
    const double outside = std::max(0.0, area_.left - box.left) + std::max(0.0, box.right - area_.right) +
                           std::max(0.0, area_.top - box.top) + std::max(0.0, box.bottom - area_.bottom);
    return sum + 1000.0 * outside;
}

PlacedLabel LabelPlacer::place(const std::string& text, const std::vector<std::pair<double, double>>& points)
{
    const double width = kCharacter * static_cast<double>(text.size());
    struct Offset {
        double dx, dy;
        bool end;
    };
    constexpr Offset kOffsets[] = {{kGap, -6.0, false},  {kGap, 4.5, false},  {kGap, 15.0, false},  {-kGap, 4.5, true},
                                   {-kGap, -6.0, true},  {-kGap, 15.0, true}, {kGap, -20.0, false}, {kGap, 30.0, false},
                                   {kGap, -34.0, false}, {kGap, 44.0, false}};
    PlacedLabel best;
    Box taken{};
    double least = 1e300;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [x, y] = points[points.size() - 1 - i];
        for (std::size_t k = 0; k < std::size(kOffsets); ++k) {
            const Offset& o = kOffsets[k];
            const double at_x = x + o.dx, at_y = y + o.dy, left = o.end ? at_x - width : at_x;
            const Box box{left, at_y - kHeight + 3.0, left + width, at_y + 3.0};
            // Breaks ties in favour of the curve's end and of a short distance to the point.
            const double sum = cost(box) + 60.0 * static_cast<double>(i) + 15.0 * static_cast<double>(k);
            if (sum < least)
                least = sum, best = {at_x, at_y, o.end}, taken = box;
        }
    }
    labels_.push_back(taken);
    return best;
}

} // namespace burnish
