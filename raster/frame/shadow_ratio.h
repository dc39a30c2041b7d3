// Shadows of lights. Samples estimate the ratio of arriving light to light without occlusion. The ratio multiplies analytic light without
// occlusion. Heitz, Hill, McGuire 2018, "Combining Analytic Direct Illumination and Stochastic Shadows".
#pragma once
#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"

namespace burnish {

// Returns the ratio of shadowed to open light. f32 RGB, not negative. shadowed, open: f32 RGB, estimates of a picture's light from some
// lights by the same samples, with and without occluders. layers: of the same frame; desc: its description. Noisy estimates are filtered
// over 5x5 pixels of the same surface before the division. The ratio is 0 in full shadow. It is exactly 1 if nothing occludes the lights or
// no light would arrive anyway.
Image shadow_ratio(const Image& shadowed, const Image& open, const Column<PixelLayers>& layers, const FrameDesc& desc, const Jobs& jobs,
                   bool noisy = true);

// Takes the shaded share of some lights out of a picture: (lit - unlit) (1 - ratio). lit: the picture with all lights and no shadows;
// unlit: without these lights. Where the ratio is 1, pixels keep their bits.
void darken(Image& picture, const Image& lit, const Image& unlit, const Image& ratio);

// Does the same to the parts of pixels. All lists hold the same pixels and samples.
void darken(std::vector<PixelPart>& parts, const std::vector<PixelPart>& lit, const std::vector<PixelPart>& unlit, const Image& ratio);

} // namespace burnish
