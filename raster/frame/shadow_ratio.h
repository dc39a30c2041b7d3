// Area light shadows. Samples estimate the ratio of arriving light to light without occlusion. The ratio multiplies analytic light without
// occlusion. Heitz, Hill, McGuire 2018, "Combining Analytic Direct Illumination and Stochastic Shadows".
#pragma once
#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"

namespace burnish {

// Returns the ratio of shadowed to open light. f32 RGB, not negative. shadowed, open: f32 RGB, estimates of a picture's area light from
// the same samples, with and without occluders. layers: of the same picture, seen by `view`. Both estimates are filtered over 5x5 pixels
// of the same surface before the division. The ratio is 0 in full shadow. It is exactly 1 if nothing occludes the lights or no light would
// arrive anyway.
Image shadow_ratio(const Image& shadowed, const Image& open, const Column<PixelLayers>& layers, const View& view, const Jobs& jobs);

// Applies a ratio to the area light in a picture. unlit: the picture without area lights. Where the ratio is 1, the result has the bits of
// `lit`.
Image with_shadows(const Image& lit, const Image& unlit, const Image& ratio);

} // namespace burnish
