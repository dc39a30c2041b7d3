// Turns height maps into displaced triangles, as the reference for parallax mapping.
#pragma once
#include <cstddef>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/scene/draw_tables.h"

namespace burnish {

struct Displaced {
    std::string glb;
    std::size_t triangles = 0;
};

// Splits each triangle of the tables (world space) into k x k, with the least k for `least_triangles` in all. Moves vertices against the
// normal by (1 - height) times `depth`, in units of the first texture coordinates. A vertex takes the mean scale of its triangles.
// Normals are recomputed; tangents and texture coordinates are interpolated. Heights repeat. Fails above 2^24 triangles. file: named in
// errors.
Result<Displaced> displaced(const DrawTables& tables, const Image& heights, double depth, std::size_t least_triangles,
                            const std::string& file);

} // namespace burnish
