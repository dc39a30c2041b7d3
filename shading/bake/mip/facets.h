// A normal map's facets, seen from afar: a few groups of its normals. Each group is shaded as a surface. One lobe per texel cannot tell
// where light goes if facets point far apart.
#pragma once
#include <vector>

#include "shading/bake/mip/source.h"
#include "shading/lang/records.h"

namespace burnish {

struct Facet {
    float x, y;   // the group's mean normal, unit, tangent space
    float weight; // share of the map; all weights sum to 1
    float spread; // variance of normals about the mean: added to squared lobe widths
};

// Groups 4096 texels into at most kMostFacets facets. Splits the group with the largest spread in two, across its direction of largest
// spread, until the number is reached, or no group adds more than `alike` to the mean squared distance of normals from their group's mean.
std::vector<Facet> facets_of(const MipSource& source, double alike);

} // namespace burnish
