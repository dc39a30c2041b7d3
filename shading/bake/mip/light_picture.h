// The picture of a textured area light, as it is seen directly and, blurred, through wide lobes.
#pragma once
#include <glm/glm.hpp>

#include "shading/bake/mip/texture.h"

namespace burnish {

struct LightPicture {
    // Texels less their mean, so that of an even picture nothing is left and its light is exactly that of a light without one; RGB, linear.
    // Level 0 is the picture, to 1/4000 of the mean or so: beside a sun dark texels are lost. The levels above are the picture blurred by a
    // Gaussian of kLightPictureSpread of their texels, bilinear fetch included, of which only what lies on the picture counts; their
    // borders are what is seen half a texel past its edges. The last is even.
    TexturePyramid differences;
    glm::vec3 mean{1.0f}; // of all texels
};

// Colours of codes are sRGB, those of floats linear. Heitz, Dupuy, Hill, Neubelt 2016, section 5.
LightPicture make_light_picture(const Image& image);

} // namespace burnish
