// Number formatting, logarithmic and linear axes, and their ticks.
#pragma once
#include <string>
#include <vector>

namespace burnish {

std::string number(double value); // at most 4 significant digits

struct Axis {
    double low = 0.0, high = 1.0; // range of values, widened around the data
    double from_px = 0.0, to_px = 1.0;
    bool linear = false;
    double at(double value) const; // pixel position
};
Axis log_axis(double low, double high, double from_px, double to_px); // slightly wider than the values
std::vector<double> log_ticks(const Axis& axis, std::size_t most);    // round numbers: at least two, and at most `most` if possible

Axis linear_axis(double low, double high, double from_px, double to_px); // slightly wider than the values
std::vector<double> linear_ticks(const Axis& axis, std::size_t most);    // round numbers

std::vector<double> doubling_ticks(const Axis& axis, std::size_t most); // powers of two, or of four and so on

} // namespace burnish
