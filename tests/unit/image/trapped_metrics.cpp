// Compiles the metrics of `compare` by clang++ with UndefinedBehaviorSanitizer's traps, which find pointers that wrap. g++ does not find
// them. These objects replace the library's.
#include "core/image/metrics/flip.cpp"
#include "core/image/metrics/flip_filters.cpp"
#include "core/image/metrics/metrics.cpp"
#include "core/image/metrics/ssim.cpp"
#include "core/image/metrics/z_scores.cpp"
