// A floor below a scene, with soft contact shadows, and a backdrop around it.
#pragma once
#include <string>

#include "core/base/column.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"

namespace burnish {

enum class FloorKind {
    off,
    shadow, // a floor that fades into the environment
    stage,  // a floor that bends up into a backdrop
    mirror, // a stage with a polished floor, of an index of 1.5; rasterizers leave its reflection to the caller
};

struct FloorSettings {
    FloorKind kind = FloorKind::off;
    bool shaded = true;     // vertex colours hold the visibility of the sky; false where rays find the shadows themselves
    int threads = 0;        // 0: all cores the process may use
    bool use_cache = false; // keep the visibility on disk; for scenes that are drawn again as they are
};

// Adds nodes for the floor at the scene's lowest place, and for its backdrop. No view frames them. Visibility is the share of a uniform
// sky, weighted by the cosine, that a vertex sees past the scene's surfaces. Blended, transmissive and unlit surfaces hide nothing. The
// floor's vertex colours hold its visibility. Returns the visibility of the scene's own vertices, by vertex of the draw tables, [0,1]. It
// is 1 on metals and where vertices have colours. It is empty in scenes with point, spot or area lights, and beyond a million vertices.
// scene: world matrices are up to date. Errors: ExitCode::bad_input where the tables exceed the limits; `file` names the scene.
Result<Column<float>> lay_floor(Scene& scene, const FloorSettings& settings, const Limits& limits, const std::string& file);

// Multiplies vertex colours by visibility. Vertices beyond its end keep their colours.
void darken_vertices(DrawTables& tables, const Column<float>& visibility);

} // namespace burnish
