// Light that a mapped surface keeps above its own horizon. Facets of level 0 turn away from the surface's normal, and where a frame asks
// for the horizon (FrameDesc::horizon) they reflect nothing from below it. One lobe about a mean normal does not know of that. The levels
// of a normal map therefore hold in their alpha the share of light that the facets below a texel keep, and materials say how this share
// depends on the eye.
#pragma once
#include <functional>
#include <vector>

#include "shading/bake/mip/source.h"
#include "shading/lang/records.h"

namespace burnish {

// Share of its reflected light that a tilted facet keeps: the mean over all azimuths of the eye, by the facet's lobe of GGX, as a multiple
// of what an upright facet reflects. Eyes at cosine .1 + .3 k to the surface's normal, k below kKeptKnots.
class KeptShares {
  public:
    explicit KeptShares(float alpha);
    float at(int knot, float nz) const; // nz: cosine of the facet's tilt, [0,1]

  private:
    static constexpr int kTilts = 48; // places of a row, even in the sine of half the tilt
    std::vector<float> rows_[kKeptKnots];
};

// Returns the shares of a width; tables are made once for each roughness in steps of 1/32.
const KeptShares& kept_shares(float roughness);

// Unit normals of level 0 at places that are even over the map, between texels as shading has them: planes x, y, z,
// mip::row_stride(kSpreadPoints) apart.
inline constexpr std::size_t kSpreadPoints = 4096;
std::vector<float> spread_points(const MipSource& source);

inline constexpr int kKeptKnot = 1; // the one that levels hold: eyes at cosine .4

struct KeptWeights {
    bool any = false;            // facets lose light below the horizon
    float loss = 0.0f;           // at kKeptKnot, of the whole map
    float of[kKeptKnots] = {};   // loss at a knot over the loss at kKeptKnot
    float mean[kKeptKnots] = {}; // share that facets keep at a knot
};
// Of level 0 of a map, from 4096 of its texels.
KeptWeights kept_weights(const MipSource& source, const KeptShares& shares);

// Mean over the texels of level 0 below each texel of a level, by level from 1 on. of: a quantity of a point.
using PointQuantity = std::function<float(const MipPoint& point)>;
std::vector<std::vector<float>> mean_levels(const MipSource& source, const PointQuantity& of);

// Share of its light that a texel of a level keeps, [0,1]. mean: of its facets' shares; nz: of its own normal.
float kept_share(const KeptShares& shares, float mean, float nz);

// Mean width alpha of a lobe: (alpha_u + alpha_v) / 2.
float mean_alpha(slope_covariance lobe);

} // namespace burnish
