#include "shading/bake/environment/turn.h"

#include <cmath>

#include "core/math/scalar_math.h"

namespace burnish {

glm::dmat3 sky_from_world(float rotation_deg)
{
    const double circles = static_cast<double>(rotation_deg) / 360.0, turn = (circles - std::floor(circles)) * 2.0 * kPi;
    const double c = det_cos(turn), s = det_sin(turn);
    return {c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c}; // by columns
}

} // namespace burnish
