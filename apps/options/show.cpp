#include "apps/options/show.h"

#include <algorithm>
#include <cmath>

namespace burnish {
namespace {

// Colours of mip levels 0, 1, ...; higher levels take the last colour.
constexpr float kLevelColours[][3] = {{0.05f, 0.10f, 0.45f}, {0.10f, 0.45f, 0.85f}, {0.10f, 0.70f, 0.60f}, {0.25f, 0.75f, 0.20f},
                                      {0.80f, 0.85f, 0.15f}, {1.00f, 0.65f, 0.10f}, {0.95f, 0.30f, 0.10f}, {0.75f, 0.05f, 0.25f},
                                      {0.60f, 0.10f, 0.60f}, {0.85f, 0.50f, 0.90f}, {1.00f, 0.90f, 1.00f}};

glm::vec3 colour_of_level(float level)
{
    constexpr int kLast = static_cast<int>(std::size(kLevelColours)) - 1;
    if (level < 0.0f)
        return glm::vec3(0.5f);
    const int below = std::min(static_cast<int>(level), kLast), above = std::min(below + 1, kLast);
    const float part = level - std::floor(level);
    glm::vec3 colour;
    for (int c = 0; c < 3; ++c)
        colour[c] = kLevelColours[below][c] + part * (kLevelColours[above][c] - kLevelColours[below][c]);
    return colour;
}

glm::vec3 colour_of_tensor(const PixelLayers& p, const View& view)
{
    const glm::vec3 grain(p.tangent[0], p.tangent[1], p.tangent[2]);
    glm::vec2 axis(glm::dot(grain, view.right), glm::dot(grain, view.up));
    const float length = std::sqrt(axis.x * axis.x + axis.y * axis.y);
    axis = length > 1e-4f ? axis / length : glm::vec2(1.0f, 0.0f);
    const float alpha = p.roughness * p.roughness, wide = alpha * (1.0f + p.anisotropy), narrow = alpha * (1.0f - p.anisotropy);
    const float xx = wide * axis.x * axis.x + narrow * axis.y * axis.y, yy = wide * axis.y * axis.y + narrow * axis.x * axis.x;
    const float xy = (wide - narrow) * axis.x * axis.y;
    return {std::sqrt(xx), std::sqrt(yy), 0.5f + 0.5f * xy / std::sqrt(std::max(xx * yy, 1e-20f))};
}

} // namespace

Image false_colour(Shown what, const Frame& frame, const View& view)
{
    Image to = make_image(frame.color.width, frame.color.height, 3, PixelType::u8);
    for (std::size_t i = 0; i < frame.layers.size(); ++i) {
        const PixelLayers& p = frame.layers[i];
        if (p.depth == 0.0f)
            continue;
        const glm::vec3 colour = what == Shown::lod      ? colour_of_level(p.lod)
                                 : what == Shown::tensor ? colour_of_tensor(p, view)
                                                         : glm::vec3(0.5f) + 0.5f * glm::vec3(p.normal[0], p.normal[1], p.normal[2]);
        for (int c = 0; c < 3; ++c)
            to.bytes[3 * i + static_cast<std::size_t>(c)] =
                static_cast<std::byte>(static_cast<int>(std::clamp(colour[c], 0.0f, 1.0f) * 255.0f + 0.5f));
    }
    return to;
}

} // namespace burnish
