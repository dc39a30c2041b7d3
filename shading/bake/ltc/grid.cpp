#include "shading/bake/ltc/grid.h"

#include <algorithm>

#include "core/math/scalar_math.h"

namespace burnish::ltc {

std::size_t Grid::node(int theta, int phi, int alpha, int lambda) const
{
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    return ((at(theta) * n() + at(phi)) * n() + at(alpha)) * n() + at(lambda);
}

std::array<int, 4> Grid::indices(std::size_t node) const
{
    return {static_cast<int>(node / (n() * n() * n())), static_cast<int>(node / (n() * n()) % n()), static_cast<int>(node / n() % n()),
            static_cast<int>(node % n())};
}

Place Grid::between(int theta, int phi, int alpha, int lambda, const std::array<double, 4>& u) const
{
    const double last = size - 1.0, a = (alpha + u[2]) / last;
    return {(theta + u[0]) / last * (0.5 * kPi), (phi + u[1]) / last * (0.5 * kPi), root_alpha ? a * a : a, (lambda + u[3]) / last};
}

Place Grid::place(std::size_t node) const
{
    const std::array<int, 4> i = indices(node);
    Place place = between(i[0], i[1], i[2], i[3], {});
    place.theta = std::min(place.theta, kMostTheta);
    place.alpha = std::max(place.alpha, kLeastAlpha);
    place.lambda = std::max(place.lambda, kLeastLambda);
    return place;
}

Corners Grid::corners(const Place& place) const
{
    const double last = size - 1.0;
    const double u[4] = {place.theta * (2.0 / kPi), place.phi * (2.0 / kPi), root_alpha ? std::sqrt(place.alpha) : place.alpha,
                         place.lambda};
    int low[4];
    double part[4];
    for (int a = 0; a < 4; ++a) {
        const double at = std::clamp(u[a] * last, 0.0, last);
        low[a] = std::min(static_cast<int>(at), size - 2);
        part[a] = at - low[a];
    }
    Corners corners;
    for (int c = 0; c < 16; ++c) {
        int i[4];
        double weight = 1.0;
        for (int a = 0; a < 4; ++a) {
            const int up = c >> a & 1;
            i[a] = low[a] + up;
            weight *= up ? part[a] : 1.0 - part[a];
        }
        corners[static_cast<std::size_t>(c)] = {node(i[0], i[1], i[2], i[3]), weight};
    }
    return corners;
}

Matrix Grid::frame(const Place& place) const
{
    if (basis == Basis::natural)
        return natural_matrix(place);
    if (basis == Basis::tangent)
        return {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const Matrix natural = natural_matrix(place);
    const double x = natural[2], y = natural[5], z = natural[8], s = 1.0 / (1.0 + z); // the mirror direction
    return {1.0 - x * x * s, -x * y * s, x, -x * y * s, 1.0 - y * y * s, y, -x, -y, z};
}

Matrix Grid::held(const Matrix& m, const Place& place) const
{
    return with_unit_axis(inverse(frame(place)) * m);
}

Matrix Grid::shown(const Matrix& entry, const Place& place) const
{
    return frame(place) * entry;
}

Matrix Grid::lookup(const std::vector<Matrix>& entries, const Place& place) const
{
    Matrix sum{};
    for (const Corner& corner : corners(place))
        for (std::size_t e = 0; e < 9; ++e)
            sum[e] += corner.weight * entries[corner.node][e];
    return shown(sum, place);
}

Mask Grid::zero(std::size_t node) const
{
    const std::array<int, 4> i = indices(node);
    Mask mask = 0;
    if (i[0] == 0 || i[1] == 0)
        mask |= kMirrorY;
    if (i[0] == 0 || i[1] == size - 1)
        mask |= kMirrorX;
    return mask;
}

std::pair<std::size_t, std::size_t> Grid::first_equal(std::size_t node_index, std::size_t element) const
{
    const std::array<int, 4> i = indices(node_index);
    const int phi = i[0] == 0 ? 0 : i[1];
    std::pair<std::size_t, std::size_t> first = {node(i[0], phi, i[2], i[3]), element};
    if (i[3] == size - 1) { // element of P M P: both its row and its column exchanged
        static constexpr std::size_t kExchanged[9] = {4, 3, 5, 1, 0, 2, 7, 6, 8};
        first = std::min(first, {node(i[0], i[0] == 0 ? 0 : size - 1 - phi, i[2], i[3]), kExchanged[element]});
    }
    return first;
}

Place usable_place(const std::array<double, 4>& u)
{
    const double root = 0.1 + 0.9 * u[2];
    return {u[0] * (89.0 / 180.0 * kPi), u[1] * (0.5 * kPi), root * root, 0.02 + 0.98 * u[3]};
}

} // namespace burnish::ltc
