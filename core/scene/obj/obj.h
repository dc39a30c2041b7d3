// Wavefront OBJ files to scenes.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

bool is_obj(const std::string& path); // by its name

// Polygons of any number of corners, groups and objects as meshes, indices from either end. Without normals they are smooth, by area,
// within a smoothing group where the file names any, and faceted where it says "s off"; tangents are MikkTSpace's where there are texture
// coordinates. One white material of roughness 0.4 wears all, times the colours of vertices, which are sRGB. With a warning are left out:
// MTL files, points and lines, curves and surfaces, unknown statements. Errors: text that is no number, numbers that no float holds,
// statements with numbers too few or too many, indices without a vertex, files without faces, what limits refuse.
Result<Scene> load_obj(const std::string& path, const Limits& limits);
// The same of a file's text; `path` names it in messages.
Result<Scene> load_obj_text(const std::string& text, const std::string& path, const Limits& limits);

} // namespace burnish
