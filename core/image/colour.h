// Colour: sRGB transfer and tonemapping. Portable arithmetic only, so that 8-bit pictures too are the same on
// every machine.
#pragma once
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

enum class Tonemap { none, pbr_neutral, aces };

// none: clip to [0,1]. pbr_neutral: Khronos PBR Neutral. aces: Hill's fit of the ACES reference and output
// transforms.
Result<Tonemap> parse_tonemap(const std::string& name);

// Linear Rec.709 float RGB(A) to 8-bit sRGB RGB(A). `exposure_ev` multiplies radiance by 2^ev before the
// tonemapper.
Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev);

// Float RGBA whose colours are not multiplied by alpha, as 8-bit formats have it; black where alpha is 0. image: colours multiplied by it.
Image unassociated(const Image& image);

float srgb_to_linear(float encoded); // IEC 61966-2-1, [0,1] to [0,1]
float linear_to_srgb(float linear);

} // namespace burnish
