// Shadows of area lights: the part of their light that arrives, found by samples, by which light that is found without anything in its way
// is multiplied. Heitz, Hill, McGuire 2018, "Combining Analytic Direct Illumination and Stochastic Shadows".
#pragma once
#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"

namespace burnish {

// shadowed, open: f32 RGB, estimates of the area lights' light in a picture by the same samples, with and without what is in its way;
// layers: of the same picture, seen by `view`. Both are filtered over 5x5 pixels of the same surface before one is divided by the other;
// the ratio is 0 in full shadow, and exactly 1 where nothing is in the way or no light would arrive anyway. f32 RGB, not negative.
Image shadow_ratio(const Image& shadowed, const Image& open, const Column<PixelLayers>& layers, const View& view, const Jobs& jobs);

// What a ratio leaves of a picture, of which `unlit` is the part without area lights; where it is 1, the bits of `lit`.
Image with_shadows(const Image& lit, const Image& unlit, const Image& ratio);

} // namespace burnish
