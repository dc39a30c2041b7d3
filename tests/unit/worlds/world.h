// Random small worlds in memory, each with one known answer.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>

#include "raster/session/session.h"

namespace burnish::test {

// Seeded random numbers, equal on every machine (SplitMix64).
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

// Adds meshes to a scene, each with its node.
class World {
  public:
    // Adds triangles, three corners each, in object space. Returns the node.
    int add(const std::vector<glm::vec3>& corners, const Material& material, const glm::mat4& placed, int parent = kNone);
    Scene scene; // update_world() fills the matrices of nodes
};

std::vector<glm::vec3> box_corners();            // of the cube with side 2, fronts outwards
std::vector<glm::vec3> ball_corners(int rings);  // of the unit ball
std::vector<glm::vec3> plate_corners(int cells); // x and y in [-1, 1], seen from +z, in cells x cells quads
std::vector<glm::vec3> turned_inside(std::vector<glm::vec3> corners);
glm::mat4 random_placement(Dice& dice, float size, float distance); // turned, stretched, sometimes mirrored
Material unlit(const glm::vec3& color);

// Returns the world as a glTF file. Chance leaves out what a file may leave out: indices, normals of flat meshes, tangents.
std::string gltf_of(const World& world, Dice& dice);

// Ways a world takes to its picture.
struct Road {
    bool by_file = false; // through a glTF file
    Backend backend = Backend::tile;
};

// Draws a world under constant radiance. All worlds share the environment's light.
Result<Frame> draw_world(World world, const FrameDesc& desc, float radiance, const Road& road, Dice& dice);

} // namespace burnish::test
