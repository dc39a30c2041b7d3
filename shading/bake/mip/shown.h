// How far levels of a material's normals and lobes are from what level 0 shows from afar, or from other levels: of what is reflected, as a
// display has it.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish {

inline constexpr int kLeastFlipSide = 16; // texels, of a level that has a FLIP

struct ShownSurface {
    mipnet::Lobe lobe = mipnet::Lobe::ggx_aniso;
    float f0 = 0.85f, diffuse = 0.0f; // reflectances
};
ShownSurface shown_surface(mipnet::Lobe lobe, bool metal); // f0 .85, or .04 over a diffuse half

struct ShownError {
    double flip = 0.0;          // mean LDR-FLIP of x / (1 + x), over lamps with their eyes; 0 of smaller squares
    double l1 = 0.0, mse = 0.0; // of x / (1 + x) encoded as sRGB, over pairs of directions to light and eye
    double light = 0.0;         // mean radiance over pairs, as a multiple of the truth's
};

// What levels are looked at under. Pairs are numbered, each a light from anywhere above and an eye weighted by its cosine; the n-th is the
// same everywhere.
struct ShownPairs {
    int first = 0, times = 48;
    int tiles = 1; // along a side: each tile has pairs of its own, first + tile + n tiles^2
    int lamps = 3; // 1.5 away from the middle of the plane, their eyes near where they are mirrored; 0: FLIP is left 0
};

mipnet::Texels shown_texels(const MipLevel& level);

// Of two levels of one size, texel by texel: l1 and mse, over 48 pairs.
ShownError shown_difference(const mipnet::Texels& a, const mipnet::Texels& b, const ShownSurface& surface);

// Each filter's levels beside level 0, lit at one to one, whose linear radiance is averaged: by filter, then level, the first of each being
// level 1. level0: a square whose side is a multiple of 2^levels, and of 2^levels tiles. filters: levels from 1 on, all filters as many.
// gains: by filter, then level, what reflectances are multiplied by (level_gains.h); empty of filters that have none. second: by filter,
// the other lobes of levels whose texels have two of half the light; empty of those that have one.
std::vector<std::vector<ShownError>> shown_errors(const mipnet::Texels& level0, const std::vector<std::vector<mipnet::Texels>>& filters,
                                                  const ShownSurface& surface, const Jobs& jobs, const ShownPairs& pairs = {},
                                                  const std::vector<std::vector<mipnet::Texels>>& second = {},
                                                  const std::vector<std::vector<float>>& gains = {});

// The same, but light is that under 24 other pairs a texel of the last level: pairs that all texels share are too few for the mean of lobes
// that are narrow.
std::vector<std::vector<ShownError>> judged_errors(const mipnet::Texels& level0, const std::vector<std::vector<mipnet::Texels>>& filters,
                                                   const ShownSurface& surface, const Jobs& jobs, const ShownPairs& pairs = {},
                                                   const std::vector<std::vector<mipnet::Texels>>& second = {},
                                                   const std::vector<std::vector<float>>& gains = {});

} // namespace burnish
