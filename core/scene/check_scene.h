// What renderers rely on of a scene that somebody else made in memory: sizes of columns, ids, ranges, numbers.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"

namespace burnish {

// Fills columns of vertices that are left out: tangents with 0 (any direction), their signs with 1, texture coordinates with 0, colours
// with 1. Positions and normals cannot be left out.
void fill_missing_columns(Scene& scene);

// Finds the first fault of a scene: a column of another size, an id beyond its table, a number that is NaN, infinite or out of its range, a
// normal without length, a picture without bytes. The error's place names the field: "/primitives/0/indices/17". `file` names the scene.
Status check_scene(const Scene& scene, const Limits& limits, const std::string& file);

// Of check_scene() all but vertices and indices: what costs nothing where a file's reader has checked these.
Status check_scene_tables(const Scene& scene, const Limits& limits, const std::string& file);

// Finds a mesh that lies too far away for renderers, or was left out as it leaves the range of floats, at the node that puts it there.
// tables: make_draw_tables(scene).
Status check_draw_range(const Scene& scene, const DrawTables& tables, const std::string& file);

// Finds the first fault of tables that were not made of this scene by make_draw_tables().
Status check_draw_tables(const DrawTables& tables, const Scene& scene, const std::string& file);

} // namespace burnish
