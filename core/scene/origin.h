// Scenes far from the origin: floats hold places at 4600 km to half a metre only, so such a scene is drawn around an origin of its own.
#pragma once
#include "core/scene/scene.h"

namespace burnish {

// Chooses Scene::origin: near the middle of what is drawn where that lies more than 32 radii away, else 0. Updates the world.
void settle_origin(Scene& scene);

// Warns of places that floats hold coarsely all the same, and says the step in metres: of vertices far from their node, and of nodes far
// from the origin of a scene that reaches from there to here.
void warn_of_steps(Scene& scene);

} // namespace burnish
