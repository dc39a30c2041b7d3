// Random small worlds made in memory, each with one answer by construction.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>

#include "raster/session/session.h"

namespace burnish::test {

// Numbers from a seed, the same on every machine (SplitMix64).
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
    int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
    float unit() { return static_cast<float>(next() >> 40) * 0x1p-24f; }
    float between(float low, float high) { return low + (high - low) * unit(); }
    glm::vec3 direction(); // unit

  private:
    std::uint64_t next();
    std::uint64_t state_;
};

// Adds meshes, each a node of its own, to a scene.
class World {
  public:
    // Triangles by threes of corners, object space. Returns the node.
    int add(const std::vector<glm::vec3>& corners, const Material& material, const glm::mat4& placed, int parent = kNone);
    Scene scene; // update_world() fills the matrices of nodes
};

std::vector<glm::vec3> box_corners();            // of the cube of side 2, fronts outwards
std::vector<glm::vec3> ball_corners(int rings);  // of the unit ball
std::vector<glm::vec3> plate_corners(int cells); // of x and y in [-1, 1], seen from +z, in cells x cells quads
std::vector<glm::vec3> turned_inside(std::vector<glm::vec3> corners);
glm::mat4 random_placement(Dice& dice, float size, float distance); // turned, stretched, at times mirrored
Material unlit(const glm::vec3& color);

// Draws a world under constant radiance; the environment's light is shared by all worlds.
Result<Frame> draw_world(World world, const FrameDesc& desc, float radiance);

} // namespace burnish::test
