// Facets of a normal map seen from afar: a few groups of its normals, each of which is shaded as a surface of its own. One lobe a texel
// cannot say where light goes whose facets lie far apart.
#pragma once
#include <vector>

#include "shading/bake/mip/source.h"
#include "shading/lang/records.h"

namespace burnish {

struct Facet {
    float x, y;   // of the group's mean normal, unit, tangent space
    float weight; // share of the map; all together 1
    float spread; // of its normals about the mean: what squared widths of lobes grow by
};

// At most kMostFacets, of 4096 texels. A group of normals that spread most is split in two, across where they spread, until all are alike
// or there are enough.
std::vector<Facet> facets_of(const MipSource& source);

} // namespace burnish
