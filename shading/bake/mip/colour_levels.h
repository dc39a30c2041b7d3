// Levels of colours and metalness, of one map by itself or weighted by how much of each texel is seen and lit.
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
    // One channel, as large as the map, above 0: texels' shares of what is reflected; null: all alike.
    const Image* weight = nullptr;
};

struct ColourRows { // of level 0: writes channels floats a texel, which are finite
    int width, height, channels;
    std::function<void(int y, float* to)> row;
};
// Levels from 1 on, whose sides are halved and rounded down to 1x1, row by row, several rows at once.
void each_colour_row(const ColourRows& map, const ColourOptions& options, const Jobs& jobs, const LevelRow& use);
// linear: f32 of any channels, level 0 of the result, whose sides are halved and rounded down to 1x1.
std::vector<Image> colour_levels(const Image& linear, const ColourOptions& options);

} // namespace burnish
