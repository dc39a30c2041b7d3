#include "core/scene/builtin/surface.h"

#include <algorithm>
#include <cmath>

namespace burnish {
namespace {

std::byte code(double unit)
{
    return static_cast<std::byte>(static_cast<int>(std::clamp(unit, 0.0, 1.0) * 255.0 + 0.5));
}

} // namespace

Image map_of(int width, int height, const std::function<glm::dvec3(double u, double v)>& colour)
{
    Image image = make_image(width, height, 3, PixelType::u8);
    std::size_t at = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 c = colour((x + 0.5) / width, (y + 0.5) / height);
            for (int i = 0; i < 3; ++i)
                image.bytes[at++] = code(c[i]);
        }
    return image;
}

glm::dvec3 normal_colour(const glm::dvec2& slope)
{
    const double length = std::sqrt(slope.x * slope.x + slope.y * slope.y + 1.0);
    return glm::dvec3(0.5) + 0.5 * glm::dvec3(-slope.x, -slope.y, 1.0) / length;
}

Node looking(const char* name, const glm::vec3& eye, const glm::vec3& target)
{
    const glm::vec3 back = glm::normalize(eye - target), right = glm::normalize(glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), back));
    Node node;
    node.name = name;
    node.local = node.world =
        glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f), glm::vec4(back, 0.0f), glm::vec4(eye, 1.0f));
    return node;
}

double noise(int x, int y, std::uint32_t salt)
{
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^ static_cast<std::uint32_t>(y) * 0x85ebca6bu ^ salt;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return (h ^ h >> 15) / 4294967296.0;
}

} // namespace burnish
