// Area lights: what is wrong with one, where one lies in the world, and the surfaces that show it to the camera.
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
    const char* what; // they are
};
const AreaShapeInfo& area_shape_info(AreaShape shape);
inline constexpr int kAreaShapes = 0
#define BN_AREA_SHAPE(name, at, least, most, what) +1
#include "core/scene/area_light.def"
    ;

// What keeps it from being a light, in words: points that lie on a line or in no plane, a concave polygon, no radius, a texture on what is
// no parallelogram. Empty: nothing.
std::string area_light_fault(const AreaLight& light);

inline constexpr int kMostAreaPoints = 16;

// A light in world space. Points: corners; of a disk its centre and two half axes at right angles (vectors); a sphere's centre; ends.
struct PlacedAreaLight { // area_light.def
    AreaShape shape = AreaShape::quad;
    int point_count = 0;
    std::int32_t texture = kNone; // of the scene
    glm::vec3 points[kMostAreaPoints] = {};
#define BN_AREA_FIELD(kind, name, initial) FieldKinds::kind name = FieldKinds::kind(initial);
#include "core/scene/area_light.def"
};

// Radii of spheres and lines grow by the longest axis of `world`. None where nothing is left of its surface, or where it is not finite.
std::optional<PlacedAreaLight> place_area_light(const AreaLight& light, const glm::mat4& world);

// Reads the file that the light names as its texture, once for all that name it. Errors: ExitCode::bad_input, of the file.
Status read_area_texture(Scene& scene, AreaLight& light, const Limits& limits);

// A node for a light that is given in world space.
void add_area_light(Scene& scene, const AreaLight& light);

// Gives every light of the scene's nodes surfaces that look like it, in the lights' order; its world matrices are up to date. Disks,
// spheres and lines have many corners, all of them on their outline. `file` names the scene in errors.
Status add_emitters(Scene& scene, int most_lights, const std::string& file);

} // namespace burnish
