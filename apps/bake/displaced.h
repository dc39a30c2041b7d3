// Heights as triangles: what parallax mapping is measured against.
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

// All triangles of the tables, world space, each in k x k, as many as `least_triangles` takes, moved against the normal by (1 - height)
// times `depth`, in lengths of the first texture coordinates; a vertex's length is the mean of its triangles'. Normals are those of what
// comes out, tangents and texture coordinates go along. Heights repeat. Errors: more than 2^26 triangles. file: for errors.
Result<Displaced> displaced(const DrawTables& tables, const Image& heights, double depth, std::size_t least_triangles,
                            const std::string& file);

} // namespace burnish
