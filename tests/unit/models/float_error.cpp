#include "tests/unit/models/float_error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

Extent extent_of(std::vector<double>& all)
{
    std::sort(all.begin(), all.end());
    return all.empty() ? Extent{} : Extent{all.back(), all[all.size() - 1 - all.size() / 1000]};
}

} // namespace

double ulp(double reference, double least)
{
    int exponent;
    std::frexp(std::max(std::abs(reference), least), &exponent);
    return std::ldexp(1.0, exponent - 24);
}

std::vector<double> sway(const Kernel& exact, const std::vector<double>& in)
{
    const std::vector<double> at = run(exact, in);
    std::vector<double> largest(at.size());
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        std::vector<double> nudged = in;
        for (double& x : nudged)
            x *= 1 + (std::floor(3 * random.next()) - 1) * 0x1p-23;
        const std::vector<double> moved = run(exact, nudged);
        for (std::size_t k = 0; k < at.size(); ++k)
            largest[k] = std::max(largest[k], std::abs(moved[k] - at[k]));
    }
    return largest;
}

void Errors::add(double value, double reference, double last_place, double moved)
{
    in_ulp.push_back(std::abs(value - reference) / last_place);
    in_sway.push_back(std::abs(value - reference) / (last_place + moved));
}

void Errors::expect_within(Extent bound, const char* function, const char* result)
{
    ASSERT_FALSE(in_ulp.empty()) << function << " " << result;
    const Extent ulps = extent_of(in_ulp), seen = extent_of(in_sway);
    std::printf("%s %s: largest error %.1f ulp, one in a thousand above %.1f; %.1f and %.1f of what a float's step moves\n", function,
                result, ulps.largest, ulps.common, seen.largest, seen.common);
    EXPECT_LE(seen.largest, bound.largest) << function << " " << result;
    EXPECT_LE(seen.common, bound.common) << function << " " << result;
}

} // namespace burnish::test
