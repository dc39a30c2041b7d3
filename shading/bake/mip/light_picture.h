// Picture of a textured area light, seen directly or blurred through wide lobes.
#pragma once
#include <glm/glm.hpp>

#include "shading/bake/mip/texture.h"

namespace burnish {

struct LightPicture {
    // Texels minus their mean; RGB, linear. A constant picture leaves zeros, and its light equals an untextured light exactly.
    // Level 0 is the picture, to about 1/4000 of the mean: beside a sun dark texels are lost. Higher levels are the picture, blurred by a
    // Gaussian of kLightPictureSpread of their texels, bilinear fetch included. Only the part on the picture counts. Borders show the view
    // half a texel past the edges. The last level is constant.
    TexturePyramid differences;
    glm::vec3 mean{1.0f}; // of all texels
};

// Makes the picture. Integer colours are sRGB, floats linear. Heitz, Dupuy, Hill, Neubelt 2016, section 5.
LightPicture make_light_picture(const Image& image);

} // namespace burnish
