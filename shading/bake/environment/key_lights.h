// Key lights: small strong lights of an environment, found in its picture and taken out of it. What is left is smooth enough for
// prefiltering and for few samples; the lights themselves are evaluated with the lobe.
#pragma once
#include <vector>

#include "shading/bake/environment/environment.h"
#include "shading/bake/environment/equirect.h"

namespace burnish {

// A region is a key light where it
//  - is connected and brighter than a threshold that is at least four times the mean radiance of the sphere,
//  - is compact: it lies within 5 degrees of its centre, its ellipse of inertia has half axes of at most 2.5 degrees and covers it,
//  - has on the mean at least eight times the radiance of its surroundings, and four times that of any pixel on its rim,
//  - gives at least 1/200 of the light of the sphere.
// The threshold is the lowest that satisfies all this. At most `most` are taken out of `source`, the strongest first, each with the pixels
// around it; what is left there is a mean of the surroundings, the nearer the more. Light is moved, never made or lost: what a light has is
// the difference. Directions are those of the picture. changed: where the source has become another, a cap a light.
std::vector<KeyLight> take_key_lights(Equirect& source, int most, std::vector<SkyCap>& changed);

// As it stands in a world under an environment that is turned counter-clockwise about +Y (seen from above).
KeyLight turned(const KeyLight& light, float rotation_deg);

} // namespace burnish
