// Searches for the inputs where a kernel's floats deviate most from its double oracle: random points, then hill climbing from the worst.
#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/lanes/kernels.h"

namespace burnish::test {

// An error's unit. The oracle's movement by one float step in the inputs is added to the unit.
enum class Unit {
    last_place, // of a float as large as the result, at least 1e-12: smaller values are invisible
    whole,      // of a float near 1: directions, cosines, weights
};

// Results of a kernel that are judged together.
struct Judged {
    const char* name;
    int first, count;
    Unit unit;
};

// A kernel with its domain. A point consists of `numbers` numbers in [0,1), so every search point is valid.
struct Domain {
    std::string kernel;
    int numbers;
    std::vector<double> (*make)(const Domain& d, const double* u); // the kernel's arguments
    std::vector<Judged> judged;
    int same = -1; // index of a result; skips points where it differs between floats and doubles (samples that one version rejects)
    TexelView (*texels)() = nullptr;
    std::vector<std::vector<double>> of = {}; // ranges of parameters for `make`
};

inline void PrintTo(const Domain& d, std::ostream* out) // gtest would print bytes, including addresses
{
    *out << d.kernel;
}

struct Worst {
    double score = 0.0;     // the error in units and sway
    double units = 0.0;     // in units alone
    double absolute = 0.0;  // |float - double|
    std::vector<double> in; // the kernel's arguments, floats
};

// Returns the error of d's result j at each point in `in` (laid out as in Kernel::run). The error is infinite where floats give NaN or
// infinity and doubles do not.
std::vector<Worst> errors_at(const Domain& d, const Judged& j, const std::vector<double>& in);

// Returns the worst of `count` random points after hill climbing from the worst, one in 4000 (25 to 1000). Climbing moves coordinates in
// [0,1) up and down by steps from 1/4 to 2^-44, as long as the score grows. The search is deterministic.
std::vector<Worst> search(const Domain& d, double count, std::uint64_t seed);

} // namespace burnish::test
