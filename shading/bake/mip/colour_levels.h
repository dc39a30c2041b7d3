// Levels of colours and metalness, of one map by itself or weighted by how much of each texel is seen and lit.
#pragma once
#include <vector>

#include "core/image/image.h"
#include "core/scene/scene.h"

namespace burnish {

// box: the mean over a texel's exact footprint. kaiser: a sinc over three texels of the level either way under Kaiser's window (alpha 4):
// sharper, and clamped to what the map holds.
enum class ColourKernel { box, kaiser };

struct ColourOptions {
    ColourKernel kernel = ColourKernel::box;
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    // One channel, as large as the map, above 0: texels' shares of what is reflected; null: all alike.
    const Image* weight = nullptr;
};

// linear: f32 of any channels, level 0 of the result, whose sides are halved and rounded down to 1x1.
std::vector<Image> colour_levels(const Image& linear, const ColourOptions& options);

} // namespace burnish
