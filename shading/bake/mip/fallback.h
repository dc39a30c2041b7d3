// Whether a cascade is good enough for a material, by what its lobes show.
#pragma once
#include <functional>

#include "core/jobs/jobs.h"
#include "shading/bake/mipnet/texels.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish::mipnet {

inline constexpr double kMostOfBaseline = 1.15; // of its L1, that a cascade may have and be kept
inline constexpr int kSampleSide = 128;         // texels, of 4 x 4 tiles of 32

// Tiles of level 0 side by side, one of each of 4 x 4 parts, as chance that is always the same has it; again where there are fewer. What is
// made of a tile's texels up to level 5 is made of nothing else, so levels 1 to 5 of the sample are texels of the material's own where its
// sides are multiples of 32. texel: of level 0, kChannels numbers.
Texels sample_of(int width, int height, const std::function<void(int x, int y, float* texel)>& texel);

struct Comparison { // mean_l1() of evaluate.h
    double net, baseline, kappa;
    bool keeps_net() const { return !(net > kMostOfBaseline * baseline + 1e-6); }
    bool prefers_kappa() const { return kappa <= baseline; } // of both closed forms
};
// sample: square, its side a multiple of 32. metal: of reflectance 0.85, else 0.04 over a diffuse 0.5.
Comparison compare_on(const Texels& sample, const Weights& weights, double kappa, bool metal, const Jobs& jobs);

} // namespace burnish::mipnet
