// A square plot of a space: directions or slopes, with density, contours, curves and dots.
#pragma once
#include <functional>
#include <vector>

#include "apps/lab/plot/shapes.h"
#include "apps/report/drawing.h"
#include "core/math/scalar_math.h"

namespace burnish {

inline constexpr double kSide = 300.0, kGap = 24.0, kTop = 40.0, kBelow = 92.0; // px: panel side, gap, and margins around it
inline constexpr double kDegree = kPi / 180.0;                                  // rad

inline const PlotFns& plot_fns()
{
    return FnsByIsa<PlotFns>::oracle(nullptr);
}

struct Place {
    double x = 0.0, y = 0.0;
};

struct Panel {
    const char* title;
    double left, reach; // px; distance from centre to edge, in units of the space
    double top = kTop;  // px
    std::pair<double, double> at(const Place& p) const
    {
        return {left + kSide * (0.5 + 0.5 * p.x / reach), top + kSide * (0.5 - 0.5 * p.y / reach)};
    }
    bool holds(const Place& p) const; // NaN: outside the space
};

PlotVec unit(const PlotVec& v);
PlotVec mix(const PlotVec& a, const PlotVec& b, double t); // along the arc, unit
double dot(const PlotVec& a, const PlotVec& b);
PlotVec cross(const PlotVec& a, const PlotVec& b);

using Density = std::function<double(const Place&)>;
using ToPlace = std::function<Place(const PlotVec&)>; // maps a direction into the space; NaN: outside

enum class Edge { slopes, horizon, units, sphere }; // labels at the panel's edge

// Draws a density: white for zero, dark for large values, on light and dark paper alike. The square root makes tails visible. With
// Edge::horizon only inside the circle.
void draw_density(Drawing& out, const Panel& panel, Edge edge, const Density& density);
// Draws the contour of the density at `level`.
void draw_contour(Drawing& out, const Panel& panel, const Density& density, double level, const std::string& css_class);
Points line_of(const Panel& panel, const std::vector<PlotVec>& directions, const ToPlace& place);
void draw_dot(Drawing& out, const Panel& panel, const Place& p, double radius, const std::string& family);
void draw_frame(Drawing& out, const Panel& panel, Edge edge);

struct KeyEntry {
    const char *family, *text;
};
void draw_key(Drawing& out, double y, const std::vector<KeyEntry>& entries);

} // namespace burnish
