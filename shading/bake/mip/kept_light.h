// Light that a normal-mapped surface keeps above its own horizon. Facets of level 0 turn away from the surface normal. If a frame asks for
// the horizon (FrameDesc::horizon), they reflect nothing from below it. One lobe about a mean normal cannot show this. So the alpha of a
// normal map's levels stores the light share that the facets under a texel keep. Materials tell how this share depends on the eye.
#pragma once
#include <functional>
#include <vector>

#include "shading/bake/mip/source.h"
#include "shading/lang/records.h"

namespace burnish {

// Share of reflected light that a tilted facet keeps. It is a mean over all azimuths of the eye, for a GGX facet, relative to an upright
// facet. Knot k, below kKeptKnots, has the eye at cosine .1 + .3 k to the surface normal.
class KeptShares {
  public:
    explicit KeptShares(float alpha);
    float at(int knot, float nz) const; // nz: cosine of the facet's tilt, [0,1]

  private:
    static constexpr int kTilts = 48; // entries in a row, even in the sine of half the tilt
    std::vector<float> rows_[kKeptKnots];
};

// Returns the shares for a roughness. Tables are made once for each step of 1/32.
const KeptShares& kept_shares(float roughness);

// Returns unit normals of level 0 at 4096 places that are even over the map. Normals are interpolated between texels as in shading. Planes
// x, y, z lie mip::row_stride(kSpreadPoints) apart.
inline constexpr std::size_t kSpreadPoints = 4096;
std::vector<float> spread_points(const MipSource& source);

inline constexpr int kKeptKnot = 1; // the knot that levels store: eyes at cosine .4

struct KeptWeights {
    bool any = false;            // facets lose light below the horizon
    float loss = 0.0f;           // at kKeptKnot, for the whole map
    float of[kKeptKnots] = {};   // loss at a knot over the loss at kKeptKnot
    float mean[kKeptKnots] = {}; // share that facets keep at a knot
};
// Returns the weights of a map's level 0, from 4096 points.
KeptWeights kept_weights(const MipSource& source, const KeptShares& shares);

// Returns, by level from 1 on, the mean over the level 0 texels under each texel. of: a point's quantity.
using PointQuantity = std::function<float(const MipPoint& point)>;
std::vector<std::vector<float>> mean_levels(const MipSource& source, const PointQuantity& of);
// Returns the same for a quantity at level 0, in an image of one channel of floats.
std::vector<std::vector<float>> mean_levels(const Image& level0, const Jobs& jobs);

// Returns the light share that a level's texel keeps, [0,1]. mean: its facets' mean share; nz: for the texel's normal.
float kept_share(const KeptShares& shares, float mean, float nz);

} // namespace burnish
