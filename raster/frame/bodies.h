// Bodies of transmissive materials: whether their meshes are closed, how thick and how round they are.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"
#include "shading/lang/records.h"

namespace burnish {

struct Body {
    bool thin = true;       // a mesh is open, or has no extent
    double extent = 0.0;    // mean distance to the far side along the normal, metres, world space
    double roundness = 0.0; // [0,1]; 0: a plate, 1: a ball
};

// Returns true if all meshes with the material are closed: every edge has a triangle on both sides.
bool is_closed_body(const DrawTables& tables, std::size_t material);

// Measures the meshes that have a material, by rays through the body. The same bits for any number of threads.
Body measure_body(const Scene& scene, const DrawTables& tables, std::size_t material, const Jobs& jobs);

// Fills the members of transmissive materials' records that tell of bodies. records, overridden: by material; overridden
// may be empty.
void put_bodies(const Scene& scene, const DrawTables& tables, const Jobs& jobs, std::vector<MaterialRecord>& records,
                std::vector<MaterialRecord>& overridden);

} // namespace burnish
