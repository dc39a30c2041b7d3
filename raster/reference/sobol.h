// Sample points for one pixel's pass: 64 Sobol points in five dimensions, Owen-scrambled anew per pixel and pass (samples.h). So passes
// are independent, and their spread gives the error of their mean.
#pragma once
#include <cstdint>

namespace burnish {

inline constexpr int kPassPositions = 16; // camera positions per pixel and pass
inline constexpr int kPassShades = 4;     // light samples at each position, at most
inline constexpr int kPassSamples = kPassPositions * kPassShades;
inline constexpr int kSobolDimensions = 5;

// points[dimension][index], bits reversed: scrambling expects the most significant digit at bit 0.
struct SobolTable {
    std::uint32_t points[kSobolDimensions][kPassSamples];
};
const SobolTable& sobol_table();

} // namespace burnish
