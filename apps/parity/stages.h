// Compares two renderers' frames stage by stage, for `burnish parity`.
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
    int worst_x = -1, worst_y = -1; // pixel with max_ulp; -1: not in a pixel (clip positions)
    bool equal() const { return words_differ == 0; }
};

struct ParityCounts {
    std::uint64_t samples = 0, visibility_differ = 0;        // a sample differs if its triangle differs
    std::uint64_t pixels_differ = 0, edge_pixels_differ = 0; // in the resolved picture; those with several triangles in the pixel
    std::vector<ParityStage>
        stages; // clip positions, visibility, depth, interpolants, material inputs, shaded colour, resolved colour, layers, shadowed colour
};

inline constexpr const char* kVisibilityStage = "visibility";

// Compares frames with FrameDesc::stages, of one description. Clip positions are compared if both frames have them. Later stages are
// compared where visibility agrees. Depths are compared by sample. Interpolants to shaded colour are compared by pairs with the same
// triangle and samples. Resolved colour, and layers if both frames have them, are compared in pixels with equal pairs.
ParityCounts compare_stages(const Frame& tile, const Frame& other, int msaa);

// Compares two pictures' colours under a stage's name, in the pixels where both frames have equal pairs.
ParityStage compare_colours(const char* name, const Image& of_tile, const Image& of_other, const Frame& tile, const Frame& other, int msaa);

// The first stage with a difference above kRounding times the largest vector component, in any (pixel, triangle) pair of the pixel.
// `rounding` if no pair has such a difference.
enum class PixelCause : std::uint8_t { none, visibility, interpolants, material, shaded, resolved, rounding };
inline constexpr int kPixelCauses = 7;
inline constexpr const char* kPixelCauseNames[kPixelCauses] = {"equal",         "visibility",      "interpolants", "material inputs",
                                                               "shaded colour", "resolved colour", "rounding"};
inline constexpr double kRounding = 1e-3;
std::vector<PixelCause> pixel_causes(const Frame& tile, const Frame& other, int msaa); // [pixel]

struct CauseShare {
    PixelCause cause = PixelCause::none;
    std::uint64_t pixels = 0, edge_pixels = 0; // edge: several triangles in the pixel
    double flip = 0.0;                         // contribution of these pixels to the picture's mean FLIP
};
// Returns the shares by cause, without empty causes. flip: error of each pixel; null: 0 everywhere. All `flip` shares add up to the mean.
std::vector<CauseShare> share_causes(const std::vector<PixelCause>& causes, const Frame& tile, int msaa, const float* flip);

// Returns the first stage that differs, or null.
const ParityStage* first_difference(const ParityCounts& counts);

std::uint64_t ulp_distance(std::uint32_t a, std::uint32_t b); // floats given by their bits; -0 and +0 are one apart

} // namespace burnish
