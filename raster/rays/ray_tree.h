// A bounding hierarchy over triangles, and its rays in lanes. Each ray gets the same hit with every instruction set and packet.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/column.h"
#include "core/jobs/jobs.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"
#include "core/simd/dispatch.h"
#include "raster/rays/ray_scene.h"
#include "raster/rays/trace_fns.h"

namespace burnish {

struct RayTree { // empty: no triangle
    Column<RayNode> nodes;
    Column<RayTriangle> triangles; // in the leaves' order
    RayTreeView view() const { return {nodes.data(), triangles.data(), nodes.size() > 0}; }
};

// Builds a tree over triangles by the surface area heuristic in bins (Wald 2007, "On fast Construction of SAH-based Bounding Volume
// Hierarchies"). ids: global ids. single_sided: by global id. The tree is the same for any number of threads.
RayTree make_ray_tree(const DrawTables& tables, const std::vector<std::uint32_t>& ids, const std::vector<std::uint8_t>& single_sided,
                      const Jobs& jobs);

// Makes the scene of rays by trees: one over surfaces, and one over surfaces that show an open area light. left_out: materials whose
// triangles no ray meets, by index; those beyond its end are met.
std::unique_ptr<RayScene> make_tree_scene(const Scene& scene, const DrawTables& tables, const Jobs& jobs, Isa isa,
                                          const std::vector<bool>& left_out = {});

} // namespace burnish
