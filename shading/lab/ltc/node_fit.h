// Fits a transformed cosine to one lobe, by the integrated absolute difference (L1, twice the total variation).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "shading/bake/ltc/grid.h"
#include "shading/lab/ltc/lobe.h"

namespace burnish::ltc {

// Sums over points from both densities (multiple importance sampling, balance heuristic): the L1 distance and the normal equations of its
// iteratively reweighted least squares, in E with M' = M (I + E)^-1. hessian: the upper triangle by rows.
struct Sums {
    double l1 = 0.0;
    std::array<double, 45> hessian{};
    std::array<double, 9> gradient{}; // of descent
};

// A lobe with points from its visible normals, which do not move with the matrix.
struct LobePoints {
    LobePoints(const Lobe& lobe, const Rule& rule); // a lobe with known albedo; `rule` must outlive the points
    Lobe lobe;
    const Rule* rule;
    struct Point {
        Vec l;
        Reflected value;
    };
    std::vector<Point> points;
};

// Objective of a fit: the integral over |p - q|, the integral over |p - q|^3 (Heitz et al. 2016), or the transport distance between
// samples along many axes (sliced Wasserstein distance; KT et al. 2022).
enum class Norm { l1, l3, sliced };

double l1_distance(const LobePoints& lobe, const Matrix& m);
Sums sums_of(const LobePoints& lobe, const Matrix& m, Norm norm = Norm::l1); // l1: by the norm, which must not be the sliced one

struct NodeFit {
    Matrix m;
    double l1;
    int evaluations;
};

// Runs Levenberg-Marquardt from `start`, which has a positive determinant. The result has a positive determinant and a unit third column.
NodeFit fit_lobe(const LobePoints& lobe, const Matrix& start, Mask zero, Norm norm = Norm::l1);

// Minimises the sliced distance with a fixed number of gradient steps. The result's l1 is the L1 distance, as in `fit_lobe`.
NodeFit fit_sliced(const LobePoints& lobe, const Matrix& start, Mask zero);

} // namespace burnish::ltc
