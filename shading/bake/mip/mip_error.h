// Error of mip levels: a level's tonemapped reflected radiance against level 0's average, or against another level.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish {

inline constexpr int kLeastFlipSide = 16; // texels: least side for a FLIP

struct MipErrorSurface {
    mipnet::Lobe lobe = mipnet::Lobe::ggx_aniso;
    float f0 = 0.85f, diffuse = 0.0f; // reflectances
};
MipErrorSurface mip_error_surface(mipnet::Lobe lobe, bool metal); // f0 .85, or .04 over a diffuse half

struct MipError {
    double flip = 0.0;          // mean LDR-FLIP between x / (1 + x), over lamps with their eyes; 0 for smaller squares
    double l1 = 0.0, mse = 0.0; // errors in x / (1 + x) encoded as sRGB, over pairs (direction to light, direction to eye)
    double light = 0.0;         // mean radiance over pairs, relative to the reference
};

// Lights and eyes for a comparison. A pair is a light uniformly above and an eye weighted by its cosine. Pairs are numbered, and the n-th
// pair is always the same.
struct MipErrorPairs {
    int first = 0, times = 48;
    int tiles = 1; // along a side: each tile uses pairs first + tile + n tiles^2
    int lamps = 3; // 1.5 from the plane's centre, their eyes near the mirrored direction; 0: FLIP stays 0
};

mipnet::Texels mip_level_texels(const MipLevel& level);

// Returns l1 and mse between two levels with equal sizes, texel by texel, over 48 pairs.
MipError mip_difference(const mipnet::Texels& a, const mipnet::Texels& b, const MipErrorSurface& surface);

// Compares several filters' levels with level 0. Level 0 is lit at full resolution and its linear radiance is averaged. Returns errors by
// filter, then level, starting with level 1. level0: a square whose side is a multiple of 2^levels, and of 2^levels tiles. filters: levels
// from 1 on, equally many per filter. gains: by filter, then level, factors for reflectances (level_gains.h); empty for filters without
// gains. second: by filter, the second lobes for levels whose texels have two lobes with half the light each; empty for filters with one
// lobe.
std::vector<std::vector<MipError>> mip_errors(const mipnet::Texels& level0, const std::vector<std::vector<mipnet::Texels>>& filters,
                                              const MipErrorSurface& surface, const Jobs& jobs, const MipErrorPairs& pairs = {},
                                              const std::vector<std::vector<mipnet::Texels>>& second = {},
                                              const std::vector<std::vector<float>>& gains = {});

// Does the same, but takes `light` under 24 other pairs for each texel in the last level. Pairs that all texels share are too few for the
// mean of narrow lobes.
std::vector<std::vector<MipError>> judged_errors(const mipnet::Texels& level0, const std::vector<std::vector<mipnet::Texels>>& filters,
                                                 const MipErrorSurface& surface, const Jobs& jobs, const MipErrorPairs& pairs = {},
                                                 const std::vector<std::vector<mipnet::Texels>>& second = {},
                                                 const std::vector<std::vector<float>>& gains = {});

} // namespace burnish
