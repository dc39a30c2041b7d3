// Colour: sRGB transfer and tonemapping. Portable arithmetic only, so that 8-bit pictures too are the same on
// every machine.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

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

// A part of a pixel that shows more than one thing: what some of its samples see, before they are averaged.
struct PixelPart {
    std::uint32_t pixel;         // y * width + x
    std::uint8_t first, samples; // the lowest of its samples, and how many
    bool background;             // what lies behind the scene
    std::array<float, 3> color;  // linear
};

// samples: a bit each.
inline PixelPart pixel_part(std::uint32_t pixel, std::uint32_t samples, bool background, const std::array<float, 3>& color)
{
    return {pixel, static_cast<std::uint8_t>(std::countr_zero(samples)), static_cast<std::uint8_t>(std::popcount(samples)), background,
            color};
}

// What pixels are the mean of. linear: radiance of samples. display: each sample tonemapped and clipped. weighted: radiance, samples of
// exposed luminance L weighing 1 / (1 + L), tonemapped afterwards (Karis, "Tone mapping", 2013).
enum class Resolve { linear, display, weighted };

// As above, but pixels that have parts are made of these. parts: by pixel; of a picture with alpha those of the background do not count.
// Without parts, or with Resolve::linear, as above.
Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts, Resolve resolve);

// Float RGBA whose colours are not multiplied by alpha, as 8-bit formats have it; black where alpha is 0. image: colours multiplied by it.
Image unassociated(const Image& image);

float srgb_to_linear(float encoded); // IEC 61966-2-1, [0,1] to [0,1]
float linear_to_srgb(float linear);

} // namespace burnish
