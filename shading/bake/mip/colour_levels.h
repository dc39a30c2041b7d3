// Mip levels for colours and metalness. Weights may say how visible and lit each texel is.
#pragma once
#include <functional>
#include <vector>

#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/texture.h"

namespace burnish {

struct ColourOptions {
    ColourKernel kernel = ColourKernel::box;
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    // One channel, as large as the map, above 0: texels' shares of the reflected light. Null: equal weights.
    const Image* weight = nullptr;
};

struct ColourRows { // level 0: writes `channels` finite floats per texel
    int width, height, channels;
    std::function<void(int y, float* to)> row;
};
// Makes levels from 1 on. Sides are halved and rounded down to 1x1. Calls `use` row by row, for several rows at once.
void each_colour_row(const ColourRows& map, const ColourOptions& options, const Jobs& jobs, const LevelRow& use);
// Makes all levels. linear: f32 with any channels, level 0 of the result. Sides are halved and rounded down to 1x1.
std::vector<Image> colour_levels(const Image& linear, const ColourOptions& options);

} // namespace burnish
