// The points that a pass of one pixel is sampled at: 64 points of Sobol's sequence in five dimensions, Owen-scrambled anew for every
// pixel and pass (samples.h). Passes are therefore independent of each other, and their spread tells the error of their mean.
#pragma once
#include <cstdint>

namespace burnish {

inline constexpr int kPassPositions = 16; // camera positions of a pixel in one pass
inline constexpr int kPassShades = 4;     // samples of the light at each
inline constexpr int kPassSamples = kPassPositions * kPassShades;
inline constexpr int kSobolDimensions = 5;

// points[dimension][index], bits reversed: what is scrambled has its most significant digit at bit 0.
struct SobolTable {
    std::uint32_t points[kSobolDimensions][kPassSamples];
};
const SobolTable& sobol_table();

} // namespace burnish
