// Float errors against the double oracle, in units of the last place (ulp) and in units of unavoidable rounding.
#pragma once
#include <cstdint>
#include <vector>

#include "tests/unit/lanes/kernels.h"

namespace burnish::test {

// Returns the last place of a float as large as `reference`, or as large as `least` if reference is smaller. Below 1e-24 a lobe's tail may
// be cut off.
double ulp(double reference, double least = 1e-24);

// Returns how far `exact`'s results move when arguments move by one float step or stay: the largest of six tries. The density of a lobe of
// width 0.001 moves by thousands of ulp. A refraction's cosine moves without bound where the facet is seen edge on.
std::vector<double> sway(const Kernel& exact, const std::vector<double>& in);

// The largest of many errors, and the error that one in a thousand exceeds.
struct Extent {
    double largest, common;
};

// Errors for one kind of result, in ulp and in multiples of ulp plus sway.
class Errors {
  public:
    void add(double value, double reference, double last_place, double moved);
    // Prints both. Expects the multiples of ulp plus sway to stay within `bound`.
    void expect_within(Extent bound, const char* function, const char* result);

  private:
    std::vector<double> in_ulp, in_sway;
};

} // namespace burnish::test
