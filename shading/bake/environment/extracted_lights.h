// Extracted lights: small strong lights that are extracted from an environment's picture. The rest is smooth enough for prefiltering and
// for few samples. Shading evaluates the lights with the lobe.
#pragma once
#include <vector>

#include "shading/bake/environment/environment.h"
#include "shading/bake/environment/equirect.h"

namespace burnish {

// Extracts extracted lights from `source`. A region is an extracted light if it
//  - is connected and brighter than a threshold, which is at least four times the sphere's mean radiance,
//  - is compact: it lies within 5 degrees around its centre, its inertia ellipse covers it and has half axes up to 2.5 degrees,
//  - has a mean radiance at least eight times its surroundings' mean, and four times the radiance of any pixel on its rim,
//  - gives at least 1/200 of the sphere's light.
// The threshold is the lowest one that satisfies all conditions. At most `most` lights are extracted, the strongest first, each with
// the pixels around it. A mean of the surroundings, weighted by nearness, fills the hole. Light is moved, never made or lost: an extracted
// light gets the difference. Directions are the picture's. changed: a cap per light, where the source has changed.
std::vector<ExtractedLight> extract_lights(Equirect& source, int most, std::vector<SkyCap>& changed);

// Returns the light in a world under an environment that is turned counter-clockwise about +Y (seen from above).
ExtractedLight turned(const ExtractedLight& light, float rotation_deg);

} // namespace burnish
