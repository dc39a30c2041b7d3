// How two renderers' frames differ, stage by stage: what `burnish parity` counts.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "raster/frame/frame.h"

namespace burnish {

struct ParityStage {
    std::string name;
    std::uint64_t values = 0, words_differ = 0;
    std::uint64_t max_ulp = 0;      // largest distance of two words as ordered floats
    int worst_x = -1, worst_y = -1; // pixel of it; -1: not of a pixel (clip positions)
    bool equal() const { return words_differ == 0; }
};

struct ParityCounts {
    std::uint64_t samples = 0, visibility_differ = 0;        // a sample differs where its triangle does
    std::uint64_t pixels_differ = 0, edge_pixels_differ = 0; // of the resolved picture; of them, pixels that show several triangles
    std::vector<ParityStage>
        stages; // clip positions, visibility, depth, interpolants, material inputs, shaded colour, resolved colour, layers
};

inline constexpr const char* kVisibilityStage = "visibility";

// Both frames with FrameDesc::stages, of one description; clip positions only where both have them. What follows visibility is compared
// where visibility agrees: depths by sample, interpolants to shaded colour by pairs of the same triangle and the same samples, resolved
// colour and layers, where both have them, in pixels whose pairs are all the same.
ParityCounts compare_stages(const Frame& tile, const Frame& other, int msaa);

// Why a pixel differs: the first stage that differs by more than kRounding of a vector's largest component, in any of the pixel's
// (pixel, triangle) pairs; what differs by less in all of them is rounded otherwise.
enum class PixelCause : std::uint8_t { none, visibility, interpolants, material, shaded, resolved, rounding };
inline constexpr int kPixelCauses = 7;
inline constexpr const char* kPixelCauseNames[kPixelCauses] = {"equal",         "visibility",      "interpolants", "material inputs",
                                                               "shaded colour", "resolved colour", "rounding"};
inline constexpr double kRounding = 1e-3;
std::vector<PixelCause> pixel_causes(const Frame& tile, const Frame& other, int msaa); // [pixel]

struct CauseShare {
    PixelCause cause = PixelCause::none;
    std::uint64_t pixels = 0, edge_pixels = 0; // edge: several triangles in the pixel
    double flip = 0.0;                         // what these pixels add to the picture's mean FLIP
};
// By cause, without those that no pixel has. flip: error of each pixel, or null where it is 0 everywhere. The sum of all `flip` is the
// mean.
std::vector<CauseShare> share_causes(const std::vector<PixelCause>& causes, const Frame& tile, int msaa, const float* flip);

// The first stage that differs; null where none does.
const ParityStage* first_difference(const ParityCounts& counts);

std::uint64_t ulp_distance(std::uint32_t a, std::uint32_t b); // of floats by their bits; -0 and +0 are one apart

} // namespace burnish
