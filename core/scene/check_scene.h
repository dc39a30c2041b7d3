// Checks for scenes made in memory by other code: column sizes, ids, ranges, numbers. Renderers rely on them.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"

namespace burnish {

// Fills missing vertex columns: tangents with 0 (any direction), their signs with 1, texture coordinates with 0,
// colours with 1. Positions and normals are required.
void fill_missing_columns(Scene& scene);

// Returns a scene's first fault: a column of a wrong size, an id beyond its table, a number that is NaN, infinite or
// out of range, a normal without length, or an image without bytes. The error's place names the field:
// "/primitives/0/indices/17". `file` names the scene.
Status check_scene(const Scene& scene, const Limits& limits, const std::string& file);

// Checks all but vertices and indices. Costs nothing; for files whose reader has checked the rest.
Status check_scene_tables(const Scene& scene, const Limits& limits, const std::string& file);

// Returns an Error for a mesh that lies too far away for renderers, or that was left out for positions beyond the range
// of floats. The place is the mesh's node. tables: make_draw_tables(scene).
Status check_draw_range(const Scene& scene, const DrawTables& tables, const std::string& file);

// Returns the first fault in tables that make_draw_tables() did not make from this scene.
Status check_draw_tables(const DrawTables& tables, const Scene& scene, const std::string& file);

} // namespace burnish
