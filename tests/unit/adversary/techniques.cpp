// Lobes in techniques for environment light, and shading frames.
#include <cmath>

#include "tests/unit/adversary/domains.h"

namespace burnish::test {
namespace {

const std::vector<double> kSigma = {7e-4, 0.7071};

std::vector<double> axis(const Domain&, const double* u)
{
    std::vector<double> a;
    append(a, eye_of(u[0], u[1]));
    const double length = in_range(u[2], kSigma);
    return a.insert(a.end(), {length, length * u[3], straight(u[4], 0.5, 3.0), straight(u[5], 0.0, 4.0), 1.0 + std::floor(64.0 * u[6])}), a;
}

std::vector<double> line(const Domain&, const double* u)
{
    std::vector<double> a;
    append(a, eye_of(u[0], u[1]));
    const double length = in_range(u[2], kSigma);
    return a.insert(a.end(), {length, length * u[3], 1.0 + std::floor(64.0 * u[4]), straight(u[5], -0.98, 0.98)}), a;
}

std::vector<double> bent(const Domain&, const double* u)
{
    std::vector<double> a;
    append(a, eye_of(u[0], u[1]));
    const double length = in_range(u[2], kSigma);
    return a.insert(a.end(), {length, length * u[3]}), a;
}

// normal, tangent, handedness, the map's normal
std::vector<double> frame(const Domain&, const double* u)
{
    const Vec n = any_direction(u[0], u[1]), other = any_direction(u[2], u[3]), m = eye_of(u[4], u[5]);
    const Vec t = unit({n[1] * other[2] - n[2] * other[1], n[2] * other[0] - n[0] * other[2], n[0] * other[1] - n[1] * other[0]});
    std::vector<double> a;
    append(a, n), append(a, t), a.push_back(u[6] < 0.5 ? -1.0 : 1.0), append(a, m);
    return a;
}

std::vector<double> normal(const Domain&, const double* u)
{
    std::vector<double> a;
    append(a, any_direction(u[0], u[1]));
    return a;
}

} // namespace

const std::vector<Domain>& domains()
{
    const std::vector<Judged> axes = {{"axes", 0, 9, Unit::whole}};
    static const std::vector<Domain> list = {
        {"major_axis", 7, axis, {{"ends", 2, 6, Unit::whole}, {"radius", 8, 1, Unit::whole}}},
        {"lobe_line",
         6,
         line,
         {{"along", 0, 2, Unit::whole},
          {"width", 2, 1, Unit::last_place},
          {"weight", 8, 1, Unit::last_place},
          {"radius", 9, 1, Unit::last_place},
          {"v_dot_h", 10, 1, Unit::whole}}},
        {"bent_normal", 4, bent, {{"direction", 0, 3, Unit::whole}, {"level", 3, 1, Unit::whole}}},
        {"mapped_frame", 7, frame, axes},
        {"turned_frame", 7, frame, axes},
        {"bent_frame", 7, frame, axes},
        {"rotation_to", 2, normal, {{"rotation", 0, 3, Unit::whole}}},
    };
    return list;
}

} // namespace burnish::test
