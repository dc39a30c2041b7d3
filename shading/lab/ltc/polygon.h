// Light from polygons through a transformed cosine, in double, for quality figures.
#pragma once
#include <vector>

#include "shading/bake/ltc/matrix.h"

namespace burnish::ltc {

// Returns the share of the density in a polygon's cone, [0,1]: exact, clipped at the horizon in the cosine's space. n: the matrix'
// inverse. corners: seen from the shading point, in order, either way around; convex. Heitz, Dupuy, Hill, Neubelt 2016, section 4.
double polygon_part(const Matrix& n, const std::vector<Vec>& corners);

} // namespace burnish::ltc
