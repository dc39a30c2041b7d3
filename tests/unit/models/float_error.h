// How far float results are from the double oracle, in units of the last place and in units of what no float version can be
// held to less than.
#pragma once
#include <cstdint>
#include <vector>

#include "tests/unit/lanes/kernels.h"

namespace burnish::test {

// The last place of a float of the size of `truth`, or of `least` where truth is smaller. 1e-24: what is left of a lobe there
// may be cut off.
double ulp(double truth, double least = 1e-24);

// How far results of `exact` move when arguments move by a float's step or not at all: the largest of
// six tries. The density of a lobe of width 0.001 moves by thousands of ulp, a refraction's cosine without bound where the facet
// is seen edge on.
std::vector<double> sway(const Kernel& exact, const std::vector<double>& in);

// The largest of many errors, and that which one in a thousand exceeds.
struct Extent {
    double largest, common;
};

// Errors of one kind of result: in ulp, and as multiples of ulp and sway together.
class Errors {
  public:
    void add(double value, double truth, double last_place, double moved);
    // Prints both; expects the multiples of ulp and sway to stay within `bound`.
    void expect_within(Extent bound, const char* function, const char* result);

  private:
    std::vector<double> in_ulp, in_sway;
};

} // namespace burnish::test
