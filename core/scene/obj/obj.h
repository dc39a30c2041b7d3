// Reads Wavefront OBJ files into scenes.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

class Jobs;

bool is_obj(const std::string& path); // checks the name only

// Reads polygons with any number of corners, groups and objects as meshes, and indices from either end. Makes missing
// normals smooth, weighted by area, within a smoothing group where the file names any; faceted after "s off". Makes
// MikkTSpace tangents where there are texture coordinates. Materials come from the libraries that the file names
// (materials.h). Without one, a surface is white with roughness 0.4. Materials multiply the sRGB vertex colours.
//
// Leaves out with a warning: points and lines, curves and surfaces, unknown statements. Errors: invalid
// numbers, numbers beyond the range of floats, statements with a wrong count of numbers, indices without a vertex,
// files without faces, and exceeded limits.
// jobs: threads that decode pictures; null: the calling thread alone. The scene is the same.
Result<Scene> load_obj(const std::string& path, const Limits& limits, const Jobs* jobs = nullptr);
// Reads a file's text, without libraries. `path` names the file in messages.
Result<Scene> load_obj_text(const std::string& text, const std::string& path, const Limits& limits);

} // namespace burnish
