#include "shading/bake/ltc/place.h"

#include <algorithm>

#include "core/math/scalar_math.h"

namespace burnish::ltc {

Vec eye_of(const Place& place)
{
    const double sine = det_sin(place.theta);
    return {sine * det_cos(place.phi), sine * det_sin(place.phi), det_cos(place.theta)};
}

Matrix natural_matrix(const Place& place)
{
    const Vec v = eye_of(place);
    const double ax = place.alpha, ay = place.alpha * place.lambda, z = std::max(v.z, 0.02);
    // Columns: the derivative of the mirror direction by slope along x and along y, and the direction itself
    Matrix m = {2.0 * ax * z, 0.0, -v.x, 0.0, 2.0 * ay * z, -v.y, 2.0 * ax * v.x, 2.0 * ay * v.y, v.z};
    // At grazing views both columns point upwards. A second-order term across the plane of incidence keeps them apart.
    const double c = det_cos(place.phi), s = det_sin(place.phi), across2 = 0.5 / (c * c / (ax * ax) + s * s / (ay * ay));
    m[0] += across2 * s * s, m[1] -= across2 * s * c;
    m[3] -= across2 * s * c, m[4] += across2 * c * c;
    return m;
}

} // namespace burnish::ltc
