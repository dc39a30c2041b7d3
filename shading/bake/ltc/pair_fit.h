// The sum of two transformed cosines that is the nearest to one lobe, by L1: what a second one could gain where one alone is far off.
#pragma once
#include "shading/bake/ltc/node_fit.h"

namespace burnish::ltc {

struct PairFit {
    Matrix m[2];  // positive determinants, unit third columns
    double share; // of the first one, in [0.02, 0.98]
    double l1;
    int evaluations;
};

// Levenberg-Marquardt on both matrices and the share at once, from a fit of one that is split: into a narrow and a wide one, along each of
// its first two columns and both ways along them. The nearest of what comes of it.
PairFit fit_pair(const LobePoints& lobe, const Matrix& single);

double l1_of_pair(const LobePoints& lobe, const PairFit& pair);

} // namespace burnish::ltc
