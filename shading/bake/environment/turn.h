// How the world stands to the picture of an environment that is drawn turned.
#pragma once
#include <glm/glm.hpp>

namespace burnish {

// From directions of the world to those of the picture, where the picture is turned about +Y, counter-clockwise seen from above.
glm::dmat3 sky_from_world(float rotation_deg);

} // namespace burnish
