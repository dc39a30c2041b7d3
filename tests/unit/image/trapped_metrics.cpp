// The figures of `compare` as clang++ compiles them with UndefinedBehaviorSanitizer's traps: it sees pointers that wrap, which g++ does
// not. They take the place of those in the library.
#include "core/image/metrics/flip.cpp"
#include "core/image/metrics/flip_filters.cpp"
#include "core/image/metrics/metrics.cpp"
#include "core/image/metrics/ssim.cpp"
#include "core/image/metrics/z_scores.cpp"
