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

// `size` nodes along each of theta, phi, alpha and lambda, from 0 to pi/2, pi/2, 1 and 1, and `beyond` more of alpha with the same steps.
// Nodes where lobes are degenerate stand for the lobe just beside. A round grid has nodes along theta and alpha alone: its lobes are as
// wide along x as along y.
struct Grid {
    int size = 8;
    int beyond = 3;         // of 8 nodes along an axis: up to alpha 2.04
    bool round = false;     // also: nodes lie evenly in sqrt(1 - cos theta)
    bool root_alpha = true; // nodes lie evenly in the root of alpha; else in alpha
    bool over_alpha = true; // the first two columns are held over alpha: of narrow lobes they are then alike
    bool inverse = false;   // inverse matrices are held, in the tangent frame
    Basis basis = Basis::mirror;

    static constexpr double kLeastAlpha = 1e-3, kLeastLambda = 0.01, kMostTheta = 89.5 / 180.0 * 3.14159265358979323846;

    // Nodes along theta, phi, alpha, lambda.
    std::array<int, 4> sizes() const { return {size, round ? 1 : size, size + beyond, round ? 1 : size}; }
    std::size_t nodes() const;
    std::size_t node(int theta, int phi, int alpha, int lambda) const;
    std::array<int, 4> indices(std::size_t node) const; // theta, phi, alpha, lambda
    Place place(std::size_t node) const;                // of the lobe that it stands for
    Corners corners(const Place& place) const;
    std::vector<std::array<int, 4>> cells() const; // their least nodes, in the order of nodes; of grids that are not round
    Place between(int theta, int phi, int alpha, int lambda, const std::array<double, 4>& u) const; // in the cell, u in [0,1]
    Matrix frame(const Place& place) const; // of the basis: matrix = frame entry widths
    double width(const Place& place) const { return over_alpha ? place.alpha : 1.0; }
    double alpha_at(double node) const; // counted from 0
    double most_alpha() const { return alpha_at(sizes()[2] - 1.0); }

    // The matrix as entries hold it and back.
    Matrix held(const Matrix& m, const Place& place) const;
    Matrix shown(const Matrix& entry, const Place& place) const;
    Matrix lookup(const std::vector<Matrix>& entries, const Place& place) const;

    Mask zero(std::size_t node) const; // elements that symmetry makes 0
    // The element that has to be equal by symmetry and comes first: {node, element}. Where theta is 0, all phi are one lobe; where lambda
    // is 1, phi and pi/2 - phi are each other's mirror image.
    std::pair<std::size_t, std::size_t> first_equal(std::size_t node, std::size_t element) const;
};

Grid grid_of(int size); // that goes beyond alpha 2
Grid round_grid();      // as shading reads it: 64 nodes along an axis, matrices themselves, alpha to 1

// Of lookups: alpha from .01 to `most_alpha`, lambda from .02, theta to 89 degrees. u in [0,1]^4; evenly in the square root of alpha.
Place usable_place(const std::array<double, 4>& u, double most_alpha);

} // namespace burnish::ltc
