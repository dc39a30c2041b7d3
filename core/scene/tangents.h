// Tangent spaces by MikkTSpace (Mikkelsen 2008, "Simulation of wrinkled surfaces revisited").
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace burnish {

// Computes tangents for un-indexed triangle corners: 3 for each triangle, arrays of equal length. Returns (tangent.xyz,
// sign) for each corner: unit length, sign +1 or -1, bitangent = sign * cross(normal, tangent).
std::vector<glm::vec4> mikk_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                     std::span<const glm::vec2> uvs);

// Returns some unit vector orthogonal to unit n, continuous except at n = (0,0,-1).
glm::vec3 any_tangent(const glm::vec3& n);

} // namespace burnish
