// Transformed cosines: the lookup in the shipped table, and light from a triangle, a disk and a sphere through a lobe.
#include <cmath>

#include "tests/unit/adversary/domains.h"
#include "tests/unit/adversary/lit.h"

namespace burnish::test {
namespace {

std::vector<double> looked_up(const Domain&, const double* u)
{
    std::vector<double> a;
    append(a, eye_of(u[0], u[1]));
    const double length = by_factors(u[2], 1e-3, 1.0);
    return a.insert(a.end(), {length, by_factors(u[3], 1e-3, 1.0)}), a;
}

// Returns M for an eye and two widths by the double lookup. Advances u past the numbers of looked_up.
std::vector<double> lobe(const double*& u)
{
    const Domain none = {};
    std::vector<double> m = ltc::run_row(oracle_fns(), "ltc_lookup", looked_up(none, u), ltc::shipped_view());
    u += 4, m.resize(9);
    return m;
}

std::vector<double> density(const Domain&, const double* u)
{
    std::vector<double> a = lobe(u);
    append(a, eye_of(u[0], u[1]));
    return a;
}

// Returns a place above or below the horizon, 0.1 to 10 away.
Vec place(const double*& u)
{
    const Vec p = any_direction(u[0], u[1]) * by_factors(u[2], 0.1, 10.0);
    return u += 3, p;
}

std::vector<double> triangle(const Domain&, const double* u)
{
    std::vector<double> a = lobe(u);
    for (int corner = 0; corner < 3; ++corner)
        append(a, place(u));
    return a;
}

std::vector<double> disk(const Domain&, const double* u)
{
    std::vector<double> a = lobe(u);
    append(a, place(u));
    const Vec p = any_direction(u[0], u[1]), other = any_direction(u[2], u[3]), q = unit(other + p * -dot(other, p));
    append(a, p * by_factors(u[4], 0.01, 1.0)), append(a, q * by_factors(u[5], 0.01, 1.0));
    return a;
}

std::vector<double> sphere(const Domain&, const double* u)
{
    std::vector<double> a = lobe(u);
    const Vec middle = place(u);
    append(a, middle), a.push_back(std::sqrt(dot(middle, middle)) * straight(u[0], 0.01, 0.95));
    return a;
}

} // namespace

const std::vector<Domain>& domains()
{
    const std::vector<Judged> part = {{"part", 0, 1, Unit::whole}};
    static const std::vector<Domain> list = {
        {"ltc_lookup", 4, looked_up, {{"matrix", 0, 9, Unit::whole}, {"albedo", 10, 2, Unit::whole}}, -1, ltc::shipped_view},
        {"ltc_density", 6, density, {{"density", 0, 1, Unit::last_place}}},
        {"ltc_triangle", 13, triangle, part},
        {"ltc_disk", 13, disk, part},
        {"ltc_sphere", 8, sphere, part},
    };
    return list;
}

} // namespace burnish::test
