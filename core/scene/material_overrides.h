// Values in place of the scene's material values, as if their file had named them.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/directional_roughness.h"
#include "core/scene/scene.h"
#include "core/scene/surface_maps.h"

namespace burnish {

class Jobs;

struct MaterialOverrides {  // empty: left as it is
    std::string material;   // MaterialX file, or folder of pictures, whose names end in what they are: see apps/manual/materials.md
    std::string direction;  // an anisotropy texture; materials without strength of anisotropy get 1, which its blue scales
    std::string rotation;   // the same in another encoding
    std::string normal;     // normal map
    std::string quaternion; // the same as quaternions
    std::string height;     // height map, red
    std::string roughness;  // roughness by direction
    RoughnessEncoding roughness_encoding = RoughnessEncoding::widths;
    RotationEncoding rotation_encoding = RotationEncoding::vector;
    Strokes strokes = Strokes::highlights; // of `rotation`, and of the folder's
    bool normal_y_down = false;            // all normal maps have green down
    std::optional<glm::vec3> f0;           // reflectance at normal incidence of all materials, which are dielectrics then

    bool names(const std::string& path) const; // one of its pictures
    bool material_is_document() const;         // a MaterialX file, for apply_mtlx()
};

// Pictures lie in the first set of texture coordinates, on every material that something with coordinates wears. Errors: what is no picture
// of its kind, more bytes than textures may have, a scene without texture coordinates; ExitCode::usage: two pictures for one part, or
// grooves where no map holds strokes: RotationEncoding::direction is the highlights' direction; normal_y_down or an encoding without its
// map. Leaves a MaterialX file to apply_mtlx(), which goes first. jobs: threads that decode pictures; null: the calling thread alone. The
// materials are the same.
Status apply_material_overrides(Scene& scene, const MaterialOverrides& overrides, const Limits& limits, const Jobs* jobs = nullptr);

} // namespace burnish
