// Linear solver for Levenberg-Marquardt steps.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

namespace burnish::ltc {

// Solves (H + mu (diag H + .01 trace H)) x = b by Cholesky. Unknowns in `zero` (by bit) stay 0. hessian: its upper triangle by rows.
// Returns false if the matrix is not positive definite.
template <std::size_t n>
bool levenberg_marquardt_step(const std::array<double, n*(n + 1) / 2>& hessian, const std::array<double, n>& gradient, double mu,
                              std::uint32_t zero, std::array<double, n>& x)
{
    double a[n][n], trace = 0.0;
    // Expand the matrix, and damp its diagonal
    const double* h = hessian.data();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i; j < n; ++j)
            a[j][i] = a[i][j] = *h++;
    for (std::size_t i = 0; i < n; ++i)
        trace += a[i][i];
    x = gradient;
    for (std::size_t i = 0; i < n; ++i)
        a[i][i] += mu * (a[i][i] + 0.01 * trace);
    // Remove fixed unknowns
    for (std::size_t i = 0; i < n; ++i)
        if (zero >> i & 1u) {
            for (std::size_t j = 0; j < n; ++j)
                a[i][j] = a[j][i] = 0.0;
            a[i][i] = 1.0;
            x[i] = 0.0;
        }
    for (std::size_t i = 0; i < n; ++i) { // Cholesky, the lower triangle in place
        for (std::size_t j = 0; j <= i; ++j) {
            double s = a[i][j];
            for (std::size_t k = 0; k < j; ++k)
                s -= a[i][k] * a[j][k];
            if (i != j)
                a[i][j] = s / a[j][j];
            else if (s > 0.0)
                a[i][i] = std::sqrt(s);
            else
                return false;
        }
    }
    // Substitute forwards, then backwards
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k)
            x[i] -= a[k][i] * x[k];
        x[i] /= a[i][i];
    }
    return true;
}

} // namespace burnish::ltc
