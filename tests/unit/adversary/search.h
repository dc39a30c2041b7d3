// Searches for the inputs at which a kernel's floats are furthest from its double oracle: random ones, then climbing from the worst.
#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/lanes/kernels.h"

namespace burnish::test {

// What an error is measured in, besides what a float's step of the inputs moves the oracle by.
enum class Unit {
    last_place, // of a float of the result's size, of at least 1e-12: what is less is not seen
    whole,      // of a float of 1: directions, cosines, weights
};

// Some of a kernel's results that are one thing.
struct Judged {
    const char* name;
    int first, count;
    Unit unit;
};

// A kernel with all inputs that it has to bear. A point is made of `numbers` numbers in [0,1), so that whatever a search tries is valid.
struct Domain {
    std::string kernel;
    int numbers;
    std::vector<double> (*make)(const Domain& d, const double* u); // the kernel's arguments
    std::vector<Judged> judged;
    int same = -1; // a result; points where floats and doubles differ in it are left out: samples that one of both rejects
    TexelView (*texels)() = nullptr;
    std::vector<std::vector<double>> of = {}; // what `make` reads: ranges of parameters
};

inline void PrintTo(const Domain& d, std::ostream* out) // gtest would print bytes, addresses among them
{
    *out << d.kernel;
}

struct Worst {
    double score = 0.0;     // the error in units and sway
    double units = 0.0;     // in units alone
    double absolute = 0.0;  // |float - double|
    std::vector<double> in; // the kernel's arguments, floats
};

// How far off the result j of d is at the points `in` (as Kernel::run has them), each; infinite where floats are no numbers and doubles
// are.
std::vector<Worst> errors_at(const Domain& d, const Judged& j, const std::vector<double>& in);

// The worst of `count` random points and of what is climbed to from the worst of them, one in 4000 (25 to 1000): coordinates of [0,1) go up
// and down by steps from 1/4 to 2^-44, as long as the score grows. Deterministic.
std::vector<Worst> search(const Domain& d, double count, std::uint64_t seed);

} // namespace burnish::test
