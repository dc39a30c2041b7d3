// The only interface to Embree.
#pragma once
#include <memory>

#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"
#include "raster/rays/ray_scene.h"

namespace burnish {

bool embree_available();
// Builds Embree's tree on oneTBB's threads if `jobs` uses these, else on the calling thread. Errors: ExitCode::unavailable if the program
// was built without Embree.
Result<std::unique_ptr<RayScene>> make_embree_scene(const Scene& scene, const DrawTables& tables, const Jobs& jobs);

} // namespace burnish
