// Deviation of bin counts from their expectation, in standard deviations.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace burnish::test {

// Returns the standard deviations by which a chi-square exceeds its degrees of freedom (Wilson and Hilferty 1931).
inline double chi_square_sigmas(double chi2, double degrees)
{
    const double k = 2.0 / (9.0 * degrees);
    return (std::cbrt(chi2 / degrees) - (1.0 - k)) / std::sqrt(k);
}

// Returns the deviation of counts `seen` from `expected`. Pools bins with small expectations.
inline double sigmas_of(const std::vector<double>& seen, const std::vector<double>& expected)
{
    double chi2 = 0.0, pool_seen = 0.0, pool_expected = 0.0;
    int degrees = -1;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (expected[i] < 8.0) {
            pool_seen += seen[i], pool_expected += expected[i];
            continue;
        }
        chi2 += (seen[i] - expected[i]) * (seen[i] - expected[i]) / expected[i];
        ++degrees;
    }
    if (pool_expected > 0.5) {
        chi2 += (pool_seen - pool_expected) * (pool_seen - pool_expected) / pool_expected;
        ++degrees;
    } else {
        EXPECT_LE(pool_seen, 10.0) << "samples where none should be";
    }
    return chi_square_sigmas(chi2, degrees);
}

} // namespace burnish::test
