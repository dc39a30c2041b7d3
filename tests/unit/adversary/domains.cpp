#include "tests/unit/adversary/domains.h"

#include <cmath>
#include <numbers>

namespace burnish::test {

double straight(double u, double low, double high)
{
    return low + (high - low) * u;
}

double by_factors(double u, double low, double high)
{
    return low * std::pow(high / low, u);
}

Vec eye_of(double u, double v)
{
    const double part = 3.0 * u, azimuth = 2.0 * std::numbers::pi * v;
    if (part < 2.0) {
        const double z = part < 1.0 ? part : by_factors(part - 1.0, 1e-4, 1.0), s = std::sqrt(1.0 - z * z);
        return {s * std::cos(azimuth), s * std::sin(azimuth), z < 1e-4 ? 1e-4 : z};
    }
    const double s = by_factors(part - 2.0, 1e-6, 1.0);
    return {s * std::cos(azimuth), s * std::sin(azimuth), std::sqrt(1.0 - s * s) + 1e-4 * (s == 1.0)};
}

Vec facet_of(double u, double v)
{
    const double slope = by_factors(u, 1e-5, 10.0), azimuth = 2.0 * std::numbers::pi * v;
    return unit({slope * std::cos(azimuth), slope * std::sin(azimuth), 1.0});
}

Vec any_direction(double u, double v)
{
    return direction(std::acos(1.0 - 2.0 * u), 2.0 * std::numbers::pi * v);
}

Vec mirrored(Vec o, Vec h)
{
    return unit(h * (2.0 * dot(o, h)) + o * -1.0);
}

void append(std::vector<double>& to, const Vec& v)
{
    to.insert(to.end(), v.begin(), v.end());
}

double in_range(double u, const std::vector<double>& range)
{
    return range[0] > 0.0 ? by_factors(u, range[0], range[1]) : straight(u, range[0], range[1]);
}

std::vector<double> ranges(const Domain& d, const double* u)
{
    std::vector<double> a;
    for (const std::vector<double>& range : d.of)
        a.push_back(in_range(*u++, range));
    return a;
}

} // namespace burnish::test
