// Glass for tests, its reflectance, and a sky that tells directions apart.
#pragma once
#include <cmath>

#include "tests/unit/reference/scenes.h"

namespace burnish::test {

inline constexpr double kHalfTurn = 3.14159265358979323846;

inline Material glass(float roughness, float ior = 1.5f, float transmission = 1.0f)
{
    Material m = metal(roughness, 0.0f);
    m.metallic = 0.0f, m.ior = ior, m.transmission = transmission;
    return m;
}

inline glm::vec3 sky_gradient(const glm::vec3& d)
{
    return glm::vec3(1.0f + 0.5f * d.x + 0.3f * d.y + 0.1f * d.z);
}

// Returns the reflectance of a smooth dielectric, by Fresnel's equations.
inline double reflectance(double cosine, double ior)
{
    const double g = std::sqrt(ior * ior - 1.0 + cosine * cosine);
    const double s = (cosine - g) / (cosine + g), p = (ior * ior * cosine - g) / (ior * ior * cosine + g);
    return 0.5 * (s * s + p * p);
}

} // namespace burnish::test
