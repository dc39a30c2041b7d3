#include "shading/bake/ltc/grid.h"

#include <algorithm>

#include "core/math/scalar_math.h"

namespace burnish::ltc {

std::size_t Grid::nodes() const
{
    std::size_t count = 1;
    for (int n : sizes())
        count *= static_cast<std::size_t>(n);
    return count;
}

std::size_t Grid::node(int theta, int phi, int alpha, int lambda) const
{
    const int at[4] = {theta, phi, alpha, lambda};
    const std::array<int, 4> n = sizes();
    std::size_t node = 0;
    for (std::size_t a = 0; a < 4; ++a)
        node = node * static_cast<std::size_t>(n[a]) + static_cast<std::size_t>(at[a]);
    return node;
}

std::array<int, 4> Grid::indices(std::size_t node) const
{
    const std::array<int, 4> n = sizes();
    std::array<int, 4> at{};
    for (std::size_t a = 4; a-- > 0; node /= static_cast<std::size_t>(n[a]))
        at[a] = static_cast<int>(node % static_cast<std::size_t>(n[a]));
    return at;
}

double Grid::alpha_at(double node) const
{
    const double u = node / (size - 1.0);
    return root_alpha ? u * u : u;
}

Place Grid::between(int theta, int phi, int alpha, int lambda, const std::array<double, 4>& u) const
{
    const double last = size - 1.0, t = (theta + u[0]) / last;
    Place place = {t * (0.5 * kPi), (phi + u[1]) / last * (0.5 * kPi), alpha_at(alpha + u[2]), (lambda + u[3]) / last};
    if (round) {
        const double z = 1.0 - t * t;
        place.theta = det_atan2(std::sqrt(std::max(0.0, 1.0 - z * z)), z);
        place.phi = 0.0, place.lambda = 1.0;
    }
    return place;
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
    const double theta = round ? std::sqrt(std::max(0.0, 1.0 - det_cos(place.theta))) : place.theta * (2.0 / kPi);
    const double u[4] = {theta, place.phi * (2.0 / kPi), root_alpha ? std::sqrt(place.alpha) : place.alpha, place.lambda};
    const std::array<int, 4> n = sizes();
    int low[4], high[4];
    double part[4];
    for (std::size_t a = 0; a < 4; ++a) {
        const double at = std::clamp(u[a] * (size - 1.0), 0.0, n[a] - 1.0);
        low[a] = std::clamp(static_cast<int>(at), 0, std::max(0, n[a] - 2));
        high[a] = std::min(low[a] + 1, n[a] - 1);
        part[a] = at - low[a];
    }
    Corners corners;
    for (int c = 0; c < 16; ++c) {
        int i[4];
        double weight = 1.0;
        for (int a = 0; a < 4; ++a) {
            const int up = c >> a & 1;
            i[a] = up ? high[a] : low[a];
            weight *= up ? part[a] : 1.0 - part[a];
        }
        corners[static_cast<std::size_t>(c)] = {node(i[0], i[1], i[2], i[3]), weight};
    }
    return corners;
}

std::vector<std::array<int, 4>> Grid::cells() const
{
    std::vector<std::array<int, 4>> all;
    for (std::size_t k = 0; k < nodes(); ++k)
        if (const std::array<int, 4> i = indices(k); i[0] < size - 1 && i[1] < size - 1 && i[2] < sizes()[2] - 1 && i[3] < size - 1)
            all.push_back(i);
    return all;
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
    if (inverse)
        return with_unit_axis(burnish::ltc::inverse(m));
    const double s = 1.0 / width(place);
    return with_unit_axis(burnish::ltc::inverse(frame(place)) * m * Matrix{s, 0.0, 0.0, 0.0, s, 0.0, 0.0, 0.0, 1.0});
}

Matrix Grid::shown(const Matrix& entry, const Place& place) const
{
    if (inverse)
        return burnish::ltc::inverse(entry);
    const double s = width(place);
    return frame(place) * entry * Matrix{s, 0.0, 0.0, 0.0, s, 0.0, 0.0, 0.0, 1.0};
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
    if (i[0] == 0 || (!round && i[1] == size - 1))
        mask |= kMirrorX;
    return mask;
}

std::pair<std::size_t, std::size_t> Grid::first_equal(std::size_t node_index, std::size_t element) const
{
    const std::array<int, 4> i = indices(node_index);
    if (round) // along the normal, x and y are equivalent
        return {node_index, i[0] == 0 && element == 4 ? 0 : element};
    const int phi = i[0] == 0 ? 0 : i[1];
    std::pair<std::size_t, std::size_t> first = {node(i[0], phi, i[2], i[3]), element};
    // In the tangent frame, matrices seen along x = y are their own mirror images except for their gauge.
    const bool own_image = basis == Basis::tangent && i[0] != 0 && 2 * phi == size - 1;
    if (i[3] == size - 1 && !own_image) { // an element of P M P: both its row and its column exchanged
        static constexpr std::size_t kExchanged[9] = {4, 3, 5, 1, 0, 2, 7, 6, 8};
        first = std::min(first, {node(i[0], i[0] == 0 ? 0 : size - 1 - phi, i[2], i[3]), kExchanged[element]});
    }
    return first;
}

Grid grid_of(int size)
{
    Grid grid;
    grid.size = size;
    grid.beyond = static_cast<int>(std::ceil((std::sqrt(2.0) - 1.0) * (size - 1.0)));
    return grid;
}

Grid round_grid()
{
    Grid grid;
    grid.size = 64, grid.beyond = 0, grid.round = true, grid.over_alpha = false, grid.basis = Basis::tangent;
    return grid;
}

Place usable_place(const std::array<double, 4>& u, double most_alpha)
{
    const double root = 0.1 + (std::sqrt(most_alpha) - 0.1) * u[2];
    return {u[0] * (89.0 / 180.0 * kPi), u[1] * (0.5 * kPi), root * root, 0.02 + 0.98 * u[3]};
}

} // namespace burnish::ltc
