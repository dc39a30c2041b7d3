// The charts of a report.
#pragma once
#include <string>
#include <vector>

#include "apps/chart/rows.h"
#include "apps/report/drawing.h"

namespace burnish {

// Charts are drawn twice: with names beside the curves, or 380 pixels wide with the names below, for telephones.
enum class Layout { wide, narrow };

using RowList = std::vector<const ChartRow*>;

std::string describe(const ChartRow& row); // "major_axis, 16 samples: 3.1 ms, FLIP 0.021"

struct Mark { // how a technique is drawn: each has its own shape; relatives (major_axis, major_axis_weighted) have shades of one family
    int family = 0, relative = 0, shape = 0;
};
Mark mark_of(const std::string& technique);
std::string mark_class(const std::string& technique); // "c2 c2a", as apps/report/looks.h takes it

// Time against FLIP, a point a setting, the Pareto front. Rows of one place.
Drawing plot_time_flip(const RowList& rows, Layout layout);

enum class Quantity { flip, time };
// Against the number of samples; techniques that take none are level lines. Empty where no technique has two numbers.
Drawing plot_samples(const RowList& rows, Quantity quantity, Layout layout);

// FLIP against the numbers of a swept option, a curve a technique; rows of one scene and environment. Empty where it has fewer than two.
Drawing plot_sweep(const RowList& rows, const std::string& option, Layout layout);
std::vector<std::string> swept_numbers(const RowList& rows); // such options

// FLIP of one technique over roughness and anisotropy, or how much more it is than bent_normal's; rows of one scene and environment,
// all techniques. Empty where there is nothing to compare.
Drawing plot_heat(const RowList& rows, const std::string& technique, bool difference);

std::vector<std::string> techniques_of(const RowList& rows); // in order

} // namespace burnish
