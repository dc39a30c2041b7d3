#include "apps/report/axes.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace burnish {

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
    if (linear)
        return from_px + (value - low) / (high - low) * (to_px - from_px);
    const double t = (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
    return from_px + t * (to_px - from_px);
}

Axis log_axis(double low, double high, double from_px, double to_px)
{
    constexpr double kMargin = 1.15, kLeastRange = 2.0;
    const double widen = std::max(kMargin, std::sqrt(kLeastRange / std::max(1.0, high / low)));
    return {low / widen, high * widen, from_px, to_px, false};
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

Axis linear_axis(double low, double high, double from_px, double to_px)
{
    const double margin = high > low ? 0.04 * (high - low) : 0.5;
    return {low - margin, high + margin, from_px, to_px, true};
}

std::vector<double> linear_ticks(const Axis& axis, std::size_t most)
{
    const double range = axis.high - axis.low;
    for (double decade = std::pow(10.0, std::floor(std::log10(range)) - 2.0);; decade *= 10.0)
        for (const double step : {decade, 2.0 * decade, 5.0 * decade}) {
            if (range / step > static_cast<double>(most))
                continue;
            std::vector<double> ticks;
            for (double i = std::ceil(axis.low / step); i * step <= axis.high; ++i)
                ticks.push_back(i * step + 0.0); // turns -0 into 0
            return ticks;
        }
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

} // namespace burnish
