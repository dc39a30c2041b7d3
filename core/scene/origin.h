// Scenes far from the origin. Floats resolve only half a metre at 4600 km, so such a scene is drawn around its own
// origin.
#pragma once
#include "core/scene/scene.h"

namespace burnish {

// Sets Scene::origin: near the middle of the drawn scene where the middle lies more than 32 radii away, else 0. Updates
// world matrices.
void settle_origin(Scene& scene);

// Warns of places that floats still hold coarsely, with the step in metres: vertices far from their node, and nodes far
// from the origin of a scene that reaches from there to here.
void warn_of_steps(Scene& scene);

} // namespace burnish
