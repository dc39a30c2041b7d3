// Area lights: checks, placement in the world, and surfaces that show the lights to the camera.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

struct AreaShapeInfo {
    const char* name;
    int least, most;  // points
    const char* what; // names of the points
};
const AreaShapeInfo& area_shape_info(AreaShape shape);
inline constexpr int kAreaShapes = 0
#define BN_AREA_SHAPE(name, at, least, most, what) +1
#include "core/scene/area_light.def"
    ;

// Returns the reason why `light` is invalid, or "". Reasons: points on a line or off a plane, a concave polygon, no
// radius, a texture on a shape other than a parallelogram.
std::string area_light_fault(const AreaLight& light);

inline constexpr int kMostAreaPoints = 16;

// A light in world space. points: corners; a disk's centre and two orthogonal half axes (vectors); a sphere's centre; a
// line's ends.
struct PlacedAreaLight { // area_light.def
    AreaShape shape = AreaShape::quad;
    int point_count = 0;
    std::int32_t texture = kNone; // in the scene's textures
    glm::vec3 points[kMostAreaPoints] = {};
#define BN_AREA_FIELD(kind, name, initial) FieldKinds::kind name = FieldKinds::kind(initial);
#include "core/scene/area_light.def"
};

// Places a light. The radius of spheres and lines scales with the longest axis of `world`. Returns nothing where the
// surface vanishes or is not finite.
std::optional<PlacedAreaLight> place_area_light(const AreaLight& light, const glm::mat4& world);

// Reads the light's texture file, once for all lights that name it. Errors have ExitCode::bad_input and name the file.
Status read_area_texture(Scene& scene, AreaLight& light, const Limits& limits);

// Adds a node for a light in world space.
void add_area_light(Scene& scene, const AreaLight& light);

// Adds emitting surfaces for all lights in the scene's nodes, in the lights' order. Expects current world matrices.
// Disks, spheres and lines get many corners, all on their outline. `file` names the scene in errors.
Status add_emitters(Scene& scene, int most_lights, const std::string& file);

} // namespace burnish
