// Mip levels of a clear coat's normal map, with the spread of the normals below each texel.
#pragma once
#include "core/scene/scene.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mip/texture.h"

namespace burnish {

// Returns how much the coat's normals widen its lobe, as gain_of_taps() does; 0: not at all.
float coat_gain(const Material& m, const MaterialMips& mips);

// Makes the pyramid: RGB as the plain pyramid of the map has it. Alpha is added to the squared alpha of the coat's lobe: gain squared times
// the variance of unit normals in x and y, [0,1]; 0 at level 0. m: has the map, and its scale.
TexturePyramid coat_pyramid(const Scene& scene, const Material& m, float gain);

} // namespace burnish
