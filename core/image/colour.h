// Colour: sRGB transfer and tonemapping. Portable arithmetic only, so that 8-bit images are equal on every machine.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

class Jobs;

enum class Tonemap { none, pbr_neutral, aces };

// none: clip to [0,1]. pbr_neutral: Khronos PBR Neutral. aces: Hill's fit of the ACES reference and output transforms.
Result<Tonemap> parse_tonemap(const std::string& name);

// Converts linear Rec.709 float RGB(A) to 8-bit sRGB RGB(A). Multiplies radiance by 2^exposure_ev before tonemapping. jobs: null for the
// calling thread alone.
Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev, const Jobs* jobs = nullptr);

// One part of a pixel that shows several things: the average over the samples that see one of them.
struct PixelPart {
    std::uint32_t pixel;         // y * width + x
    std::uint8_t first, samples; // lowest sample, number of samples
    bool background;             // true for the sky behind the scene
    std::array<float, 3> color;  // linear Rec.709, multiplied by alpha
    float alpha;                 // share of the background that the part hides, (0,1]; counts in images with alpha
};

// Makes a part from a sample mask, one bit for each sample.
inline PixelPart pixel_part(std::uint32_t pixel, std::uint32_t samples, bool background, const std::array<float, 3>& color,
                            float alpha = 1.0f)
{
    return {
        pixel, static_cast<std::uint8_t>(std::countr_zero(samples)), static_cast<std::uint8_t>(std::popcount(samples)), background, color,
        alpha};
}

// Quantity that a pixel averages over its samples. linear: radiance. display: each sample tonemapped and clipped.
// weighted: radiance with weights 1 / (1 + L), where L is exposed luminance, tonemapped afterwards (Karis, "Tone
// mapping", 2013).
enum class Resolve { linear, display, weighted };

// Converts like the overload above, but resolves the pixels in `parts` from their parts. `parts` is sorted by pixel.
// Background parts do not count in an image with alpha. Without parts, or with Resolve::linear, equals the overload
// above.
Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts, Resolve resolve,
                       const Jobs* jobs = nullptr);

// Divides float RGBA colours by alpha, as 8-bit formats expect; black where alpha is 0. `image` holds premultiplied
// colours.
Image unassociated(const Image& image);

float srgb_to_linear(float encoded); // IEC 61966-2-1, [0,1] to [0,1]
float linear_to_srgb(float linear);

} // namespace burnish
