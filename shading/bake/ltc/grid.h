// The places that a table of transformed cosines has entries for, and what lies between them.
#pragma once
#include <array>
#include <vector>

#include "shading/bake/ltc/lobe.h"
#include "shading/bake/ltc/node_fit.h"

namespace burnish::ltc {

struct Corner {
    std::size_t node;
    double weight;
};
using Corners = std::array<Corner, 16>;

// What entries are seen from: the tangent frame, its turn that takes the normal to the mirror direction, or the natural matrix.
enum class Basis { tangent, mirror, natural };

// `size` nodes along each of theta, phi, the square root of alpha and lambda, from 0 to pi/2, pi/2, 1 and 1. Nodes where lobes are
// degenerate stand for the lobe just beside.
struct Grid {
    int size = 8;
    bool root_alpha = true; // nodes at (k / (size - 1))^2; else at k / (size - 1)
    Basis basis = Basis::mirror;

    static constexpr double kLeastAlpha = 1e-3, kLeastLambda = 0.01, kMostTheta = 89.5 / 180.0 * 3.14159265358979323846;

    std::size_t nodes() const { return static_cast<std::size_t>(size) * n() * n() * n(); }
    std::size_t node(int theta, int phi, int alpha, int lambda) const;
    std::array<int, 4> indices(std::size_t node) const; // theta, phi, alpha, lambda
    Place place(std::size_t node) const;                // of the lobe that it stands for
    Corners corners(const Place& place) const;
    Place between(int theta, int phi, int alpha, int lambda, const std::array<double, 4>& u) const; // in the cell, u in [0,1]
    Matrix frame(const Place& place) const;                                                         // of the basis: matrix = frame entry

    // The matrix as entries hold it and back.
    Matrix held(const Matrix& m, const Place& place) const;
    Matrix shown(const Matrix& entry, const Place& place) const;
    Matrix lookup(const std::vector<Matrix>& entries, const Place& place) const;

    Mask zero(std::size_t node) const; // elements that symmetry makes 0
    // The element that has to be equal by symmetry and comes first: {node, element}. Where theta is 0, all phi are one lobe; where lambda
    // is 1, phi and pi/2 - phi are each other's mirror image.
    std::pair<std::size_t, std::size_t> first_equal(std::size_t node, std::size_t element) const;

  private:
    std::size_t n() const { return static_cast<std::size_t>(size); }
};

// Of lookups: alpha from .01, lambda from .02, theta to 89 degrees. u in [0,1]^4; evenly in the square root of alpha.
Place usable_place(const std::array<double, 4>& u);

} // namespace burnish::ltc
