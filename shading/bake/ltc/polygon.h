// Light of polygons through a transformed cosine, in double: what figures of quality are made with.
#pragma once
#include <vector>

#include "shading/bake/ltc/matrix.h"

namespace burnish::ltc {

// The part of the density that lies in the cone of a polygon, [0,1]: exact, clipped at the horizon of the cosine's space. n: the inverse of
// the matrix; corners: seen from the shading point, in order, either way around; convex. Heitz, Dupuy, Hill, Neubelt 2016, section 4.
double polygon_part(const Matrix& n, const std::vector<Vec>& corners);

} // namespace burnish::ltc
