// Rotation between the world and the picture of a turned environment.
#pragma once
#include <glm/glm.hpp>

namespace burnish {

// Returns the matrix from world directions to directions in the picture, which is turned about +Y, counter-clockwise seen from above.
glm::dmat3 sky_from_world(float rotation_deg);

} // namespace burnish
