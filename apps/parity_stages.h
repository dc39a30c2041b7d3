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
    std::uint64_t samples = 0, visibility_differ = 0; // a sample differs where its triangle does
    std::uint64_t pixels_differ = 0, edge_pixels_differ = 0; // of the resolved picture; of them, pixels that show several triangles
    std::vector<ParityStage> stages; // clip positions, visibility, depth, interpolants, material inputs, shaded colour, resolved colour
};

inline constexpr const char* kVisibilityStage = "visibility";

// Both frames with FrameDesc::stages, of one description. What follows visibility is compared where visibility agrees: depths by sample,
// all else in pixels whose samples show the same pairs in both.
ParityCounts compare_stages(const Frame& tile, const Frame& other, int msaa);

// Only the pictures: a frame of a renderer without stages.
ParityCounts compare_pictures(const Frame& tile, const Frame& other, int msaa);

// The first stage that differs; null where none does.
const ParityStage* first_difference(const ParityCounts& counts);

std::uint64_t ulp_distance(std::uint32_t a, std::uint32_t b); // of floats by their bits; -0 and +0 are one apart

} // namespace burnish
