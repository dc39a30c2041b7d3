// Node positions in a table of transformed cosines, and interpolation between them.
#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "shading/bake/ltc/place.h"

namespace burnish::ltc {

// Elements of a matrix that are zero by symmetry: bit 3 row + column.
using Mask = std::uint32_t;
inline constexpr Mask kMirrorY = 1u << 1 | 1u << 3 | 1u << 5 | 1u << 7; // the eye lies in the plane y = 0
inline constexpr Mask kMirrorX = 1u << 1 | 1u << 2 | 1u << 3 | 1u << 6; // in x = 0

struct Corner {
    std::size_t node;
    double weight;
};
using Corners = std::array<Corner, 16>;

// Frame of the entries: the tangent frame, the tangent frame rotated to take the normal to the mirror direction, or the natural matrix.
enum class Basis { tangent, mirror, natural };

// A grid with `size` nodes along each of theta, phi, alpha and lambda, from 0 to pi/2, pi/2, 1 and 1, and `beyond` more along alpha with
// the same spacing. Nodes with degenerate lobes stand for the lobe just beside. A round grid has nodes along theta and alpha alone: its
// lobes have equal widths along x and y.
struct Grid {
    int size = 8;
    int beyond = 3;         // with 8 nodes along an axis: up to alpha 2.04
    bool round = false;     // also: nodes are even in sqrt(1 - cos theta)
    bool root_alpha = true; // nodes are even in the root of alpha; else in alpha
    bool over_alpha = true; // the first two columns are divided by alpha, which makes narrow lobes alike
    bool inverse = false;   // stores inverse matrices, in the tangent frame
    Basis basis = Basis::mirror;

    static constexpr double kLeastAlpha = 1e-3, kLeastLambda = 0.01, kMostTheta = 89.5 / 180.0 * 3.14159265358979323846;

    // Numbers of nodes along theta, phi, alpha, lambda.
    std::array<int, 4> sizes() const { return {size, round ? 1 : size, size + beyond, round ? 1 : size}; }
    std::size_t nodes() const;
    std::size_t node(int theta, int phi, int alpha, int lambda) const;
    std::array<int, 4> indices(std::size_t node) const; // theta, phi, alpha, lambda
    Place place(std::size_t node) const;                // the lobe at a node
    Corners corners(const Place& place) const;
    std::vector<std::array<int, 4>> cells() const; // their least nodes, in node order; not for round grids
    Place between(int theta, int phi, int alpha, int lambda, const std::array<double, 4>& u) const; // in the cell, u in [0,1]
    Matrix frame(const Place& place) const; // frame of the basis: matrix = frame entry widths
    double width(const Place& place) const { return over_alpha ? place.alpha : 1.0; }
    double alpha_at(double node) const; // node counts from 0
    double most_alpha() const { return alpha_at(sizes()[2] - 1.0); }

    // Converts a matrix to a stored entry, and back.
    Matrix held(const Matrix& m, const Place& place) const;
    Matrix shown(const Matrix& entry, const Place& place) const;
    Matrix lookup(const std::vector<Matrix>& entries, const Place& place) const;

    Mask zero(std::size_t node) const; // elements that symmetry makes 0
    // Returns the first {node, element} that must equal this one by symmetry. At theta 0, one lobe serves all phi. At lambda 1, phi and
    // pi/2 - phi are mirror images.
    std::pair<std::size_t, std::size_t> first_equal(std::size_t node, std::size_t element) const;
};

Grid grid_of(int size); // a grid that exceeds alpha 2
Grid round_grid();      // the grid for shading: 64 nodes along an axis, plain matrices, alpha to 1

// Returns a place for test lookups: alpha from .01 to `most_alpha`, lambda from .02, theta to 89 degrees. u in [0,1]^4; even in the square
// root of alpha.
Place usable_place(const std::array<double, 4>& u, double most_alpha);

} // namespace burnish::ltc
