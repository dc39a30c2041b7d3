// Scenes that stress one part of the renderer; see BenchScene.
#pragma once
#include "core/scene/scene.h"

namespace burnish {

Scene make_textured(std::int64_t textures, double aspect);
Scene make_floor();
Scene make_foliage(std::int64_t quads, double aspect, bool opaque);
Scene make_slivers(std::int64_t triangles, double aspect);
Scene make_lit(std::int64_t lights, double aspect);
Scene make_crowd(std::int64_t triangles);
Scene make_many_materials(std::int64_t materials, double aspect);

} // namespace burnish
