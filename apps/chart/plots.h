// The charts of a report.
#pragma once
#include <string>
#include <vector>

#include "apps/chart/rows.h"
#include "apps/report/drawing.h"

namespace burnish {

// Charts are drawn twice: with names beside the curves, or 380 pixels wide with the names below, for phones.
enum class Layout { wide, narrow };

using RowList = std::vector<const ChartRow*>;

std::string describe(const ChartRow& row); // "major_axis, 16 samples: 3.1 ms, FLIP 0.021"

struct Mark { // a technique's mark: its own shape, and a shade of its family's colour (major_axis, major_axis_weighted)
    int family = 0, relative = 0, shape = 0;
};
Mark mark_of(const std::string& technique);
std::string mark_class(const std::string& technique); // "c2 c2a", see apps/report/chart_style.h

// Plots time against FLIP, one point a setting, with the Pareto front. `rows`: rows of one place.
Drawing plot_time_flip(const RowList& rows, Layout layout);

enum class Quantity { flip, time };
// Plots against the number of samples. Techniques without samples are level lines. Empty if no technique has two sample counts.
Drawing plot_samples(const RowList& rows, Quantity quantity, Layout layout);

// Plots FLIP against the values of a swept option, one curve a technique. `rows`: rows of one scene and environment. Empty below two
// values.
Drawing plot_sweep(const RowList& rows, const std::string& option, Layout layout);
std::vector<std::string> swept_numbers(const RowList& rows); // names such options

// Plots a technique's FLIP over roughness and anisotropy, or its FLIP minus bent_normal's. `rows`: rows of one scene and environment, all
// techniques. Empty if nothing can be compared.
Drawing plot_heat(const RowList& rows, const std::string& technique, bool difference);

std::vector<std::string> techniques_of(const RowList& rows); // in order of the rows

} // namespace burnish
