// The transformed cosine that is the nearest to one lobe, by the integral of the absolute difference (L1, twice the total variation).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "shading/bake/ltc/lobe.h"

namespace burnish::ltc {

// Sums over points of both densities (multiple importance sampling, balance heuristic): the L1 distance and, of its iteratively reweighted
// least squares, the normal equations in E of M' = M (I + E)^-1. hessian: the upper triangle by rows.
struct Sums {
    double l1 = 0.0;
    std::array<double, 45> hessian{};
    std::array<double, 9> gradient{}; // of descent
};

// A lobe with the points of its visible normals, which do not move with the matrix.
struct LobePoints {
    LobePoints(const Lobe& lobe, const Rule& rule); // whose albedo is known; `rule` must outlive it
    Lobe lobe;
    const Rule* rule;
    struct Point {
        Vec l;
        Reflected value;
    };
    std::vector<Point> points;
};

// What a fit makes small: the integral of |p - q|, of its third power (Heitz et al. 2016), or how far samples of one have to be carried to
// be samples of the other, along many axes (the sliced Wasserstein distance; KT et al. 2022).
enum class Norm { l1, l3, sliced };

double l1_distance(const LobePoints& lobe, const Matrix& m);
Sums sums_of(const LobePoints& lobe, const Matrix& m, Norm norm = Norm::l1); // l1: of the norm, which is not the sliced one

// Elements of M, and of E, that are zero by symmetry: bit 3 row + column.
using Mask = std::uint32_t;
inline constexpr Mask kMirrorY = 1u << 1 | 1u << 3 | 1u << 5 | 1u << 7; // the eye lies in the plane y = 0
inline constexpr Mask kMirrorX = 1u << 1 | 1u << 2 | 1u << 3 | 1u << 6; // in x = 0

struct NodeFit {
    Matrix m;
    double l1;
    int evaluations;
};

// Levenberg-Marquardt from `start`, which has a positive determinant; the result has one too, and a unit third column.
NodeFit fit_lobe(const LobePoints& lobe, const Matrix& start, Mask zero, Norm norm = Norm::l1);

// By the sliced distance: steps along its gradient, as many for every lobe. l1 of the result is that of `fit_lobe`.
NodeFit fit_sliced(const LobePoints& lobe, const Matrix& start, Mask zero);

} // namespace burnish::ltc
