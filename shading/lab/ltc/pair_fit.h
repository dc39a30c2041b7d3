// Fits the sum of two transformed cosines to one lobe, by L1. This measures the gain from a second cosine where one alone is inaccurate.
#pragma once
#include "shading/lab/ltc/node_fit.h"

namespace burnish::ltc {

struct PairFit {
    Matrix m[2];  // positive determinants, unit third columns
    double share; // of the first cosine, in [0.02, 0.98]
    double l1;
    int evaluations;
};

// Runs Levenberg-Marquardt on both matrices and the share at once. Starts split a single fit: into a narrow and a wide cosine, and apart
// along each of its first two columns. Returns the best result.
PairFit fit_pair(const LobePoints& lobe, const Matrix& single);

double l1_of_pair(const LobePoints& lobe, const PairFit& pair);

} // namespace burnish::ltc
