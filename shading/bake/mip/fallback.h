// Decides if a cascade is good enough for a material, by the lobes' reflected light.
#pragma once
#include <functional>

#include "core/jobs/jobs.h"
#include "shading/bake/mipnet/texels.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish::mipnet {

inline constexpr double kMostOfBaseline = 1.15; // largest L1, relative to baseline's, with which a cascade is kept
inline constexpr int kSampleSide = 128;         // texels, for 4 x 4 tiles of 32

// Samples level 0: tiles side by side, one from each of 4 x 4 parts, at fixed random places. Tiles repeat if there are fewer. Levels up to
// 5 depend on a tile's texels alone. So the sample's levels 1 to 5 are texels from the material's levels, if its sides are multiples of
// 32. texel: reads kChannels numbers at level 0.
Texels sample_of(int width, int height, const std::function<void(int x, int y, float* texel)>& texel);

struct Comparison { // mean_l1() in evaluate.h
    double net, baseline, kappa;
    bool keeps_net() const { return !(net > kMostOfBaseline * baseline + 1e-6); }
    bool prefers_kappa() const { return kappa <= baseline; } // between the closed forms
};
// Compares a cascade with closed forms. sample: square, its side a multiple of 32. metal: reflectance 0.85, else 0.04 over a diffuse 0.5.
Comparison compare_on(const Texels& sample, const Weights& weights, double kappa, bool metal, const Jobs& jobs);

} // namespace burnish::mipnet
